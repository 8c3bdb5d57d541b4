// Sheaf for C (C99 and later) and for languages that call C.
//
//   sheaf_geometry_input* input = NULL;
//   sheaf_geometry* geometry = NULL;
//   sheaf_triangles mesh = SHEAF_TRIANGLES_INIT;    // then set its arrays
//   if (sheaf_geometry_input_create(&input) || sheaf_add_triangles(input, &mesh, NULL) ||
//       sheaf_geometry_build(input, NULL, &geometry)) {
//     fprintf(stderr, "%s\n", sheaf_error_message());
//   }
//
// Handles. The types without members are made by the function that takes a pointer to a pointer to
// one, which is written where the call succeeds and becomes NULL where it fails. Each has a
// `..._destroy`, which takes NULL too.
//
// Errors. A function that can fail returns a sheaf_status, 0 being success. A message of one line
// is then kept for the thread that called. Nothing is thrown and nothing ends the program. A
// pointer that must not be NULL and is, fails with SHEAF_USAGE.
//
// Structures. Each begins with its size, as the program that was compiled knows it, and its
// SHEAF_..._INIT sets that and the defaults; begin with it. Later versions of the library add
// members at the end: a program that knows fewer gets the defaults, and one that sets a member that
// the library does not know yet fails with SHEAF_USAGE.
//
// Arrays are never owned, kept or freed by the library but where it says so. They need no padding
// nor more alignment than their type. A stride is the number of bytes from an element to the next.
//
// Threads. Any number of threads may call anything at once, as long as nobody changes or destroys a
// handle that another call uses. Geometries, scenes and films are never changed by a call that
// takes them as const.
//
// Lengths are in one unit of the user's choice, colours are linear RGB, pictures have their rows
// from the top.
#ifndef SHEAF_SHEAF_CAPI_H_
#define SHEAF_SHEAF_CAPI_H_

#include <float.h>
#include <stddef.h>
#include <stdint.h>

#include "sheaf/version.h"

// NOLINTBEGIN: C has names of its own style
#ifdef __cplusplus
extern "C" {
#endif

// ---- Errors, versions, targets ----

typedef enum sheaf_status {
  SHEAF_OK = 0,
  SHEAF_USAGE = 1,          // the call asks for what does not exist or does not fit
  SHEAF_BAD_SCENE = 2,      // the scene is malformed or cannot be rendered
  SHEAF_INPUT_OUTPUT = 3,   // a file cannot be read or written
  SHEAF_INTERRUPTED = 4,    // sheaf_progress_stop was called
  SHEAF_OUT_OF_MEMORY = 5,  // nothing has changed
  SHEAF_INTERNAL = 6        // an error of the library
} sheaf_status;

// What went wrong in the last call on this thread that failed: UTF-8, one line that names the
// place;
// "" before any did. Lives until the next call that fails on this thread, or the thread's end.
SHEAF_API const char* sheaf_error_message(void);

// The version of the library that runs, like "0.2.0"; SHEAF_VERSION_STRING is that of this header.
SHEAF_API const char* sheaf_version(void);
// Version, compiler, build type and optional parts, a line each. Lives as long as the process.
SHEAF_API const char* sheaf_build_info(void);

// The SIMD targets that this processor runs, best first: names like "avx2". NULL from index
// sheaf_target_count() on. The baseline, "scalar", is not among them. They live as long as the
// process.
SHEAF_API size_t sheaf_target_count(void);
SHEAF_API const char* sheaf_target_name(size_t index);

// ---- Geometry: to trace rays of one's own ----

// In place of a primitive's id: none.
#define SHEAF_NO_PRIMITIVE 0x7fffffffu
// With a sphere's id as a ray's source: the ray runs inside the sphere.
#define SHEAF_INSIDE_BIT 0x80000000u

// A list of objects to build of. Objects are numbered from 0 in the order of the calls, primitives
// from 0 through all objects.
typedef struct sheaf_geometry_input sheaf_geometry_input;
SHEAF_API sheaf_status sheaf_geometry_input_create(sheaf_geometry_input** input);
SHEAF_API void sheaf_geometry_input_destroy(sheaf_geometry_input* input);

// A mesh. A triangle without area is never hit.
typedef struct sheaf_triangles {
  size_t size;
  const float* vertices;    // x, y, z of each, finite
  size_t vertex_count;      // below 2^32
  size_t vertex_stride;     // 0: 3 * sizeof(float)
  const uint32_t* indices;  // three vertices a triangle, counter-clockwise seen from its front
  size_t triangle_count;    // at most 2^26
  size_t index_stride;      // of triangles; 0: 3 * sizeof(uint32_t)
  const float* normals;     // for shading, x, y, z a vertex, of any length; NULL: the faces' own
  size_t normal_stride;     // 0: 3 * sizeof(float)
} sheaf_triangles;
#define SHEAF_TRIANGLES_INIT \
  { sizeof(sheaf_triangles), NULL, 0, 0, NULL, 0, 0, NULL, 0 }

// These add an object and write its number to `object`, which may be NULL. Arrays are read by
// sheaf_geometry_build and must live until the last of its calls has returned; but those that have
// a stride of their own are copied at once. What they hold is checked by sheaf_geometry_build; fail
// with SHEAF_USAGE where a stride is no multiple of four bytes or an array is NULL and not empty.
SHEAF_API sheaf_status sheaf_add_triangles(sheaf_geometry_input* input,
                                           const sheaf_triangles* triangles, uint32_t* object);
// `spheres`: center x, y, z and radius >= 0 of each, `stride` bytes apart; 0: 4 * sizeof(float).
SHEAF_API sheaf_status sheaf_add_spheres(sheaf_geometry_input* input, const float* spheres,
                                         size_t count, size_t stride, uint32_t* object);
// `disks`: center x, y, z, radius >= 0 and normal x, y, z of each; 0: 7 * sizeof(float).
SHEAF_API sheaf_status sheaf_add_disks(sheaf_geometry_input* input, const float* disks,
                                       size_t count, size_t stride, uint32_t* object);

typedef struct sheaf_build_options {
  size_t size;
  int32_t threads;          // at most so many; 0: one a core
  int32_t skip_not_finite;  // 0: a number that is not finite fails; 1: its primitive is left out
} sheaf_build_options;
#define SHEAF_BUILD_OPTIONS_INIT \
  { sizeof(sheaf_build_options), 0, 0 }

// Objects with a tree over their primitives. Only sheaf_geometry_update changes one.
typedef struct sheaf_geometry sheaf_geometry;
// `options` may be NULL. Fails with SHEAF_USAGE and the object's and the primitive's number where
// an index is out of range, a number is not finite or a radius is negative. The input may be
// destroyed afterwards, or be added to and built again.
SHEAF_API sheaf_status sheaf_geometry_build(const sheaf_geometry_input* input,
                                            const sheaf_build_options* options,
                                            sheaf_geometry** geometry);
SHEAF_API void sheaf_geometry_destroy(sheaf_geometry* geometry);

typedef struct sheaf_update_options {
  size_t size;
  int32_t threads;          // at most so many; 0: one a core
  int32_t skip_not_finite;  // as of sheaf_build_options
  // A tree that costs more than this many times as much as the last that was built is built anew;
  // 0 always builds.
  double rebuild_ratio;
} sheaf_update_options;
#define SHEAF_UPDATE_OPTIONS_INIT \
  { sizeof(sheaf_update_options), 0, 0, 1.5 }

// Makes of a geometry what sheaf_geometry_build makes of the input, which is faster where
// primitives have moved and are otherwise as before: the tree is fitted to them, and *rebuilt is 0.
// It is 1 where the tree was built anew. `options` and `rebuilt` may be NULL. Nobody else may use
// the geometry meanwhile. Fails as sheaf_geometry_build does, or with SHEAF_USAGE where the
// geometry stands in instances; it is then as it was. After SHEAF_OUT_OF_MEMORY it has to be
// updated again before it is used.
SHEAF_API sheaf_status sheaf_geometry_update(sheaf_geometry* geometry,
                                             const sheaf_geometry_input* input,
                                             const sheaf_update_options* options, int32_t* rebuilt);

// Writes the geometry with its tree to a file: the old file or the whole new one is there, whatever
// happens. `path` is UTF-8. Fails with SHEAF_INPUT_OUTPUT. Such a file belongs to the version of
// Sheaf and the kind of machine that wrote it.
SHEAF_API sheaf_status sheaf_geometry_save(const sheaf_geometry* geometry, const char* path);

typedef enum sheaf_map_check {
  SHEAF_MAP_CHECK_ALL = 0,    // reads all of the file: checksums, indices, boxes
  SHEAF_MAP_CHECK_HEADER = 1  // header and sizes alone, for a file that is known to be sound
} sheaf_map_check;

// The geometry of a file that sheaf_geometry_save wrote: the same hits to the bit. The file is
// mapped read-only and its pages are shared with all that map it; it must not be written to
// meanwhile, but may be saved to again, renamed or removed. Fails with SHEAF_INPUT_OUTPUT, the path
// and what is wrong where the file cannot be read or is damaged.
SHEAF_API sheaf_status sheaf_geometry_map(const char* path, sheaf_map_check check,
                                          sheaf_geometry** geometry);

typedef struct sheaf_geometry_statistics {
  size_t size;
  uint32_t objects;                    // that were added
  uint32_t primitives;                 // in the tree, of all kinds
  uint32_t triangles, spheres, disks;  // of these
  uint32_t never_hit, skipped;         // left out: no ray can hit them; they were not finite
  uint32_t nodes, leaves, depth;       // of the tree
  uint64_t bytes;                      // of memory, all that the geometry holds
  float lower[3], upper[3];            // the box around it; lower > upper where it is empty
} sheaf_geometry_statistics;
#define SHEAF_GEOMETRY_STATISTICS_INIT                                                         \
  {                                                                                            \
    sizeof(sheaf_geometry_statistics), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, {0, 0, 0}, { 0, 0, 0 } \
  }

// Writes all members but `size`, which the caller sets. Walks the whole tree.
SHEAF_API sheaf_status sheaf_geometry_get_statistics(const sheaf_geometry* geometry,
                                                     sheaf_geometry_statistics* statistics);
// The first primitive of an object, or for the number of objects that of all primitives given.
SHEAF_API sheaf_status sheaf_geometry_first_primitive(const sheaf_geometry* geometry,
                                                      uint32_t object, uint32_t* primitive);

// Rays, an element each of every array; or structures, where `stride` is their size.
typedef struct sheaf_rays {
  size_t size;
  size_t count;
  const float *origin_x, *origin_y, *origin_z;
  // Of any length but 0: t counts in lengths of it. A ray with a component that is not finite
  // misses.
  const float *direction_x, *direction_y, *direction_z;
  // The primitive that a ray starts on, SHEAF_NO_PRIMITIVE for none; NULL: none for all. It is not
  // hit again; a sphere is with SHEAF_INSIDE_BIT, in its far root alone.
  const uint32_t* source;
  size_t stride;  // the same in all arrays; 0: they hold nothing else, which is faster
} sheaf_rays;
#define SHEAF_RAYS_INIT \
  { sizeof(sheaf_rays), 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, 0 }

// What is known of a batch. It may change the time, never a hit.
typedef enum sheaf_coherence {
  SHEAF_COHERENCE_UNKNOWN = 0,  // measured
  SHEAF_COMMON_ORIGIN = 1,      // measured; neighbours share their origin
  SHEAF_COHERENT = 2,           // neighbours go similar ways from different origins
  SHEAF_INCOHERENT = 3          // neighbours go different ways
} sheaf_coherence;

typedef struct sheaf_trace_options {
  size_t size;
  // A hit at t counts where t_min <= t <= t_max: an array with a value a ray, or NULL: one for all.
  const float *t_min, *t_max;
  float all_t_min, all_t_max;
  size_t interval_stride;  // of both arrays; 0: they hold nothing else
  sheaf_coherence coherence;
  const char* target;  // NULL: the best; "scalar" or a target's name. The hits are the same bits
} sheaf_trace_options;
#define SHEAF_TRACE_OPTIONS_INIT \
  { sizeof(sheaf_trace_options), NULL, NULL, FLT_MIN, FLT_MAX, 0, SHEAF_COHERENCE_UNKNOWN, NULL }

// Where hits are written, an element a ray; NULL: left out. No array overlaps another nor the rays.
typedef struct sheaf_hits {
  size_t size;
  float* t;             // in lengths of the direction; t_max where the ray misses
  uint32_t* primitive;  // SHEAF_NO_PRIMITIVE where the ray misses
  uint32_t* object;     // likewise
  // Triangle: the barycentric weights of the second and the third vertex. Sphere: u is 0 where the
  // ray enters, 1 where it leaves; t + v is the distance to twice the digits. Disk: its surface
  // coordinates, (0.5, 0.5) in the middle. 0 where the ray misses.
  float *u, *v;
  size_t stride;  // of all that are there; 0: the arrays hold nothing else
} sheaf_hits;
#define SHEAF_HITS_INIT \
  { sizeof(sheaf_hits), NULL, NULL, NULL, NULL, NULL, 0 }

// The nearest hit of each ray; of equal t the lowest primitive. `options` may be NULL. Fails with
// SHEAF_USAGE where an origin or a direction is NULL or the target is unknown, before anything is
// written.
SHEAF_API sheaf_status sheaf_trace_closest(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                           const sheaf_hits* hits,
                                           const sheaf_trace_options* options);
// Writes to occluded[0, rays->count): 1 where a ray hits anything within its interval, else 0.
SHEAF_API sheaf_status sheaf_trace_occluded(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                            uint32_t* occluded, const sheaf_trace_options* options);

// What was hit, and where to go on: arrays of x, of y and of z, an element a ray; NULL: left out.
// All 0, and sources SHEAF_NO_PRIMITIVE, where the ray missed.
typedef struct sheaf_hit_points {
  size_t size;
  float* position[3];  // on the surface, to a rounding
  float* face[3];      // normal of the surface: unit, towards the ray
  float* normal[3];    // for shading: unit, on the side of `face`
  // A little off the surface: rays from `front` with `front_source` that leave on the side where
  // the ray came from do not meet the primitive again; those from `back` on the other side.
  float *front[3], *back[3];
  uint32_t *front_source, *back_source;
  uint32_t* side;  // 0: the ray came from outside, 1: from inside
} sheaf_hit_points;
#define SHEAF_HIT_POINTS_INIT                                                             \
  {                                                                                       \
    sizeof(sheaf_hit_points), {NULL, NULL, NULL}, {NULL, NULL, NULL}, {NULL, NULL, NULL}, \
        {NULL, NULL, NULL}, {NULL, NULL, NULL}, NULL, NULL, NULL                          \
  }

// The points of hits that sheaf_trace_closest found for these rays: t, primitive, u and v are read.
// `target` as in sheaf_trace_options. Fails with SHEAF_USAGE where one of these arrays is NULL or a
// primitive is none of this geometry's; what is written then is undefined.
SHEAF_API sheaf_status sheaf_find_hit_points(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                             const sheaf_hits* hits, const sheaf_hit_points* points,
                                             const char* target);

// ---- Scenes and pictures ----

typedef struct sheaf_read_options {
  size_t size;
  int32_t allow_outside;  // 1: the scene may name files outside of its folder
  double aspect;          // width over height that a model without a camera is framed for; 0: 4 / 3
  double time;            // seconds of a model's animations; below 0: the model at rest
} sheaf_read_options;
#define SHEAF_READ_OPTIONS_INIT \
  { sizeof(sheaf_read_options), 0, 0.0, -1.0 }

// What a scene or model file describes. A model gets the camera and the lights that it lacks.
typedef struct sheaf_scene sheaf_scene;
// The format follows from the ending of `path`, UTF-8. `options` may be NULL. Fails with
// SHEAF_INPUT_OUTPUT where a file cannot be read, with SHEAF_BAD_SCENE where it is malformed.
SHEAF_API sheaf_status sheaf_scene_read(const char* path, const sheaf_read_options* options,
                                        sheaf_scene** scene);
// Reads scene JSON of `length` bytes. `name` stands for a file's in messages, and what the scene
// names lies relative to it.
SHEAF_API sheaf_status sheaf_scene_parse(const char* text, size_t length, const char* name,
                                         sheaf_scene** scene);
SHEAF_API void sheaf_scene_destroy(sheaf_scene* scene);

// What was left out or replaced, a line each; NULL from index sheaf_scene_warning_count() on. They
// live as long as the scene. A scene that is NULL has none.
SHEAF_API size_t sheaf_scene_warning_count(const sheaf_scene* scene);
SHEAF_API const char* sheaf_scene_warning(const sheaf_scene* scene, size_t index);

// How light is followed.
typedef enum sheaf_integrator {
  SHEAF_SCENE_INTEGRATOR = 0,  // as the scene says
  SHEAF_WHITTED = 1,           // mirrors, glass and hard shadows alone
  SHEAF_DISTRIBUTED = 2,       // lights with a size, rough surfaces and lenses are sampled
  SHEAF_PATH = 3               // light that surfaces send to one another is followed too
} sheaf_integrator;

// The picture that a scene's file asks for.
typedef struct sheaf_settings {
  size_t size;
  int32_t width, height;  // pixels
  int32_t samples;        // a pixel
  int32_t max_depth;
  sheaf_integrator integrator;
} sheaf_settings;
#define SHEAF_SETTINGS_INIT \
  { sizeof(sheaf_settings), 0, 0, 0, 0, SHEAF_SCENE_INTEGRATOR }
SHEAF_API sheaf_status sheaf_scene_get_settings(const sheaf_scene* scene, sheaf_settings* settings);

typedef enum sheaf_projection {
  SHEAF_PERSPECTIVE = 0,      // lens: the full vertical angle in degrees, in (0, 180)
  SHEAF_ORTHOGRAPHIC = 1,     // lens: the picture's height, in (0, 1e30]
  SHEAF_EQUIRECTANGULAR = 2,  // all directions; lens is not read
  SHEAF_FISHEYE = 3           // lens: the full angle across the picture's height, in (0, 360]
} sheaf_projection;

typedef struct sheaf_camera {
  size_t size;
  double eye[3], look_at[3], up[3];
  sheaf_projection projection;
  double lens;
  // Depth of field, of perspective and orthographic cameras.
  double aperture;  // the lens' diameter; 0: all is sharp, and the members below are not read
  double focus;     // how far ahead the plane that is sharp lies; 0: as far as look_at
  double rotation;  // of the blades, degrees counter-clockwise
  int32_t blades;   // corners of the aperture, 3 to 64; 0: round
} sheaf_camera;
#define SHEAF_CAMERA_INIT                                                                      \
  {                                                                                            \
    sizeof(sheaf_camera), {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, SHEAF_PERSPECTIVE, 60.0, 0.0, 0.0, \
        0.0, 0                                                                                 \
  }

SHEAF_API size_t sheaf_scene_camera_count(const sheaf_scene* scene);
// Lives as long as the scene; NULL from index sheaf_scene_camera_count() on.
SHEAF_API const char* sheaf_scene_camera_name(const sheaf_scene* scene, size_t index);
// Writes all members but `size`, which the caller sets.
SHEAF_API sheaf_status sheaf_scene_get_camera(const sheaf_scene* scene, size_t index,
                                              sheaf_camera* camera);

// What other threads see of a frame that renders, and by which they stop it. For one frame; it may
// be read and stopped by any number of threads.
typedef struct sheaf_progress sheaf_progress;
SHEAF_API sheaf_status sheaf_progress_create(sheaf_progress** progress);
SHEAF_API void sheaf_progress_destroy(sheaf_progress* progress);
SHEAF_API uint64_t sheaf_progress_pixels_done(const sheaf_progress* progress);
// The frame ends within a pixel or so, with SHEAF_INTERRUPTED. Safe in a signal handler.
SHEAF_API void sheaf_progress_stop(sheaf_progress* progress);

typedef enum sheaf_precision {
  SHEAF_STRICT = 0,  // float: the same bits on every target
  SHEAF_FAST = 1,    // float, fused: other bits on every target; not on "scalar"
  SHEAF_DOUBLE = 2   // double: the same bits on every target
} sheaf_precision;

// What a picture holds of each pixel besides its colour; bits, for sheaf_render_options::layers.
typedef enum sheaf_layer {
  SHEAF_DEPTH = 1,   // 1 number: distance from the ray's origin; infinite where it met nothing
  SHEAF_NORMAL = 2,  // 3: of shading, unit, facing the ray; else 0
  SHEAF_ALBEDO = 4,  // 3: base colour; else 0
  SHEAF_ID = 8,      // 1: one more than the object's number; else 0
  SHEAF_HEAT = 16    // 3, of the tile: microseconds a pixel, share of live lanes, rays a pixel
} sheaf_layer;

typedef struct sheaf_render_options {
  size_t size;
  size_t camera;             // of the scene's; below sheaf_scene_camera_count()
  const sheaf_camera* view;  // instead, where it is not NULL
  int32_t width, height;     // pixels, at most 65536; 0: the scene's
  int32_t samples;           // a pixel, at most 65536; 0: the scene's
  int32_t max_depth;         // of rays, primary rays having 0, at most 1000000; -1: the scene's
  int32_t crop[4];           // x0, y0, x1, y1 in pixels: that part alone; all 0: the whole
  int32_t threads;           // at most so many, up to 1024; 0: one a core
  sheaf_precision precision;
  uint32_t layers;           // a sum of sheaf_layer
  const char* target;        // NULL: the best; "scalar" or a target's name
  sheaf_progress* progress;  // NULL: none
  sheaf_integrator integrator;
  // Samples until a pixel's standard error is at most this, in (0, 1]: 16 at least, `samples`, no
  // fewer, at most; 0: as the scene says, where that says `samples` too, else all samples.
  double error;
  // Seconds in which samples go where the error is largest, at most until `error` is reached; the
  // picture is that of the error that the statistics tell. `samples` of 0 are then 65536. 0: none.
  double budget;
} sheaf_render_options;
#define SHEAF_RENDER_OPTIONS_INIT                                                               \
  {                                                                                             \
    sizeof(sheaf_render_options), 0, NULL, 0, 0, 0, -1, {0, 0, 0, 0}, 0, SHEAF_STRICT, 0, NULL, \
        NULL, SHEAF_SCENE_INTEGRATOR, 0.0, 0.0                                                  \
  }

typedef struct sheaf_render_statistics {
  size_t size;
  uint64_t primary_rays, shadow_rays, reflected_rays, refracted_rays;
  uint64_t traced_rays;  // all that went through the tree
  double build_seconds;  // from the scene to a tree
  double render_seconds;
  uint64_t buffer_bytes;  // of all threads
  int32_t threads;        // that took part
  int32_t rounds;         // of a frame with a budget: how many were whole; else 0, as are these:
  double error;           // that all pixels have
  uint64_t samples;       // of all pixels
} sheaf_render_statistics;
#define SHEAF_RENDER_STATISTICS_INIT \
  { sizeof(sheaf_render_statistics), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 }

// A picture in linear light.
typedef struct sheaf_film sheaf_film;
// Renders what a camera sees. The scene keeps what was made of it, such as its trees, for its next
// picture. `options` and `statistics` may be NULL. Blocks until the frame is done or has failed:
// with SHEAF_USAGE where an option is out of range, with SHEAF_BAD_SCENE where the scene cannot be
// rendered, with SHEAF_INTERRUPTED where it was stopped.
SHEAF_API sheaf_status sheaf_render(const sheaf_scene* scene, const sheaf_render_options* options,
                                    sheaf_render_statistics* statistics, sheaf_film** film);
// Copies a picture: `rgb` has three floats a pixel, `row_stride` bytes between rows; 0: no gaps.
// Sides in [1, 65536].
SHEAF_API sheaf_status sheaf_film_create(int32_t width, int32_t height, const float* rgb,
                                         size_t row_stride, sheaf_film** film);
// Reads a .png, a .pfm or an .exr with the layers that it has. Colours of a .png that says that
// they are sRGB become linear; others are as they lie in the file, 0 to 1.
SHEAF_API sheaf_status sheaf_film_read(const char* path, sheaf_film** film);
SHEAF_API void sheaf_film_destroy(sheaf_film* film);

// Pixels a side; 0 of NULL.
SHEAF_API int32_t sheaf_film_width(const sheaf_film* film);
SHEAF_API int32_t sheaf_film_height(const sheaf_film* film);
// Three floats a pixel, without gaps. Belongs to the film and lives as long; NULL of NULL.
SHEAF_API const float* sheaf_film_rgb(const sheaf_film* film);
// The numbers of a layer, as many a pixel as sheaf_layer says; NULL where the film lacks it.
SHEAF_API const float* sheaf_film_layer(const sheaf_film* film, sheaf_layer layer);

typedef struct sheaf_picture_options {
  size_t size;
  int32_t bits;     // a channel: 8 or 16 of a .png, 16 or 32 of an .exr; 0: 8, or 32 of the others
  int32_t linear;   // of a .png, 0: encoded as sRGB, 1: linear
  int32_t filmic;   // of a .png, 1: highlights are rolled off
  double ev;        // of a .png: light is multiplied by 2^ev, in [-64, 64]
  uint32_t layers;  // a sum of sheaf_layer, where the format holds layers; the film has them
} sheaf_picture_options;
#define SHEAF_PICTURE_OPTIONS_INIT \
  { sizeof(sheaf_picture_options), 0, 0, 0, 0.0, 0 }

// Writes a .png, .pfm or .exr by the ending of `path`, UTF-8. The file appears complete or not at
// all. `options` may be NULL. Fails with SHEAF_USAGE where the ending or an option does not fit,
// with SHEAF_INPUT_OUTPUT where the file cannot be written. No two calls may write one file at
// once.
SHEAF_API sheaf_status sheaf_film_write(const sheaf_film* film, const char* path,
                                        const sheaf_picture_options* options);

#ifdef __cplusplus
}  // extern "C"
#endif
// NOLINTEND

#include "sheaf/capi_double.h"     // IWYU pragma: export
#include "sheaf/capi_instances.h"  // IWYU pragma: export
#include "sheaf/capi_queries.h"    // IWYU pragma: export

#endif  // SHEAF_SHEAF_CAPI_H_
