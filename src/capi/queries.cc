// The calls of <sheaf/capi_queries.h>.
#include "sheaf/queries.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "sheaf/capi.h"
#include "src/capi/batch.h"
#include "src/capi/handles.h"

namespace sheaf::capi {
namespace {

// A batch with its rules.
struct RuledBatch {
  RayArrays rays;
  std::size_t count = 0;
  RuledTraceOptions options;
};

Result<HitRules> TakeRules(const sheaf_hit_rules* given) {
  sheaf_hit_rules rules = SHEAF_HIT_RULES_INIT;
  if (const Status taken = TakeIfGiven(given, "rules", &rules); !taken) return taken.error();
  return HitRules{rules.object_mask, rules.ray_mask, rules.all_ray_mask, rules.excluded,
                  rules.excluded_per_ray};
}

Result<RuledBatch> TakeRuled(const sheaf_geometry* geometry, const sheaf_rays* rays,
                             const sheaf_trace_options* options, const sheaf_hit_rules* given) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  const Result<Batch> batch = TakeBatch(rays, options);
  if (!batch) return batch.error();
  const Result<HitRules> rules = TakeRules(given);
  if (!rules) return rules.error();
  return RuledBatch{batch.value().rays,
                    batch.value().count,
                    {.interval = batch.value().options.interval,
                     .rules = rules.value(),
                     .target = batch.value().options.target}};
}

Result<AllHits> TakeAllHits(const sheaf_all_hits* given) {
  sheaf_all_hits own = SHEAF_ALL_HITS_INIT;
  if (const Status taken = Take(given, "hits", &own); !taken) return taken.error();
  AllHits all = {.capacity = own.capacity, .listed = own.listed, .total = own.total};
  if (own.hits == nullptr) return all;
  const Result<HitArrays> hits = TakeHits(own.hits);
  if (!hits) return hits.error();
  all.hits = hits.value();
  return all;
}

HitFilter FilterOf(sheaf_hit_filter filter, void* user) {
  if (filter == nullptr) return {};
  return [filter, user](const CandidateHits& from, std::uint8_t* accepted) {
    const sheaf_candidates candidates = {
        sizeof(sheaf_candidates), from.count, from.ray, from.t, from.u, from.v,
        from.primitive,           from.object};
    filter(&candidates, accepted, user);
  };
}

struct Points {
  PointArrays arrays;
  std::size_t count = 0;
};

Result<Points> TakePoints(const sheaf_geometry* geometry, const sheaf_points* given,
                          const char* name = "points") {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  sheaf_points own = SHEAF_POINTS_INIT;
  if (const Status taken = Take(given, name, &own); !taken) return taken.error();
  return Points{{own.x, own.y, own.z, own.stride}, own.count};
}

Result<OverlapLists> TakeOverlaps(const sheaf_overlaps* given) {
  sheaf_overlaps own = SHEAF_OVERLAPS_INIT;
  if (const Status taken = Take(given, "overlaps", &own); !taken) return taken.error();
  return OverlapLists{own.capacity, own.primitive, own.listed, own.total};
}

Status Nearest(const sheaf_geometry* geometry, const sheaf_points* given_points,
               const sheaf_nearest* given, const sheaf_nearest_options* given_options,
               const sheaf_hit_rules* given_rules) {
  const auto points = TakePoints(geometry, given_points);
  if (!points) return points.error();
  sheaf_nearest nearest = SHEAF_NEAREST_INIT;
  if (const Status taken = Take(given, "nearest", &nearest); !taken) return taken.error();
  sheaf_nearest_options options = SHEAF_NEAREST_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given_options, "options", &options); !taken) {
    return taken.error();
  }
  const auto rules = TakeRules(given_rules);
  if (!rules) return rules.error();
  const NearestArrays arrays = {nearest.distance,
                                nearest.primitive,
                                nearest.object,
                                {nearest.position[0], nearest.position[1], nearest.position[2]}};
  return FindNearest(
      geometry->geometry, points.value().arrays, points.value().count, arrays,
      {.max_distance = options.max_distance,
       .all_max_distance = options.all_max_distance,
       .rules = rules.value(),
       .sign = options.is_signed != 0 ? DistanceSign::kInside : DistanceSign::kNone});
}

Status InBoxes(const sheaf_geometry* geometry, const sheaf_points* given_lower,
               const sheaf_points* given_upper, const sheaf_overlaps* overlaps) {
  const auto lower = TakePoints(geometry, given_lower, "lower");
  if (!lower) return lower.error();
  const auto upper = TakePoints(geometry, given_upper, "upper");
  if (!upper) return upper.error();
  const PointArrays &from = lower.value().arrays, &to = upper.value().arrays;
  if (lower.value().count != upper.value().count || from.stride != to.stride) {
    return UsageError("lower and upper differ in count or stride");
  }
  const auto lists = TakeOverlaps(overlaps);
  if (!lists) return lists.error();
  const BoxArrays boxes = {{from.x, from.y, from.z}, {to.x, to.y, to.z}, from.stride};
  return FindInBoxes(geometry->geometry, boxes, lower.value().count, lists.value());
}

}  // namespace
}  // namespace sheaf::capi

using namespace sheaf::capi;  // NOLINT: the C functions below stand outside of it
using sheaf::Status;

sheaf_status sheaf_trace_all(const sheaf_geometry* geometry, const sheaf_rays* rays,
                             const sheaf_all_hits* hits, const sheaf_trace_options* options,
                             const sheaf_hit_rules* rules) {
  return Guarded([&]() -> Status {
    const auto batch = TakeRuled(geometry, rays, options, rules);
    if (!batch) return batch.error();
    const auto into = TakeAllHits(hits);
    if (!into) return into.error();
    return sheaf::TraceAll(geometry->geometry, batch.value().rays, batch.value().count,
                           into.value(), batch.value().options);
  });
}

sheaf_status sheaf_trace_ruled_closest(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                       const sheaf_hits* hits, const sheaf_trace_options* options,
                                       const sheaf_hit_rules* rules, sheaf_hit_filter filter,
                                       void* user) {
  return Guarded([&]() -> Status {
    const auto batch = TakeRuled(geometry, rays, options, rules);
    if (!batch) return batch.error();
    const auto into = TakeHits(hits);
    if (!into) return into.error();
    return sheaf::TraceRuledClosest(geometry->geometry, batch.value().rays, batch.value().count,
                                    into.value(), batch.value().options, FilterOf(filter, user));
  });
}

sheaf_status sheaf_trace_ruled_occluded(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                        uint32_t* occluded, const sheaf_trace_options* options,
                                        const sheaf_hit_rules* rules, sheaf_hit_filter filter,
                                        void* user) {
  return Guarded([&]() -> Status {
    const auto batch = TakeRuled(geometry, rays, options, rules);
    if (!batch) return batch.error();
    return sheaf::TraceRuledOccluded(geometry->geometry, batch.value().rays, batch.value().count,
                                     occluded, batch.value().options, FilterOf(filter, user));
  });
}

sheaf_status sheaf_count_crossings(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                   uint32_t* crossings, const sheaf_trace_options* options,
                                   const sheaf_hit_rules* rules) {
  return Guarded([&]() -> Status {
    const auto batch = TakeRuled(geometry, rays, options, rules);
    if (!batch) return batch.error();
    return sheaf::CountCrossings(geometry->geometry, batch.value().rays, batch.value().count,
                                 crossings, batch.value().options);
  });
}

sheaf_status sheaf_find_inside(const sheaf_geometry* geometry, const sheaf_points* points,
                               uint32_t* inside, const sheaf_hit_rules* rules, const char* target) {
  return Guarded([&]() -> Status {
    const auto from = TakePoints(geometry, points);
    if (!from) return from.error();
    const auto own_rules = TakeRules(rules);
    if (!own_rules) return own_rules.error();
    const auto named = TargetOf(target);
    if (!named) return named.error();
    return sheaf::FindInside(geometry->geometry, from.value().arrays, from.value().count, inside,
                             own_rules.value(), named.value());
  });
}

sheaf_status sheaf_find_nearest(const sheaf_geometry* geometry, const sheaf_points* points,
                                const sheaf_nearest* nearest, const sheaf_nearest_options* options,
                                const sheaf_hit_rules* rules) {
  return Guarded([&] { return Nearest(geometry, points, nearest, options, rules); });
}

sheaf_status sheaf_find_in_boxes(const sheaf_geometry* geometry, const sheaf_points* lower,
                                 const sheaf_points* upper, const sheaf_overlaps* overlaps) {
  return Guarded([&] { return InBoxes(geometry, lower, upper, overlaps); });
}

sheaf_status sheaf_find_in_balls(const sheaf_geometry* geometry, const sheaf_points* points,
                                 const float* radius, const sheaf_overlaps* overlaps) {
  return Guarded([&]() -> Status {
    const auto from = TakePoints(geometry, points);
    if (!from) return from.error();
    const auto lists = TakeOverlaps(overlaps);
    if (!lists) return lists.error();
    return sheaf::FindInBalls(geometry->geometry, from.value().arrays, radius, from.value().count,
                              lists.value());
  });
}
