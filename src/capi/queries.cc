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

Result<RuledBatch> TakeRuled(const sheaf_geometry* geometry, const sheaf_rays* rays,
                             const sheaf_trace_options* options, const sheaf_hit_rules* given) {
  const Result<Batch> batch = TakeBatch(geometry, rays, options);
  if (!batch) return batch.error();
  sheaf_hit_rules rules = SHEAF_HIT_RULES_INIT;
  if (const Status taken = TakeIfGiven(given, "rules", &rules); !taken) return taken.error();
  return RuledBatch{batch.value().rays,
                    batch.value().count,
                    {.interval = batch.value().options.interval,
                     .rules = {rules.object_mask, rules.ray_mask, rules.all_ray_mask,
                               rules.excluded, rules.excluded_per_ray},
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
