// The part of <sheaf/capi.h> that asks more of a geometry than nearest hits: <sheaf/queries.h> for
// C. Include <sheaf/capi.h>, which includes this and says what holds for every call.
#ifndef SHEAF_SHEAF_CAPI_QUERIES_H_
#define SHEAF_SHEAF_CAPI_QUERIES_H_

#include "sheaf/capi.h"

// NOLINTBEGIN: C has names of its own style
#ifdef __cplusplus
extern "C" {
#endif

// ---- Rays: all hits, masks, filters ----

// Which hits count, besides those within the interval. What is NULL or 0 rules nothing out.
typedef struct sheaf_hit_rules {
  size_t size;
  // A hit on object k counts for ray i where object_mask[k] & ray_mask[i] is not 0: an element an
  // object, and an element a ray; without ray_mask, all_ray_mask for all.
  const uint32_t* object_mask;
  const uint32_t* ray_mask;
  uint32_t all_ray_mask;
  // Primitives that a ray does not hit, `excluded_per_ray` for each ray, one ray's after the
  // other's; SHEAF_NO_PRIMITIVE for none.
  uint32_t excluded_per_ray;
  const uint32_t* excluded;
} sheaf_hit_rules;
#define SHEAF_HIT_RULES_INIT \
  { sizeof(sheaf_hit_rules), NULL, NULL, 0xffffffffu, 0, NULL }

// All hits of rays; what is NULL is left out.
typedef struct sheaf_all_hits {
  size_t size;
  uint32_t capacity;  // hits of a ray that are listed, at most
  // The nearest hits of ray i, in order: elements [i * capacity, i * capacity + listed[i]) of the
  // arrays. The next one, where there is room, is as of a ray that misses.
  const sheaf_hits* hits;
  uint32_t* listed;  // an element a ray
  uint32_t* total;   // an element a ray: how many hits it has, listed or not
} sheaf_all_hits;
#define SHEAF_ALL_HITS_INIT \
  { sizeof(sheaf_all_hits), 0, NULL, NULL, NULL }

// All hits of each ray within its interval, by t, of equal t the lowest primitive first: two of a
// sphere, where the ray enters it (u is 0) and where it leaves it (u is 1). A ray through an edge
// hits both triangles there. `options` and `rules` may be NULL. Fails with SHEAF_USAGE as
// sheaf_trace_closest does.
SHEAF_API sheaf_status sheaf_trace_all(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                       const sheaf_all_hits* hits,
                                       const sheaf_trace_options* options,
                                       const sheaf_hit_rules* rules);

// Hits that a filter is asked about, an element each of every array; those of a ray in their order.
typedef struct sheaf_candidates {
  size_t size;
  size_t count;
  const size_t* ray;  // by its place in the rays of the call
  const float *t, *u, *v;
  const uint32_t *primitive, *object;
} sheaf_candidates;

// Sets accepted[k] to 1 for each candidate k that is a hit; all are 0 before. Called on the thread
// that called, with hits of several rays at a time; none comes twice. It must return: neither throw
// nor jump.
typedef void (*sheaf_hit_filter)(const sheaf_candidates* candidates, uint8_t* accepted, void* user);

// The nearest hit of each ray that the rules admit and the filter accepts, otherwise as
// sheaf_trace_closest. `options`, `rules` and `filter` may be NULL; `user` is handed to the filter.
SHEAF_API sheaf_status sheaf_trace_ruled_closest(const sheaf_geometry* geometry,
                                                 const sheaf_rays* rays, const sheaf_hits* hits,
                                                 const sheaf_trace_options* options,
                                                 const sheaf_hit_rules* rules,
                                                 sheaf_hit_filter filter, void* user);
// Whether each ray has such a hit, as sheaf_trace_occluded.
SHEAF_API sheaf_status sheaf_trace_ruled_occluded(const sheaf_geometry* geometry,
                                                  const sheaf_rays* rays, uint32_t* occluded,
                                                  const sheaf_trace_options* options,
                                                  const sheaf_hit_rules* rules,
                                                  sheaf_hit_filter filter, void* user);

// ---- Inside and outside ----

// Writes to crossings[0, rays->count) how often each ray passes through surfaces: an edge or a
// vertex that triangles share counts once where the ray passes through there, and an even number of
// times where it only touches. A ray from inside a closed mesh has an odd number. Triangles without
// area are left out. `options` and `rules` may be NULL. Fails with SHEAF_USAGE as
// sheaf_trace_closest.
SHEAF_API sheaf_status sheaf_count_crossings(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                             uint32_t* crossings,
                                             const sheaf_trace_options* options,
                                             const sheaf_hit_rules* rules);

// Points, an element each of every array; or structures, where `stride` is their size.
typedef struct sheaf_points {
  size_t size;
  size_t count;
  const float *x, *y, *z;
  size_t stride;  // 0: the arrays hold nothing else
} sheaf_points;
#define SHEAF_POINTS_INIT \
  { sizeof(sheaf_points), 0, NULL, NULL, NULL, 0 }

// Writes to inside[0, points->count): 1 where a point is inside an odd number of closed surfaces,
// meshes and spheres, else 0. The rays of `rules`, which may be NULL, are the points; `target` is
// as in sheaf_trace_options. Fails with SHEAF_USAGE where an array is NULL.
SHEAF_API sheaf_status sheaf_find_inside(const sheaf_geometry* geometry, const sheaf_points* points,
                                         uint32_t* inside, const sheaf_hit_rules* rules,
                                         const char* target);

// ---- Nearest points ----

typedef struct sheaf_nearest_options {
  size_t size;
  const float* max_distance;  // nothing beyond counts: an element a point, or NULL: one for all
  float all_max_distance;
  int32_t is_signed;  // 1: distances are below 0 inside, see sheaf_find_inside
} sheaf_nearest_options;
#define SHEAF_NEAREST_OPTIONS_INIT \
  { sizeof(sheaf_nearest_options), NULL, FLT_MAX, 0 }

// An element a point; NULL: left out.
typedef struct sheaf_nearest {
  size_t size;
  float* distance;      // max_distance where nothing is as near
  uint32_t* primitive;  // SHEAF_NO_PRIMITIVE where nothing is as near
  uint32_t* object;     // likewise
  float* position[3];   // the nearest point of its surface; else 0
} sheaf_nearest;
#define SHEAF_NEAREST_INIT                                        \
  {                                                               \
    sizeof(sheaf_nearest), NULL, NULL, NULL, { NULL, NULL, NULL } \
  }

// The nearest point of any surface to each point, of equal distance the lowest primitive. A sphere
// is its shell, from inside too. `options` and `rules`, whose rays are the points, may be NULL.
// Fails with SHEAF_USAGE where a coordinate is NULL.
SHEAF_API sheaf_status sheaf_find_nearest(const sheaf_geometry* geometry,
                                          const sheaf_points* points, const sheaf_nearest* nearest,
                                          const sheaf_nearest_options* options,
                                          const sheaf_hit_rules* rules);

// ---- Overlap ----

// Which primitives meet a region, ascending; NULL: left out.
typedef struct sheaf_overlaps {
  size_t size;
  uint32_t capacity;  // room for so many primitives a region
  // Those of region i are primitive[i * capacity, i * capacity + listed[i]).
  uint32_t* primitive;
  uint32_t *listed, *total;  // a region: how many are listed, how many meet it
} sheaf_overlaps;
#define SHEAF_OVERLAPS_INIT \
  { sizeof(sheaf_overlaps), 0, NULL, NULL, NULL }

// The primitives that meet the boxes from points `lower` to `upper`, which are as many. Primitives
// are surfaces: a box within a sphere does not meet it.
SHEAF_API sheaf_status sheaf_find_in_boxes(const sheaf_geometry* geometry,
                                           const sheaf_points* lower, const sheaf_points* upper,
                                           const sheaf_overlaps* overlaps);
// The primitives whose nearest point is at most radius[i] away from point i. `radius` is as far
// apart as the points.
SHEAF_API sheaf_status sheaf_find_in_balls(const sheaf_geometry* geometry,
                                           const sheaf_points* points, const float* radius,
                                           const sheaf_overlaps* overlaps);

#ifdef __cplusplus
}
#endif
// NOLINTEND

#endif  // SHEAF_SHEAF_CAPI_QUERIES_H_
