// Rays of the four kinds that a renderer traces, over a scene seen by its camera.
#ifndef SHEAF_BENCH_MAKE_RAYS_H_
#define SHEAF_BENCH_MAKE_RAYS_H_

#include <cstdint>
#include <span>

#include "bench/make_scenes.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "src/stream/stream.h"

namespace sheaf::bench {

enum class RayKind {
  kPrimary,  // pinhole, through pixel centres
  kShadow,   // from the point light to every hit, ending just before it: they share an origin
  kMirror,   // reflected at the geometric normal
  kDiffuse,  // about that normal, with a density proportional to the cosine
};
inline constexpr RayKind kRayKinds[] = {RayKind::kPrimary, RayKind::kShadow, RayKind::kMirror,
                                        RayKind::kDiffuse};

const char* NameOf(RayKind kind);

// `count` rays and the one interval that all have. They carry no source: Embree knows none.
struct RayBatch {
  RayStream<float> stream;
  std::uint32_t count = 0;
  RayIntervals<float> intervals;

  RayView<float> view() const {
    RayView<float> view = stream.view();
    view.source = nullptr;
    return view;
  }
};

// `size` by `size` rays, a power of two, in Morton order over the whole picture, so that every
// aligned run of 4^k rays is a square.
RayBatch PrimaryRays(const BenchScene& scene, std::uint32_t size);

// A ray from each hit of the primary rays, in their order. `t` and `primitive` are the hits of
// `primary`, kNoPrimitive where one missed; `kind` is not kPrimary.
RayBatch SecondaryRays(const BenchScene& scene, RayKind kind, const RayBatch& primary,
                       std::span<const float> t, std::span<const std::uint32_t> primitive);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_MAKE_RAYS_H_
