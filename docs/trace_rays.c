/* Traces 64 x 64 rays at a square and a sphere in front of it, then shadows towards a lamp, in C.
 */
#include <sheaf/capi.h>
#include <stdio.h>

#define COUNT (64 * 64)

static float eye[3][COUNT], direction[3][COUNT], front[3][COUNT], to_lamp[3][COUNT];
static float t[COUNT], u[COUNT], v[COUNT];
static uint32_t primitive[COUNT], object[COUNT], source[COUNT], shadow[COUNT];

static sheaf_status build(sheaf_geometry** geometry) {
  const float corners[] = {-2, -2, -6, 2, -2, -6, 2, 2, -6, -2, 2, -6}; /* x, y, z */
  const uint32_t faces[] = {0, 1, 2, 0, 2, 3};
  const float sphere[] = {0, 0, -4, 0.5f}; /* center, radius */
  sheaf_geometry_input* input = NULL;
  sheaf_triangles square = SHEAF_TRIANGLES_INIT;
  sheaf_status status = sheaf_geometry_input_create(&input);
  square.vertices = corners;
  square.vertex_count = 4;
  square.indices = faces;
  square.triangle_count = 2;
  if (!status) status = sheaf_add_triangles(input, &square, NULL);
  if (!status) status = sheaf_add_spheres(input, sphere, 1, 0, NULL);
  if (!status) status = sheaf_geometry_build(input, NULL, geometry);
  sheaf_geometry_input_destroy(input);
  return status;
}

static sheaf_rays rays_from(float from[3][COUNT], float towards[3][COUNT]) {
  sheaf_rays rays = SHEAF_RAYS_INIT;
  rays.count = COUNT;
  rays.origin_x = from[0];
  rays.origin_y = from[1];
  rays.origin_z = from[2];
  rays.direction_x = towards[0];
  rays.direction_y = towards[1];
  rays.direction_z = towards[2];
  return rays;
}

static sheaf_status trace(const sheaf_geometry* geometry) {
  const float lamp[3] = {1, 2, 0};
  const sheaf_rays rays = rays_from(eye, direction);
  sheaf_rays shadow_rays = rays_from(front, to_lamp);
  sheaf_hits hits = SHEAF_HITS_INIT;
  sheaf_hit_points points = SHEAF_HIT_POINTS_INIT;
  sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
  sheaf_status status;
  int i, k;
  hits.t = t;
  hits.primitive = primitive;
  hits.object = object;
  hits.u = u;
  hits.v = v;
  status = sheaf_trace_closest(geometry, &rays, &hits, NULL);
  /* Shadows begin in front of what was hit. What missed has no direction, and misses again. */
  for (k = 0; k < 3; ++k) points.front[k] = front[k];
  points.front_source = source;
  if (!status) status = sheaf_find_hit_points(geometry, &rays, &hits, &points, NULL);
  for (i = 0; i < COUNT; ++i) {
    if (primitive[i] == SHEAF_NO_PRIMITIVE) continue;
    for (k = 0; k < 3; ++k) to_lamp[k][i] = lamp[k] - front[k][i];
  }
  shadow_rays.source = source;
  options.all_t_max = 1;
  if (!status) status = sheaf_trace_occluded(geometry, &shadow_rays, shadow, &options);
  return status;
}

int main(void) {
  sheaf_geometry* geometry = NULL;
  int i, square = 0, ball = 0, dark = 0;
  for (i = 0; i < COUNT; ++i) {
    direction[0][i] = ((float)(i % 64) - 31.5f) / 64;
    direction[1][i] = ((float)(i / 64) - 31.5f) / 64;
    direction[2][i] = -1;
  }
  if (build(&geometry) || trace(geometry)) {
    fprintf(stderr, "%s\n", sheaf_error_message());
    sheaf_geometry_destroy(geometry);
    return 1;
  }
  sheaf_geometry_destroy(geometry);
  for (i = 0; i < COUNT; ++i) {
    square += object[i] == 0;
    ball += object[i] == 1;
    dark += object[i] == 0 && shadow[i];
  }
  printf("Sheaf %s: square %d, sphere %d, nearest at t = %g, ", sheaf_version(), square, ball,
         t[32 * 64 + 32]);
  printf("%d of the square in shadow\n", dark);
  return 0;
}
