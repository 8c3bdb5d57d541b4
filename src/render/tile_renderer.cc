#include "src/render/tile_renderer.h"

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "simd/query.h"
#include "simd/sample_terms.h"
#include "src/render/attenuate_paths.h"
#include "src/render/fill_environment.h"
#include "src/render/find_surfaces.h"
#include "src/render/store_layers.h"
#include "src/render/sum_colours.h"
#include "src/render/weigh_emission.h"
#include "src/scalar/render_adaptively.h"

namespace sheaf {
namespace {

template <typename Real>
Kernels<Real> KernelsFor(const RenderOptions& options) {
  if constexpr (std::is_same_v<Real, float>) {
    if (options.precision == Precision::kFast) return FastKernels(options.target.id());
  }
  return StrictKernels<Real>(options.target.id());
}

template <typename Real>
std::uint32_t NeedsOfAny(const FrameView<Real>& frame) {
  std::uint32_t needs = frame.is_distributed ? kNeedsSeed : 0;
  for (const MaterialData<Real>& material : frame.materials) needs |= material.needs;
  return needs;
}

// Whether rays leave by mirror or interface, not by diffuse reflection alone.
template <typename Real>
bool ReflectsOrTransmits(const MaterialData<Real>& material) {
  return AnyPositive(material.reflect) || (material.needs & kNeedsTransmission) != 0 ||
         material.finish.is_glossy;
}

}  // namespace

// ---- The schedule ----

template <typename Real>
void TileRenderer<Real>::Render(const PixelRect& tile, int film_x, int film_y, Film& film) {
  const bool is_adaptive = frame_.is_adaptive();
  const bool records = is_adaptive || HasFirstHitLayers(film);
  order_.Arrange(is_adaptive ? scalar::WithNeighbours(frame_, tile) : tile);
  if (records) first_hits_.Start(order_.pixels().count);
  RenderSample(order_.pixels(), 0, records ? &first_hits_ : nullptr);
  if (frame_.converges()) {
    converging_.Start(order_.pixels(), sample_.view(), sample_count(), frame_.error);
    RefineUntilConverged([this] { return IsStopped(); });
    converging_.Divide();
  } else if (is_adaptive) {
    RefineEdges(tile);
  } else if (frame_.sample_x.size() > 1) {
    RefineAll();
  }
  WritePixels(tile, film_x, film_y, film);
  clock_.Charge(Phase::kAccumulate);
}

template <typename Real>
void TileRenderer<Real>::RenderRound(const PixelRect& tile, int film_x, int film_y, Film& film,
                                     SampleRound& round) {
  order_.Arrange(tile);
  const PixelList<Real>& pixels = order_.pixels();
  const Real goal = static_cast<Real>(round.goal());
  if (round.is_first()) {
    const bool records = HasFirstHitLayers(film);
    if (records) first_hits_.Start(pixels.count);
    RenderSample(pixels, 0, records ? &first_hits_ : nullptr);
    converging_.Start(pixels, sample_.view(), sample_count(), goal);
  } else {
    converging_.Resume(pixels, round.sums(), sample_count(), goal);
  }
  RefineUntilConverged([&] { return IsStopped() || round.Cut(); });
  converging_.Save(round.sums());
  if (round.is_first()) {
    converging_.Divide();
    WritePixels(tile, film_x, film_y, film);
  }
  clock_.Charge(Phase::kAccumulate);
}

template <typename Real>
void TileRenderer<Real>::RenderSample(const PixelList<Real>& pixels, std::size_t sample,
                                      FirstHitRecorder<Real>* recorder) {
  clock_.Start();
  GeneratePrimary(pixels, sample);
  for (RayQueue<Real>& queue : next_queues_) queue.Reset(pixels.count);
  const RayBatch<Real> primary =
      primary_.batch(frame_.is_distributed ? samples_.pixel_seeds() : nullptr);
  Shade(primary, Trace(primary), 0, sample_, recorder);
  FollowRays(pixels.count);
}

// Breadth first; where a depth has outgrown its memory, the rays of some pixels to their end, then
// those of the others. A pixel's light is added up in the same order either way.
template <typename Real>
void TileRenderer<Real>::FollowRays(std::uint32_t pixels) {
  const std::uint32_t most = MostRaysAtOnce(pixels);
  held_.Start(pixels);
  for (int depth = 1; !IsStopped(); ++depth) {
    std::swap(queues_, next_queues_);
    std::uint32_t spawned = 0;
    for (const RayQueue<Real>& queue : queues_) spawned += queue.count();
    rays_.reflected += queues_[0].count();
    rays_.refracted += queues_[1].count();
    rays_.diffuse += queues_[2].count();
    if (depth > frame_.max_depth) rays_.beyond_depth += spawned;  // these count, and are black
    if (spawned == 0 || depth > frame_.max_depth) {
      if (!held_.TakeLast(&depth, queues_.data())) return;
      spawned = most + 1;  // they may have to be divided again
    }
    if (spawned > most) spawned = held_.Divide(depth, most, queues_.data());
    for (RayQueue<Real>& queue : next_queues_) queue.Reset(spawned);
    ShadeDepth(depth, most);
  }
}

template <typename Real>
void TileRenderer<Real>::ShadeDepth(int depth, std::uint32_t most) {
  for (RayQueue<Real>& queue : queues_) {
    for (std::uint32_t first = 0; first < queue.count() && !IsStopped(); first += most) {
      const RayBatch<Real> batch = queue.batch(first, std::min(most, queue.count() - first));
      ray_colours_.Reserve(batch.count);
      const RayBatch<Real> seen = Trace(batch);
      if (frame_.attenuates) {
        AttenuatePaths(frame_, batch.rays, hits_.view(), batch.count, queue.paths(first));
      }
      Shade(batch, seen, depth, ray_colours_, nullptr);
      AccumulateColours(ray_colours_.view(), batch.paths, batch.count, sample_.output());
      clock_.Charge(Phase::kAccumulate);
    }
  }
}

// The pixels' first rays of a sample.
template <typename Real>
void TileRenderer<Real>::GeneratePrimary(const PixelList<Real>& pixels, std::size_t sample) {
  sample_.Reserve(pixels.count);
  if (frame_.is_distributed) samples_.StartSample(pixels, sample);
  const bool has_lens = frame_.camera.lens != LensUse::kNone;
  const auto lens = has_lens ? samples_.DrawForPixels(kLensDimension) : SampleView<Real>{};
  kernels_.generate_primary(frame_.camera, pixels.x.data(), pixels.y.data(),
                            frame_.sample_x[sample], frame_.sample_y[sample], lens, pixels.count,
                            primary_.Start(pixels.count));
  rays_.primary += pixels.count;
  clock_.Charge(Phase::kGenerate, pixels.count, pixels.count);
}

template <typename Real>
RayBatch<Real> TileRenderer<Real>::Trace(const RayBatch<Real>& batch) {
  hits_.Reserve(batch.count);
  kernels_.trace_closest(frame_.tree, batch.rays, {}, batch.count, Coherence::kUnknown,
                         hits_.output());
  const RayBatch<Real> seen = instanced_.Trace(batch, hits_.output());
  clock_.Charge(Phase::kTrace, batch.count, batch.count);
  binner_.Bin(hits_.view().primitive, batch.count, frame_.primitives);
  clock_.Charge(Phase::kBin);
  return seen;
}

template <typename Real>
void TileRenderer<Real>::Shade(const RayBatch<Real>& batch, const RayBatch<Real>& seen, int depth,
                               ColourStream<Real>& colours, FirstHitRecorder<Real>* recorder) {
  const ColourOutput<Real> all = colours.output();
  FillEnvironment(frame_, batch.rays, binner_.missed_rays(), batch.count, all);
  for (RayQueue<Real>& queue : next_queues_) queue.StartParents();
  for (const HitBin& bin : binner_.bins()) {
    const MaterialData<Real>& material = frame_.materials[bin.material];
    const std::uint32_t count = bin.batch.count;
    surfaces_.Reserve(batch.count, surface_fields_);
    texels_.Reserve(batch.count, texel_fields_);
    const SurfaceView<Real> surfaces = FindSurfaces(frame_, kernels_, bin, seen, hits_.view(),
                                                    instanced_, surfaces_, texels_.output());
    if (recorder) recorder->Record(bin, hits_.view(), surfaces);
    clock_.Charge(Phase::kSurface, count, count);
    // Where all rays met alike, surfaces stand in the order of rays.
    const bool is_all = count == batch.count;
    if (!is_all) surface_colours_.Reserve(batch.count);
    const ColourOutput<Real> shaded = is_all ? all : surface_colours_.output();
    kernels_.shade_ambient(material, surfaces, count, shaded);
    if (batch.paths.density && material.emitter_density > 0 &&
        bin.kind == PrimitiveKind::kTriangle) {
      WeighEmission(material, batch, hits_.view(), instanced_.instances(), surfaces, count, shaded);
    }
    clock_.Charge(Phase::kShade, count, count);
    if (frame_.is_distributed) samples_.StartSurfaces(batch.paths, surfaces, count);
    if (material.needs & kNeedsChildren) ChooseRays(batch.paths, depth, material, surfaces, count);
    if (material.needs & kNeedsLights)
      lights_.Shade(material, surfaces, instanced_.instances(), count, shaded);
    if (!is_all) ScatterColours(surface_colours_.view(), bin.batch, all);
    clock_.Charge(Phase::kAccumulate);
    if (material.needs & kNeedsChildren) Spawn(batch.paths, material, surfaces, count);
  }
  for (std::size_t i = 0; i < kChildKinds; ++i) {
    next_queues_[i].FinishParents(batch, static_cast<ChildKind>(i), instanced_.instances(),
                                  parent_order_);
  }
  clock_.Charge(Phase::kSpawn);
}

template <typename Real>
void TileRenderer<Real>::ChooseRays(const PathView<Real>& parents, int depth,
                                    const MaterialData<Real>& material,
                                    const SurfaceView<Real>& surfaces, std::uint32_t count) {
  if (material.needs & kNeedsGloss) {
    const SampleView<Real> points = samples_.DrawForSurfaces(kGlossDimension);
    kernels_.draw_facets(material, surfaces, points, count, surfaces_.output());
    clock_.Charge(Phase::kSpawn, count, count);
  }
  if (!(material.needs & kNeedsChoice)) return;
  const Roulette roulette = depth >= kRouletteDepth ? Roulette::kOn : Roulette::kOff;
  kernels_.choose_lobes(material, surfaces, parents, samples_.DrawForSurfaces(kLobeDimension),
                        roulette, count, surfaces_.output());
  // Rays that will not be traced find no lamps.
  if (depth == frame_.max_depth) std::fill_n(surfaces_.output().scatter, count, Real(0));
  clock_.Charge(Phase::kSpawn, count, count);
}

template <typename Real>
void TileRenderer<Real>::Spawn(const PathView<Real>& parents, const MaterialData<Real>& material,
                               const SurfaceView<Real>& surfaces, std::uint32_t count) {
  if (material.needs & kNeedsChoice) {
    RayQueue<Real>& diffuse = next(ChildKind::kDiffuse);
    diffuse.MakeRoom(path_fields_ | FieldBit(&PathView<Real>::density));
    diffuse.Append(kernels_.scatter_diffuse(
        material, surfaces, count, parents, samples_.DrawForSurfaces(kDiffuseDimension),
        frame_.min_throughput, diffuse.next_rays(), diffuse.next_paths()));
    clock_.Charge(Phase::kSpawn, count, count);
    if (!ReflectsOrTransmits(material)) return;
  }
  RayQueue<Real>&reflected = next(ChildKind::kReflected), &refracted = next(ChildKind::kRefracted);
  reflected.MakeRoom(path_fields_);
  if (material.needs & kNeedsTransmission) refracted.MakeRoom(path_fields_);
  const SpawnCounts spawned = kernels_.spawn_rays(
      material, surfaces, count, parents, frame_.min_throughput, reflected.next_rays(),
      reflected.next_paths(), refracted.next_rays(), refracted.next_paths());
  reflected.Append(spawned.reflected);
  refracted.Append(spawned.refracted);
  clock_.Charge(Phase::kSpawn, count, count);
}

// ---- The samples after the first ----

template <typename Real>
void TileRenderer<Real>::RefineAll() {
  const std::size_t samples = frame_.sample_x.size();
  means_.Start(sample_.view(), order_.pixels().count);
  for (std::size_t i = 1; i < samples && !IsStopped(); ++i) {
    RenderSample(order_.pixels(), i, nullptr);
    means_.Add(sample_.view());
    clock_.Charge(Phase::kAccumulate);
  }
  means_.Divide(static_cast<int>(samples));
}

// src/scalar/render_adaptively.h: they are worth it where there are edges.
template <typename Real>
void TileRenderer<Real>::RefineEdges(const PixelRect& tile) {
  means_.Start(sample_.view(), order_.pixels().count);
  first_hits_.RecordColours(sample_.view());
  edges_.Find(order_, tile, first_hits_.hits(), frame_.contrast);
  clock_.Charge(Phase::kAccumulate);
  const std::size_t samples = frame_.sample_x.size();
  for (std::size_t i = 1; i < samples && edges_.pixels().count > 0 && !IsStopped(); ++i) {
    RenderSample(edges_.pixels(), i, nullptr);
    means_.AddAt(edges_.positions(), sample_.view());
    clock_.Charge(Phase::kAccumulate);
  }
  means_.DivideAt(edges_.positions(), static_cast<int>(samples));
}

template <typename Real>
template <class IsOver>
void TileRenderer<Real>::RefineUntilConverged(IsOver is_over) {
  while (converging_.pixels().count > 0 && !is_over()) {
    RenderSample(converging_.pixels(), converging_.index(), nullptr);
    converging_.Add(sample_.view());
    clock_.Charge(Phase::kAccumulate);
  }
}

template <typename Real>
ColourView<Real> TileRenderer<Real>::means() const {
  if (frame_.converges()) return converging_.view();
  return frame_.sample_x.size() > 1 ? means_.view() : sample_.view();
}

// ---- The film and the buffers ----

// Row by row, so that a line of the film's memory is written at once.
template <typename Real>
void TileRenderer<Real>::WritePixels(const PixelRect& tile, int film_x, int film_y, Film& film) {
  const bool has_layers = HasFirstHitLayers(film);
  const ColourView<Real> mean = means();
  for (int y = tile.y0; y < tile.y1; ++y) {
    float* rgb = film.pixel(tile.x0 - film_x, y - film_y);
    for (int x = tile.x0; x < tile.x1; ++x, rgb += 3) {
      const std::uint32_t i = order_.PositionOf(x, y);
      rgb[0] = static_cast<float>(mean.r[i]);
      rgb[1] = static_cast<float>(mean.g[i]);
      rgb[2] = static_cast<float>(mean.b[i]);
      if (!has_layers) continue;
      StoreLayers(film, x - film_x, y - film_y, LayersOf(first_hits_.hits()[i], frame_));
    }
  }
}

template <typename Real>
std::size_t TileRenderer<Real>::buffer_bytes() const {
  std::size_t sum = 0;
  const auto add = [&sum](const auto&... buffers) { ((sum += buffers.bytes()), ...); };
  add(binner_, instanced_, samples_, lights_, order_, sample_, means_, converging_, first_hits_,
      edges_, primary_);
  for (const auto& queues : {queues_, next_queues_}) {
    for (const RayQueue<Real>& queue : queues) add(queue);
  }
  add(held_, parent_order_);
  add(hits_, surfaces_, texels_, ray_colours_, surface_colours_);
  return sum;
}

template <typename Real>
TileRenderer<Real>::TileRenderer(const FrameView<Real>& frame, const RenderOptions& options,
                                 const std::atomic<bool>& stop)
    : TileRenderer(frame, KernelsFor<Real>(options), options, stop) {}

template <typename Real>
TileRenderer<Real>::TileRenderer(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                                 const RenderOptions& options, const std::atomic<bool>& stop)
    : TileWorker(PhaseClock(options.timing, kernels.report_target().lanes)),
      frame_(frame),
      kernels_(kernels),
      stop_(stop),
      surface_fields_(SurfaceFieldsFor<Real>(NeedsOfAny(frame))),
      texel_fields_(TexelFieldsFor<Real>(NeedsOfAny(frame), frame.textures.size())),
      path_fields_(PathFieldsFor<Real>(NeedsOfAny(frame))),
      binner_(frame.materials.size()),
      instanced_(frame, kernels_),
      samples_(kernels_),
      lights_(frame, kernels_, samples_, rays_, clock_),
      first_hits_(frame, options.layers) {}

template class TileRenderer<float>;
template class TileRenderer<double>;

}  // namespace sheaf
