// Random geometry, rays, materials and lights for kernel tests, from a seed and without libm.
#ifndef SHEAF_TESTS_RANDOM_SCENE_H_
#define SHEAF_TESTS_RANDOM_SCENE_H_

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "simd/query.h"
#include "src/render/compile_scene.h"
#include "src/scalar/ray.h"
#include "src/stream/stream.h"

namespace sheaf {

using Random = std::mt19937_64;

// In [low, high); the same numbers with every standard library.
inline double Uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

inline Vec3d UniformPoint(Random& random, double low, double high) {
  const double x = Uniform(random, low, high), y = Uniform(random, low, high);
  return {x, y, Uniform(random, low, high)};
}

inline Vec3<double> ToVec3(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline Vec3d ToGlm(Vec3<double> v) { return {v.x, v.y, v.z}; }

inline Vec3<double> RandomUnit(Random& random) {
  return Normalize(ToVec3(UniformPoint(random, -1, 1)));
}

// `count` objects around the origin: spheres, some far and small or huge, and triangles, some
// slivers, a few of them twice, a few without area.
inline Scene RandomScene(Random& random, int count) {
  Scene scene;
  scene.materials.push_back({});
  for (int i = 0; i < count; ++i) {
    Object object;
    const std::uint64_t kind = random() % 8;
    if (kind < 4) {
      const double radius = kind == 0 ? Uniform(random, 0, 1e-3) : Uniform(random, 0.1, 2);
      object.shape = Sphere{UniformPoint(random, -4, 4), kind == 3 ? 0.0 : radius};
    } else {
      Triangle triangle{
          {UniformPoint(random, -4, 4), UniformPoint(random, -4, 4), UniformPoint(random, -4, 4)}};
      if (kind == 5)
        triangle.vertices[2] = triangle.vertices[1] + UniformPoint(random, -1e-4, 1e-4);
      if (kind == 6) triangle.vertices[2] = triangle.vertices[0];
      object.shape = triangle;
    }
    scene.objects.push_back(object);
    if (random() % 8 == 0) scene.objects.push_back(object);
  }
  return scene;
}

// Triangles with normals, some of them 0, some on the other side, with colours and coordinates.
inline Mesh RandomMesh(Random& random, int triangles) {
  Mesh mesh;
  for (int i = 0; i < 3 * triangles; ++i) {
    mesh.positions.push_back(UniformPoint(random, -4, 4));
    mesh.normals.push_back(UniformPoint(random, -2, 2));
    mesh.colours.push_back(UniformPoint(random, 0, 1));
    mesh.uv.push_back(glm::vec2(UniformPoint(random, -2, 2)));
  }
  for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(triangles); ++i) {
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    // Every fourth is as flat as one without normals.
    for (std::uint32_t k = 0; k < 3 && i % 4 == 0; ++k) mesh.normals[3 * i + k] = glm::vec3(0);
  }
  return mesh;
}

// A ray of any kind: mostly sound, some axis-parallel, some with components that no hit may come
// from.
template <typename Real>
scalar::Ray<Real> RandomRay(Random& random, std::uint32_t primitive_count) {
  const auto real = [](double x) { return static_cast<Real>(x); };
  const Vec3d origin = UniformPoint(random, -6, 6), towards = UniformPoint(random, -3, 3);
  scalar::Ray<Real> ray;
  ray.origin = {real(origin.x), real(origin.y), real(origin.z)};
  ray.direction = {real(towards.x - origin.x), real(towards.y - origin.y),
                   real(towards.z - origin.z)};
  if (random() % 4 == 0) ray.direction = Normalize(ray.direction);
  if (random() % 8 == 0) ray.direction.x = random() % 2 ? Real(0) : -Real(0);
  if (random() % 8 == 0) ray.direction.y = 0;
  if (random() % 16 == 0) ray.direction = ray.direction * real(random() % 2 ? 1e-20 : 1e18);
  if (random() % 64 == 0) ray.direction = {0, 0, 0};
  const Real odd[] = {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(),
                      -std::numeric_limits<Real>::infinity(),
                      std::numeric_limits<Real>::denorm_min()};
  if (random() % 32 == 0) ray.direction.z = odd[random() % 4];
  if (random() % 32 == 0) ray.origin.y = odd[random() % 4];
  if (random() % 4 == 0 && primitive_count > 0) {
    ray.source = static_cast<std::uint32_t>(random() % primitive_count);
    if (random() % 2) ray.source |= kInsideBit;
  }
  if (random() % 4 == 0) ray.t_max = real(Uniform(random, 0, 2));
  if (random() % 8 == 0) ray.t_min = real(Uniform(random, 0, 1));
  if (random() % 32 == 0) ray.t_max = odd[random() % 3];
  if (random() % 32 == 0) ray.t_min = odd[0];
  return ray;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_RANDOM_SCENE_H_
