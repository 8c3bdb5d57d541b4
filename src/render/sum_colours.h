// How the colours of surfaces become colours of rays, and those colours of a sample.
#ifndef SHEAF_RENDER_SUM_COLOURS_H_
#define SHEAF_RENDER_SUM_COLOURS_H_

#include <algorithm>
#include <cstdint>
#include <span>

#include "simd/streams.h"

namespace sheaf {

// The surfaces of a batch of hits give their rays their colours.
template <typename Real>
void ScatterColours(const ColourView<Real>& surfaces, const HitBatch& batch,
                    const ColourOutput<Real>& rays) {
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    const std::uint32_t ray = batch.ray[i];
    rays.r[ray] = surfaces.r[i];
    rays.g[ray] = surfaces.g[i];
    rays.b[ray] = surfaces.b[i];
  }
}

// `colour` for the rays of a list, which ascends, of `count` rays.
template <typename Real>
void FillColours(const Real (&colour)[3], std::span<const std::uint32_t> list, std::uint32_t count,
                 const ColourOutput<Real>& rays) {
  if (list.size() == count) {
    std::fill_n(rays.r, count, colour[0]);
    std::fill_n(rays.g, count, colour[1]);
    std::fill_n(rays.b, count, colour[2]);
    return;
  }
  for (const std::uint32_t ray : list) {
    rays.r[ray] = colour[0];
    rays.g[ray] = colour[1];
    rays.b[ray] = colour[2];
  }
}

// Adds what rays see to the sample of their pixels: ray by ray, because several may belong to one
// pixel, and in their order, which is part of the result.
template <typename Real>
void AccumulateColours(const ColourView<Real>& rays, const PathView<Real>& paths,
                       std::uint32_t count, const ColourOutput<Real>& sample) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t pixel = paths.pixel[i];
    sample.r[pixel] += paths.throughput_r[i] * rays.r[i];
    sample.g[pixel] += paths.throughput_g[i] * rays.g[i];
    sample.b[pixel] += paths.throughput_b[i] * rays.b[i];
  }
}

}  // namespace sheaf

#endif  // SHEAF_RENDER_SUM_COLOURS_H_
