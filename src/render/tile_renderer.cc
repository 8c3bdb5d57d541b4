#include "src/render/tile_renderer.h"

#include <algorithm>
#include <bit>

#include "simd/query.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/core/even_bits.h"
#include "src/render/store_layers.h"
#include "src/render/tint_surfaces.h"
#include "src/scalar/render_adaptively.h"

namespace sheaf {
namespace {

template <typename Real>
bool Contains(const PixelRect& rect, Real x, Real y) {
  return x >= static_cast<Real>(rect.x0) && x < static_cast<Real>(rect.x1) &&
         y >= static_cast<Real>(rect.y0) && y < static_cast<Real>(rect.y1);
}

}  // namespace

// ---- The schedule ----

template <typename Real>
void TileRenderer<Real>::Render(const PixelRect& tile, int film_x, int film_y, Film& film) {
  layered_ = HasFirstHitLayers(film) ? &film : nullptr;
  layered_x_ = film_x, layered_y_ = film_y;
  if (layered_) ClearLayers(tile);
  if (frame_.is_adaptive()) {
    RenderAdaptively(tile);
  } else {
    OrderPixels(tile);
    const std::size_t samples = frame_.sample_x.size();
    for (std::size_t i = 0; i < samples && !stop_.load(std::memory_order_relaxed); ++i) {
      RenderSample(pixels_, i);
      layered_ = nullptr;
      if (samples > 1) AddSample(i);
    }
  }
  WritePixels(tile, film_x, film_y, film);
}

// src/scalar/render_adaptively.h: one sample of every pixel, the others where there are edges.
template <typename Real>
void TileRenderer<Real>::RenderAdaptively(const PixelRect& tile) {
  OrderPixels(scalar::WithNeighbours(frame_, tile));
  records_first_hits_ = true;
  RenderSample(pixels_, 0);
  records_first_hits_ = false;
  layered_ = nullptr;
  FindEdges(tile);
  for (std::size_t i = 1; i < frame_.sample_x.size(); ++i) {
    if (edges_.count == 0 || stop_.load(std::memory_order_relaxed)) return;
    RenderSample(edges_, i);
    AddSampleOfEdges(i);
  }
}

template <typename Real>
void TileRenderer<Real>::RenderSample(const PixelList& pixels, std::size_t sample) {
  StartClock();
  Generate(pixels, sample);
  next_reflected_.Reset(primary_.count);
  next_refracted_.Reset(primary_.count);
  TraceAndShade(primary_, 0);
  for (int depth = 1; next_reflected_.count + next_refracted_.count > 0; ++depth) {
    std::swap(reflected_, next_reflected_);
    std::swap(refracted_, next_refracted_);
    rays_.reflected += reflected_.count;
    rays_.refracted += refracted_.count;
    if (depth > frame_.max_depth) {  // these count, and are black
      rays_.beyond_depth += reflected_.count + refracted_.count;
      break;
    }
    next_reflected_.Reset(reflected_.count + refracted_.count);
    next_refracted_.Reset(reflected_.count + refracted_.count);
    if (stop_.load(std::memory_order_relaxed)) return;
    TraceAndShade(reflected_, depth);
    TraceAndShade(refracted_, depth);
  }
}

template <typename Real>
void TileRenderer<Real>::TraceAndShade(const RayQueue<Real>& queue, int depth) {
  if (queue.count == 0) return;
  Reserve(queue.count);
  const std::uint32_t first_reflected = next_reflected_.count;
  const std::uint32_t first_refracted = next_refracted_.count;
  reflecting_bins_ = refracting_bins_ = 0;

  auto rays = queue.rays.view();
  if (depth == 0) rays.source = nullptr;
  kernels_.trace_closest(frame_.tree, rays, {}, queue.count, Coherence::kUnknown, hits_.output());
  Charge(Phase::kTrace, queue.count, queue.count);
  binner_.Bin(hits_.view().primitive, queue.count, frame_.primitives);
  Charge(Phase::kBin);

  // Primary rays stand for their pixels, with a weight of 1.
  auto colours = depth == 0 ? sample_.output() : ray_colours_.output();
  for (const std::uint32_t ray : binner_.missed_rays()) {
    colours.r[ray] = frame_.background[0];
    colours.g[ray] = frame_.background[1];
    colours.b[ray] = frame_.background[2];
  }
  for (const HitBin& bin : binner_.bins()) ShadeBin(queue, bin, depth);
  FinishSpawn(queue, next_reflected_, first_reflected, depth, reflecting_bins_);
  FinishSpawn(queue, next_refracted_, first_refracted, depth, refracting_bins_);
  if (depth > 0) Accumulate(queue);
}

template <typename Real>
void TileRenderer<Real>::ShadeBin(const RayQueue<Real>& queue, const HitBin& bin, int depth) {
  const MaterialData<Real>& material = frame_.materials[bin.material];
  auto rays = queue.rays.view();
  if (bin.shape == ShapeKind::kSphere) {
    kernels_.sphere_surfaces(frame_.geometry.spheres, rays, hits_.view(), bin.batch, material.needs,
                             surfaces_.output());
  } else {
    kernels_.triangle_surfaces(frame_.geometry.triangles, rays, hits_.view(), bin.batch,
                               material.needs, surfaces_.output());
    if (material.needs & (kNeedsNormals | kNeedsTint)) {
      kernels_.blend_vertices(frame_.geometry.triangles, hits_.view(), bin.batch, material.needs,
                              surfaces_.output());
    }
  }
  const bool has_faces = bin.shape == ShapeKind::kTriangle && (material.needs & kNeedsNormals) != 0;
  const auto surfaces = has_faces ? surfaces_.view() : WithoutFaces(surfaces_.view());
  if (material.needs & kNeedsTint) {
    TintSurfaces(material, frame_.textures, bin, surfaces, surfaces_.output());
  }
  if (records_first_hits_ && depth == 0) RecordFirstHits(bin);
  if (layered_ && depth == 0) RecordLayers(bin, material);
  Charge(Phase::kSurface, bin.batch.count, bin.batch.count);

  kernels_.shade_ambient(material, surfaces, bin.batch.count, surface_colours_.output());
  Charge(Phase::kShade, bin.batch.count, bin.batch.count);
  if (material.needs & kNeedsLights) ShadeLights(material, surfaces, bin.batch.count);

  auto colours = depth == 0 ? sample_.output() : ray_colours_.output();
  const auto shaded = surface_colours_.view();
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const std::uint32_t ray = bin.batch.ray[i];
    colours.r[ray] = shaded.r[i];
    colours.g[ray] = shaded.g[i];
    colours.b[ray] = shaded.b[i];
  }
  Charge(Phase::kAccumulate);
  if (material.needs & kNeedsChildren) {
    Spawn(queue, material, surfaces, bin.batch.count, depth);
  }
}

// Light by light, so that the shadow rays of a batch share their origin.
template <typename Real>
void TileRenderer<Real>::ShadeLights(const MaterialData<Real>& material,
                                     const SurfaceView<Real>& surfaces, std::uint32_t count) {
  for (const LightData<Real>& light : frame_.lights) {
    const std::uint32_t facing = kernels_.face_light(light, material, surfaces, count, lit_.data());
    Charge(Phase::kShade, count, count);
    if (facing == 0) continue;
    const std::uint32_t lit = light.casts_shadows ? FindShadows(light, surfaces, count) : facing;
    if (lit == 0) continue;
    kernels_.shade_light(light, material, surfaces, lit_.data(), count, surface_colours_.output());
    Charge(Phase::kShade, lit, count);
  }
}

template <typename Real>
std::uint32_t TileRenderer<Real>::FindShadows(const LightData<Real>& light,
                                              const SurfaceView<Real>& surfaces,
                                              std::uint32_t count) {
  const std::uint32_t size = kernels_.generate_shadow(
      light, surfaces, lit_.data(), count, shadow_rays_.output(), surface_of_ray_.data());
  rays_.shadow += size;
  RayIntervals<Real> intervals;
  if (light.kind != LightKind::kDirectional) intervals.all_t_max = 1;
  kernels_.trace_occluded(frame_.tree, shadow_rays_.view(), intervals, size, Coherence::kUnknown,
                          occluded_.data());
  std::uint32_t lit = size;
  for (std::uint32_t i = 0; i < size; ++i) {
    lit_[surface_of_ray_[i]] = 1 - occluded_[i];
    lit -= occluded_[i];
  }
  Charge(Phase::kShadow, size, size);
  return lit;
}

template <typename Real>
void TileRenderer<Real>::Spawn(const RayQueue<Real>& queue, const MaterialData<Real>& material,
                               const SurfaceView<Real>& surfaces, std::uint32_t count, int depth) {
  auto parents = queue.paths.view();
  if (depth == 0) parents.throughput_r = parents.throughput_g = parents.throughput_b = nullptr;
  const SpawnCounts spawned =
      kernels_.spawn_rays(material, surfaces, count, parents, frame_.min_throughput,
                          next_reflected_.rays.output(next_reflected_.count),
                          next_reflected_.paths.output(next_reflected_.count),
                          next_refracted_.rays.output(next_refracted_.count),
                          next_refracted_.paths.output(next_refracted_.count));
  next_reflected_.count += spawned.reflected;
  next_refracted_.count += spawned.refracted;
  reflecting_bins_ += spawned.reflected > 0;
  refracting_bins_ += spawned.refracted > 0;
  Charge(Phase::kSpawn, count, count);
}

// One bin leaves its children in the order of their parents; several have to be merged into it.
template <typename Real>
void TileRenderer<Real>::FinishSpawn(const RayQueue<Real>& queue, RayQueue<Real>& children,
                                     std::uint32_t first, int depth, int spawning_bins) {
  if (children.count == first) return;
  if (spawning_bins > 1) parent_order_.Apply(children, first, queue.count);
  const std::uint32_t* parent_pixel = queue.paths.view().pixel;
  const auto paths = children.paths.output(first);
  for (std::uint32_t i = 0; i < children.count - first; ++i) {
    paths.pixel[i] = depth == 0 ? paths.parent[i] : parent_pixel[paths.parent[i]];
  }
  Charge(Phase::kSpawn);
}

// Ray by ray, because several may belong to one pixel, and in their order, which is part of the
// result.
template <typename Real>
void TileRenderer<Real>::Accumulate(const RayQueue<Real>& queue) {
  const auto paths = queue.paths.view();
  const auto colours = ray_colours_.view();
  const auto sample = sample_.output();
  for (std::uint32_t i = 0; i < queue.count; ++i) {
    const std::uint32_t pixel = paths.pixel[i];
    sample.r[pixel] += paths.throughput_r[i] * colours.r[i];
    sample.g[pixel] += paths.throughput_g[i] * colours.g[i];
    sample.b[pixel] += paths.throughput_b[i] * colours.b[i];
  }
  Charge(Phase::kAccumulate);
}

// The first of several samples sets the mean, which is a sum until the last divides it.
template <typename Real>
void TileRenderer<Real>::AddSample(std::size_t index) {
  const std::size_t samples = frame_.sample_x.size();
  auto mean = mean_.output();
  auto sample = sample_.view();
  ForEachField(mean, sample, [&](Real* sum, const Real* channel) {
    if (index == 0) std::fill_n(sum, pixels_.count, Real(0));
    for (std::uint32_t i = 0; i < pixels_.count; ++i) sum[i] += channel[i];
    if (index + 1 < samples) return;
    for (std::uint32_t i = 0; i < pixels_.count; ++i) sum[i] /= static_cast<Real>(samples);
  });
  Charge(Phase::kAccumulate);
}

template <typename Real>
void TileRenderer<Real>::AddSampleOfEdges(std::size_t index) {
  const std::size_t samples = frame_.sample_x.size();
  auto mean = mean_.output();
  auto sample = sample_.view();
  ForEachField(mean, sample, [&](Real* sum, const Real* channel) {
    for (std::uint32_t i = 0; i < edges_.count; ++i) {
      Real& pixel = sum[position_of_edge_[i]];
      pixel += channel[i];
      if (index + 1 == samples) pixel /= static_cast<Real>(samples);
    }
  });
  Charge(Phase::kAccumulate);
}

// The first samples become the means; pixels of `tile` with an edge to a neighbour become edges_.
template <typename Real>
void TileRenderer<Real>::FindEdges(const PixelRect& tile) {
  AddSample(0);
  const auto sample = sample_.view();
  for (std::uint32_t i = 0; i < pixels_.count; ++i) {
    first_hits_[i].colour = {sample.r[i], sample.g[i], sample.b[i]};
  }
  // Each pair once, from its left or upper pixel.
  is_edge_.assign(pixels_.count, false);
  const auto judge = [&](std::uint32_t a, std::uint32_t b) {
    if (is_edge_[a] && is_edge_[b]) return;
    if (!HasEdgeBetween(first_hits_[a], first_hits_[b], frame_.contrast)) return;
    is_edge_[a] = is_edge_[b] = true;
  };
  for (int y = ordered_.y0; y < ordered_.y1; ++y) {
    for (int x = ordered_.x0; x < ordered_.x1; ++x) {
      if (x + 1 < ordered_.x1) judge(PixelAt(x, y), PixelAt(x + 1, y));
      if (y + 1 < ordered_.y1) judge(PixelAt(x, y), PixelAt(x, y + 1));
    }
  }
  edges_.Reserve(pixels_.count);
  edges_.count = 0;
  position_of_edge_.clear();
  for (std::uint32_t i = 0; i < pixels_.count; ++i) {
    if (!is_edge_[i] || !Contains(tile, pixels_.x[i], pixels_.y[i])) continue;
    edges_.x[edges_.count] = pixels_.x[i];
    edges_.y[edges_.count++] = pixels_.y[i];
    position_of_edge_.push_back(i);
  }
  Charge(Phase::kAccumulate);
}

template <typename Real>
void TileRenderer<Real>::RecordFirstHits(const HitBin& bin) {
  const auto surfaces = surfaces_.view();
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const std::uint32_t primitive = bin.batch.primitive[i];
    FirstHit<Real>& first = first_hits_[bin.batch.ray[i]];
    first.normal = {surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]};
    first.surface = SurfaceIdOf(primitive, frame_.primitives[primitive]);
  }
}

template <typename Real>
void TileRenderer<Real>::ClearLayers(const PixelRect& tile) {
  layered_tile_ = tile;
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      StoreLayers(*layered_, x - layered_x_, y - layered_y_, FirstHitLayers{});
    }
  }
}

template <typename Real>
void TileRenderer<Real>::RecordLayers(const HitBin& bin, const MaterialData<Real>& material) {
  const auto surfaces = surfaces_.view();
  const auto hits = hits_.view();
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const std::uint32_t ray = bin.batch.ray[i];
    if (!Contains(layered_tile_, pixels_.x[ray], pixels_.y[ray])) continue;
    // Only what BaseColourAt reads.
    scalar::Surface<Real> surface{};
    if (material.needs & kNeedsCoordinates) surface.u = surfaces.u[i], surface.v = surfaces.v[i];
    if (material.needs & kNeedsTint) {
      surface.tint = {surfaces.tint_r[i], surfaces.tint_g[i], surfaces.tint_b[i]};
    }
    const auto albedo = scalar::MultiplyColours(scalar::PatternAt(material, surface), surface.tint);
    StoreLayers(
        *layered_, static_cast<int>(pixels_.x[ray]) - layered_x_,
        static_cast<int>(pixels_.y[ray]) - layered_y_,
        MakeLayers(hits.t[ray],
                   Vec3<Real>{surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]},
                   albedo, frame_.object_of_primitive[bin.batch.primitive[i]]));
  }
}

// Those of `tile`: with neighbours there are more. Row by row, so that a line of the film's memory
// is written at once.
template <typename Real>
void TileRenderer<Real>::WritePixels(const PixelRect& tile, int film_x, int film_y, Film& film) {
  const auto mean = frame_.sample_x.size() > 1 ? mean_.view() : sample_.view();
  for (int y = tile.y0; y < tile.y1; ++y) {
    float* rgb = film.pixel(tile.x0 - film_x, y - film_y);
    for (int x = tile.x0; x < tile.x1; ++x, rgb += 3) {
      const std::uint32_t i = PixelAt(x, y);
      rgb[0] = static_cast<float>(mean.r[i]);
      rgb[1] = static_cast<float>(mean.g[i]);
      rgb[2] = static_cast<float>(mean.b[i]);
    }
  }
  Charge(Phase::kAccumulate);
}

// ---- Primary rays and buffers ----

// In Morton order, so that any power of two of consecutive rays is a square or half of one.
template <typename Real>
void TileRenderer<Real>::OrderPixels(const PixelRect& tile) {
  const std::uint32_t size = static_cast<std::uint32_t>(tile.width() * tile.height());
  if (size > pixels_.capacity()) {
    pixels_.Reserve(size);
    sample_.Allocate(size);
    mean_.Allocate(size);
    ordered_ = {};
  }
  if (tile.width() == ordered_.width() && tile.height() == ordered_.height()) {
    // The shape of the last tile: only moved.
    const Real right = static_cast<Real>(tile.x0 - ordered_.x0);
    const Real down = static_cast<Real>(tile.y0 - ordered_.y0);
    for (std::uint32_t i = 0; i < pixels_.count; ++i) {
      pixels_.x[i] += right;
      pixels_.y[i] += down;
    }
    ordered_ = tile;
    return;
  }
  ordered_ = tile;
  const auto side =
      std::bit_ceil(static_cast<std::uint32_t>(std::max(tile.width(), tile.height())));
  pixels_.count = 0;
  pixel_at_.resize(size);
  for (std::uint32_t code = 0; code < side * side; ++code) {
    const int x = static_cast<int>(EvenBits(code)), y = static_cast<int>(EvenBits(code >> 1));
    if (x >= tile.width() || y >= tile.height()) continue;
    pixels_.x[pixels_.count] = static_cast<Real>(tile.x0 + x);
    pixels_.y[pixels_.count] = static_cast<Real>(tile.y0 + y);
    pixel_at_[static_cast<std::size_t>(y * tile.width() + x)] = pixels_.count++;
  }
}

template <typename Real>
void TileRenderer<Real>::Generate(const PixelList& pixels, std::size_t sample) {
  primary_.Reset(pixels.count);
  primary_.count = pixels.count;
  kernels_.generate_primary(frame_.camera, pixels.x.data(), pixels.y.data(),
                            frame_.sample_x[sample], frame_.sample_y[sample], pixels.count,
                            primary_.rays.output());
  rays_.primary += pixels.count;
  if (records_first_hits_) first_hits_.assign(pixels.count, {});
  Charge(Phase::kGenerate, pixels.count, pixels.count);
}

template <typename Real>
void TileRenderer<Real>::Reserve(std::uint32_t count) {
  if (count <= reserved_) return;
  reserved_ = std::max(count, 2 * reserved_);
  hits_.Allocate(reserved_);
  surfaces_.Allocate(reserved_);
  ray_colours_.Allocate(reserved_);
  surface_colours_.Allocate(reserved_);
  shadow_rays_.Allocate(reserved_);
  lit_.Allocate(StreamCapacity(reserved_));
  surface_of_ray_.Allocate(StreamCapacity(reserved_));
  occluded_.Allocate(StreamCapacity(reserved_));
}

template <typename Real>
void TileRenderer<Real>::StartClock() {
  if (timing_ == Timing::kOn) clock_ = Clock::now();
}

// Everything since the last call counts for `phase`.
template <typename Real>
void TileRenderer<Real>::Charge(Phase phase) {
  if (timing_ == Timing::kOff) return;
  const Clock::time_point now = Clock::now();
  seconds_[static_cast<int>(phase)] += std::chrono::duration<double>(now - clock_).count();
  clock_ = now;
}

// The same for a kernel that took `count` elements, whole vectors of them, of which `live`
// mattered.
template <typename Real>
void TileRenderer<Real>::Charge(Phase phase, std::uint32_t live, std::uint32_t count) {
  LaneUse& use = lane_use_[static_cast<int>(phase)];
  ++use.batches;
  use.live += live;
  use.lanes += (count + lanes_ - 1) / lanes_ * lanes_;
  Charge(phase);
}

template class TileRenderer<float>;
template class TileRenderer<double>;

}  // namespace sheaf
