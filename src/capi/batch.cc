#include "src/capi/batch.h"

namespace sheaf::capi {
namespace {

static_assert(SHEAF_INCOHERENT == static_cast<int>(RayCoherence::kIncoherent));

template <typename Real, typename Rays>
Result<BatchOf<Real>> RaysOf(const Rays* given, Rays rays) {
  if (const Status taken = Take(given, "rays", &rays); !taken) return taken.error();
  BatchOf<Real> batch;
  batch.rays = {rays.origin_x,    rays.origin_y,    rays.origin_z, rays.direction_x,
                rays.direction_y, rays.direction_z, rays.source,   rays.stride};
  batch.count = rays.count;
  return batch;
}

// `options`: the defaults, then what is given.
template <typename Real, typename Options>
Result<BatchOf<Real>> WithOptions(Result<BatchOf<Real>> batch, const Options* given,
                                  Options options) {
  if (!batch) return batch;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  if (NumberIn(options.coherence) > SHEAF_INCOHERENT) {
    return UsageError("options: coherence is none of sheaf_coherence");
  }
  const Result<Target> target = TargetOf(options.target);
  if (!target) return target.error();
  batch.value().options = {.interval = {options.t_min, options.t_max, options.all_t_min,
                                        options.all_t_max, options.interval_stride},
                           .coherence = static_cast<RayCoherence>(options.coherence),
                           .target = target.value()};
  return batch;
}

template <typename Real, typename Hits>
Result<HitArraysOf<Real>> HitsOf(const Hits* given, Hits hits) {
  if (const Status taken = Take(given, "hits", &hits); !taken) return taken.error();
  return HitArraysOf<Real>{hits.t, hits.primitive, hits.object, hits.u, hits.v, hits.stride};
}

}  // namespace

Result<BatchOf<float>> TakeRays(const sheaf_rays* given) {
  return RaysOf<float>(given, SHEAF_RAYS_INIT);
}
Result<BatchOf<double>> TakeRays(const sheaf_rays_d* given) {
  return RaysOf<double>(given, SHEAF_RAYS_D_INIT);
}

Result<BatchOf<float>> TakeBatch(const sheaf_rays* rays, const sheaf_trace_options* options) {
  return WithOptions(TakeRays(rays), options, SHEAF_TRACE_OPTIONS_INIT);
}
Result<BatchOf<double>> TakeBatch(const sheaf_rays_d* rays, const sheaf_trace_options_d* options) {
  return WithOptions(TakeRays(rays), options, SHEAF_TRACE_OPTIONS_D_INIT);
}

Result<HitArrays> TakeHits(const sheaf_hits* given) {
  return HitsOf<float>(given, SHEAF_HITS_INIT);
}
Result<HitArraysD> TakeHits(const sheaf_hits_d* given) {
  return HitsOf<double>(given, SHEAF_HITS_D_INIT);
}

}  // namespace sheaf::capi
