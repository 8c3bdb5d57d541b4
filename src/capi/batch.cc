#include "src/capi/batch.h"

#include "src/capi/handles.h"

namespace sheaf::capi {

static_assert(SHEAF_INCOHERENT == static_cast<int>(RayCoherence::kIncoherent));

Result<Batch> TakeRays(const sheaf_geometry* geometry, const sheaf_rays* given) {
  if (geometry == nullptr) return UsageError("geometry is NULL");
  sheaf_rays rays = SHEAF_RAYS_INIT;
  if (const Status taken = Take(given, "rays", &rays); !taken) return taken.error();
  Batch batch;
  batch.rays = {rays.origin_x,    rays.origin_y,    rays.origin_z, rays.direction_x,
                rays.direction_y, rays.direction_z, rays.source,   rays.stride};
  batch.count = rays.count;
  return batch;
}

Result<Batch> TakeBatch(const sheaf_geometry* geometry, const sheaf_rays* rays,
                        const sheaf_trace_options* given) {
  Result<Batch> batch = TakeRays(geometry, rays);
  if (!batch) return batch;
  sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
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

Result<HitArrays> TakeHits(const sheaf_hits* given) {
  sheaf_hits hits = SHEAF_HITS_INIT;
  if (const Status taken = Take(given, "hits", &hits); !taken) return taken.error();
  return HitArrays{hits.t, hits.primitive, hits.object, hits.u, hits.v, hits.stride};
}

}  // namespace sheaf::capi
