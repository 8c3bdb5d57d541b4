// The part of <sheaf/capi.h> for numbers in double: coordinates that floats would round, and
// geometries whose hits have the digits of doubles. Include <sheaf/capi.h>, which includes this and
// says what holds for every call. What ends in _d is as its namesake there, but for its numbers.
#ifndef SHEAF_SHEAF_CAPI_DOUBLE_H_
#define SHEAF_SHEAF_CAPI_DOUBLE_H_

#include "sheaf/capi.h"

// NOLINTBEGIN: C has names of its own style
#ifdef __cplusplus
extern "C" {
#endif

// ---- Objects: for geometries of either kind, which round them to what they are built of ----

typedef struct sheaf_triangles_d {
  size_t size;
  const double* vertices;   // x, y, z of each, finite
  size_t vertex_count;      // below 2^32
  size_t vertex_stride;     // 0: 3 * sizeof(double)
  const uint32_t* indices;  // three vertices a triangle, counter-clockwise seen from its front
  size_t triangle_count;    // at most 2^26
  size_t index_stride;      // of triangles; 0: 3 * sizeof(uint32_t)
  const double* normals;    // for shading, x, y, z a vertex, of any length; NULL: the faces' own
  size_t normal_stride;     // 0: 3 * sizeof(double)
} sheaf_triangles_d;
#define SHEAF_TRIANGLES_D_INIT \
  { sizeof(sheaf_triangles_d), NULL, 0, 0, NULL, 0, 0, NULL, 0 }

SHEAF_API sheaf_status sheaf_add_triangles_d(sheaf_geometry_input* input,
                                             const sheaf_triangles_d* triangles, uint32_t* object);
SHEAF_API sheaf_status sheaf_add_spheres_d(sheaf_geometry_input* input, const double* spheres,
                                           size_t count, size_t stride, uint32_t* object);
SHEAF_API sheaf_status sheaf_add_disks_d(sheaf_geometry_input* input, const double* disks,
                                         size_t count, size_t stride, uint32_t* object);

// ---- Geometries of doubles ----

typedef struct sheaf_geometry_d sheaf_geometry_d;
SHEAF_API sheaf_status sheaf_geometry_build_d(const sheaf_geometry_input* input,
                                              const sheaf_build_options* options,
                                              sheaf_geometry_d** geometry);
SHEAF_API void sheaf_geometry_destroy_d(sheaf_geometry_d* geometry);
SHEAF_API sheaf_status sheaf_geometry_update_d(sheaf_geometry_d* geometry,
                                               const sheaf_geometry_input* input,
                                               const sheaf_update_options* options,
                                               int32_t* rebuilt);
SHEAF_API sheaf_status sheaf_geometry_save_d(const sheaf_geometry_d* geometry, const char* path);
SHEAF_API sheaf_status sheaf_geometry_map_d(const char* path, sheaf_map_check check,
                                            sheaf_geometry_d** geometry);
SHEAF_API sheaf_status sheaf_geometry_get_statistics_d(const sheaf_geometry_d* geometry,
                                                       sheaf_geometry_statistics* statistics);
SHEAF_API sheaf_status sheaf_geometry_first_primitive_d(const sheaf_geometry_d* geometry,
                                                        uint32_t object, uint32_t* primitive);

// ---- Rays of doubles ----

typedef struct sheaf_rays_d {
  size_t size;
  size_t count;
  const double *origin_x, *origin_y, *origin_z;
  const double *direction_x, *direction_y, *direction_z;
  const uint32_t* source;
  size_t stride;
} sheaf_rays_d;
#define SHEAF_RAYS_D_INIT \
  { sizeof(sheaf_rays_d), 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0 }

typedef struct sheaf_trace_options_d {
  size_t size;
  const double *t_min, *t_max;
  double all_t_min, all_t_max;
  size_t interval_stride;
  sheaf_coherence coherence;
  const char* target;
} sheaf_trace_options_d;
#define SHEAF_TRACE_OPTIONS_D_INIT \
  { sizeof(sheaf_trace_options_d), NULL, NULL, DBL_MIN, DBL_MAX, 0, SHEAF_COHERENCE_UNKNOWN, NULL }

typedef struct sheaf_hits_d {
  size_t size;
  double* t;
  uint32_t* primitive;
  uint32_t* object;
  double *u, *v;  // v of a sphere is 0
  size_t stride;
} sheaf_hits_d;
#define SHEAF_HITS_D_INIT \
  { sizeof(sheaf_hits_d), NULL, NULL, NULL, NULL, NULL, 0 }

SHEAF_API sheaf_status sheaf_trace_closest_d(const sheaf_geometry_d* geometry,
                                             const sheaf_rays_d* rays, const sheaf_hits_d* hits,
                                             const sheaf_trace_options_d* options);
SHEAF_API sheaf_status sheaf_trace_occluded_d(const sheaf_geometry_d* geometry,
                                              const sheaf_rays_d* rays, uint32_t* occluded,
                                              const sheaf_trace_options_d* options);

#ifdef __cplusplus
}  // extern "C"
#endif
// NOLINTEND

#endif  // SHEAF_SHEAF_CAPI_DOUBLE_H_
