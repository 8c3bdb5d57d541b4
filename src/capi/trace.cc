// Rays of <sheaf/capi.h> and <sheaf/capi_double.h>.
#include <array>

#include "src/capi/batch.h"
#include "src/capi/handles.h"

namespace sheaf::capi {
namespace {

template <typename Handle, typename Rays, typename Hits, typename Options>
Status Closest(const Handle* geometry, const Rays* rays, const Hits* hits, const Options* options) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  const auto batch = TakeBatch(rays, options);
  if (!batch) return batch.error();
  const auto into = TakeHits(hits);
  if (!into) return into.error();
  return TraceClosest(geometry->geometry, batch.value().rays, batch.value().count, into.value(),
                      batch.value().options);
}

template <typename Handle, typename Rays, typename Options>
Status Occluded(const Handle* geometry, const Rays* rays, std::uint32_t* occluded,
                const Options* options) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  const auto batch = TakeBatch(rays, options);
  if (!batch) return batch.error();
  return TraceOccluded(geometry->geometry, batch.value().rays, batch.value().count, occluded,
                       batch.value().options);
}

std::array<float*, 3> Arrays(float* const (&from)[3]) { return {from[0], from[1], from[2]}; }

Status FindPoints(const sheaf_geometry* geometry, const sheaf_rays* rays, const sheaf_hits* given,
                  const sheaf_hit_points* given_points, const char* target_name) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  const auto batch = TakeRays(rays);
  if (!batch) return batch.error();
  const auto hits = TakeHits(given);
  if (!hits) return hits.error();
  sheaf_hit_points points = SHEAF_HIT_POINTS_INIT;
  if (const Status taken = Take(given_points, "points", &points); !taken) return taken.error();
  const Result<Target> target = TargetOf(target_name);
  if (!target) return target.error();
  return FindHitPoints(geometry->geometry, batch.value().rays, hits.value(), batch.value().count,
                       {.position = Arrays(points.position),
                        .face = Arrays(points.face),
                        .normal = Arrays(points.normal),
                        .front = Arrays(points.front),
                        .back = Arrays(points.back),
                        .front_source = points.front_source,
                        .back_source = points.back_source,
                        .side = points.side},
                       target.value());
}

static_assert(SHEAF_NO_PRIMITIVE == Geometry::kNoPrimitive);
static_assert(SHEAF_INSIDE_BIT == Geometry::kInsideBit);

}  // namespace
}  // namespace sheaf::capi

using namespace sheaf::capi;  // NOLINT: the C functions below stand outside of it

sheaf_status sheaf_trace_closest(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                 const sheaf_hits* hits, const sheaf_trace_options* options) {
  return Guarded([&] { return Closest(geometry, rays, hits, options); });
}
sheaf_status sheaf_trace_closest_d(const sheaf_geometry_d* geometry, const sheaf_rays_d* rays,
                                   const sheaf_hits_d* hits, const sheaf_trace_options_d* options) {
  return Guarded([&] { return Closest(geometry, rays, hits, options); });
}

sheaf_status sheaf_trace_occluded(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                  uint32_t* occluded, const sheaf_trace_options* options) {
  return Guarded([&] { return Occluded(geometry, rays, occluded, options); });
}
sheaf_status sheaf_trace_occluded_d(const sheaf_geometry_d* geometry, const sheaf_rays_d* rays,
                                    uint32_t* occluded, const sheaf_trace_options_d* options) {
  return Guarded([&] { return Occluded(geometry, rays, occluded, options); });
}

sheaf_status sheaf_find_hit_points(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                   const sheaf_hits* hits, const sheaf_hit_points* points,
                                   const char* target) {
  return Guarded([&] { return FindPoints(geometry, rays, hits, points, target); });
}
