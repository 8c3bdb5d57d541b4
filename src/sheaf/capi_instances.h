// The part of <sheaf/capi.h> where geometries stand in many places: <sheaf/instances.h> for C.
// Include <sheaf/capi.h>, which includes this and says what holds for every call.
#ifndef SHEAF_SHEAF_CAPI_INSTANCES_H_
#define SHEAF_SHEAF_CAPI_INSTANCES_H_

#include "sheaf/capi.h"

// NOLINTBEGIN: C has names of its own style
#ifdef __cplusplus
extern "C" {
#endif

// In place of an instance's number: none.
#define SHEAF_NO_INSTANCE 0xffffffffu

// Where a geometry stands. It has no size in front, as it comes by the million: it never grows.
typedef struct sheaf_place {
  uint32_t geometry;  // position among the geometries
  uint32_t reserved;  // 0
  // The first three rows of a 4 x 4 matrix, row by row, which takes points of the geometry to the
  // world: x' = m[0] x + m[1] y + m[2] z + m[3], and so on. Finite. It may turn, move, scale, shear
  // and mirror, but not flatten: |M| |M^-1| has no row whose sum is above a million.
  double to_world[12];
} sheaf_place;

// Geometries with a tree over the places where they stand. Never changes.
typedef struct sheaf_instances sheaf_instances;
// Instances are numbered in the order of `places`, from 0. The geometries are shared, not copied:
// their handles may be destroyed before the instances are, but none can be updated until then.
// `threads`: at most so many; 0: one a core. Fails with SHEAF_USAGE, and the number of what is
// wrong, where a geometry is NULL or out of range, a number is not finite, a map flattens,
// `reserved` is not 0 or there are more than 2^26 places.
SHEAF_API sheaf_status sheaf_instances_build(const sheaf_geometry* const* geometries,
                                             size_t geometry_count, const sheaf_place* places,
                                             size_t place_count, int32_t threads,
                                             sheaf_instances** instances);
SHEAF_API void sheaf_instances_destroy(sheaf_instances* instances);

typedef struct sheaf_instance_statistics {
  size_t size;
  uint32_t instances;  // all, those of empty geometries too
  uint32_t geometries;
  uint32_t nodes, depth;     // of the tree over instances
  uint64_t bytes;            // of memory, without the geometries
  float lower[3], upper[3];  // the box around all; lower > upper where there is nothing
} sheaf_instance_statistics;
#define SHEAF_INSTANCE_STATISTICS_INIT                                       \
  {                                                                          \
    sizeof(sheaf_instance_statistics), 0, 0, 0, 0, 0, {0, 0, 0}, { 0, 0, 0 } \
  }

// Writes all members but `size`, which the caller sets.
SHEAF_API sheaf_status sheaf_instances_get_statistics(const sheaf_instances* instances,
                                                      sheaf_instance_statistics* statistics);

// The nearest hit of each ray; of equal t the lowest instance, then the lowest primitive.
// Primitives and objects are numbered within their geometry. `source_instance`: the instance that a
// ray starts on, whose primitive its source is then, SHEAF_NO_INSTANCE for none; NULL: none for
// all; with the stride of the rays. `instance`: receives the number of the instance,
// SHEAF_NO_INSTANCE where the ray misses; NULL: left out; with the stride of the hits. The rest as
// sheaf_trace_closest.
SHEAF_API sheaf_status sheaf_instances_trace_closest(const sheaf_instances* instances,
                                                     const sheaf_rays* rays,
                                                     const uint32_t* source_instance,
                                                     const sheaf_hits* hits, uint32_t* instance,
                                                     const sheaf_trace_options* options);
// Writes to occluded[0, rays->count): 1 where a ray hits anything within its interval, else 0.
SHEAF_API sheaf_status sheaf_instances_trace_occluded(const sheaf_instances* instances,
                                                      const sheaf_rays* rays,
                                                      const uint32_t* source_instance,
                                                      uint32_t* occluded,
                                                      const sheaf_trace_options* options);

#ifdef __cplusplus
}  // extern "C"
#endif
// NOLINTEND

#endif  // SHEAF_SHEAF_CAPI_INSTANCES_H_
