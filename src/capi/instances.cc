// The calls of <sheaf/capi_instances.h>.
#include "sheaf/instances.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sheaf/capi.h"
#include "src/capi/batch.h"
#include "src/capi/handles.h"

namespace sheaf::capi {
namespace {

static_assert(SHEAF_NO_INSTANCE == Instances::kNoInstance);

Result<std::vector<Place>> TakePlaces(const sheaf_place* given, std::size_t count) {
  if (count > 0 && given == nullptr) return UsageError("places is NULL");
  std::vector<Place> places(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (given[i].reserved != 0) {
      return UsageError("place " + std::to_string(i) + ": reserved is not 0");
    }
    places[i].geometry = given[i].geometry;
    std::copy_n(given[i].to_world, 12, places[i].to_world.begin());
  }
  return places;
}

Result<Instances> Build(const sheaf_geometry* const* geometries, std::size_t geometry_count,
                        const sheaf_place* given, std::size_t place_count, std::int32_t threads) {
  if (geometry_count > 0 && geometries == nullptr) return UsageError("geometries is NULL");
  if (threads < 0) return UsageError("threads is below 0");
  std::vector<std::shared_ptr<const Geometry>> shared(geometry_count);
  for (std::size_t i = 0; i < geometry_count; ++i) {
    if (geometries[i] != nullptr) shared[i] = geometries[i]->shared;
  }
  const auto places = TakePlaces(given, place_count);
  if (!places) return places.error();
  return Instances::Build(shared, places.value(), threads);
}

Status GetStatistics(const sheaf_instances* instances, sheaf_instance_statistics* statistics) {
  if (const Status there = NotNull(instances, "instances"); !there) return there.error();
  const InstanceStatistics from = instances->instances.statistics();
  sheaf_instance_statistics own = SHEAF_INSTANCE_STATISTICS_INIT;
  own.instances = from.instances;
  own.geometries = from.geometries;
  own.nodes = from.nodes;
  own.depth = from.depth;
  own.bytes = from.bytes;
  StoreBox(instances->instances, &own);
  return Put(own, "statistics", statistics);
}

}  // namespace
}  // namespace sheaf::capi

using namespace sheaf::capi;  // NOLINT: the C functions below stand outside of it
using sheaf::Status;

sheaf_status sheaf_instances_build(const sheaf_geometry* const* geometries, size_t geometry_count,
                                   const sheaf_place* places, size_t place_count, int32_t threads,
                                   sheaf_instances** instances) {
  return Make(instances, "instances is NULL",
              [&] { return Build(geometries, geometry_count, places, place_count, threads); });
}

void sheaf_instances_destroy(sheaf_instances* instances) { delete instances; }

sheaf_status sheaf_instances_get_statistics(const sheaf_instances* instances,
                                            sheaf_instance_statistics* statistics) {
  return Guarded([&] { return GetStatistics(instances, statistics); });
}

sheaf_status sheaf_instances_trace_closest(const sheaf_instances* instances, const sheaf_rays* rays,
                                           const uint32_t* source_instance, const sheaf_hits* hits,
                                           uint32_t* instance, const sheaf_trace_options* options) {
  return Guarded([&]() -> Status {
    if (const Status there = NotNull(instances, "instances"); !there) return there.error();
    const auto batch = TakeBatch(rays, options);
    if (!batch) return batch.error();
    const auto into = TakeHits(hits);
    if (!into) return into.error();
    return sheaf::TraceClosest(instances->instances, batch.value().rays, batch.value().count,
                               into.value(), instance, batch.value().options, {source_instance});
  });
}

sheaf_status sheaf_instances_trace_occluded(const sheaf_instances* instances,
                                            const sheaf_rays* rays, const uint32_t* source_instance,
                                            uint32_t* occluded,
                                            const sheaf_trace_options* options) {
  return Guarded([&]() -> Status {
    if (const Status there = NotNull(instances, "instances"); !there) return there.error();
    const auto batch = TakeBatch(rays, options);
    if (!batch) return batch.error();
    return sheaf::TraceOccluded(instances->instances, batch.value().rays, batch.value().count,
                                occluded, batch.value().options, {source_instance});
  });
}
