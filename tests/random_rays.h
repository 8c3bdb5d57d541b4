// Random primitives and rays as a user of the library holds them: plain arrays.
#ifndef SHEAF_TESTS_RANDOM_RAYS_H_
#define SHEAF_TESTS_RANDOM_RAYS_H_

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "sheaf/geometry.h"
#include "src/scalar/ray.h"

namespace sheaf {

// A mesh with normals, some of them 0, a mesh without, spheres and disks. Every number is a float.
template <typename Real>
struct RandomObjects {
  std::vector<Real> vertices, normals, bare, spheres, disks;
  std::vector<std::uint32_t> indices;

  RandomObjects(Random& random, std::uint32_t count) {
    const auto add = [&](std::vector<Real>& to, const Vec3d& v) {
      for (int k = 0; k < 3; ++k) to.push_back(static_cast<Real>(static_cast<float>(v[k])));
    };
    for (std::uint32_t i = 0; i < 3 * count; ++i) {
      add(vertices, UniformPoint(random, -4, 4));
      add(bare, UniformPoint(random, -4, 4));
      add(normals, i % 12 < 3 ? Vec3d(0) : UniformPoint(random, -2, 2));
      indices.push_back(i);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      add(spheres, UniformPoint(random, -4, 4));
      spheres.push_back(static_cast<Real>(static_cast<float>(Uniform(random, 0.05, 0.8))));
      add(disks, UniformPoint(random, -4, 4));
      disks.push_back(static_cast<Real>(static_cast<float>(Uniform(random, 0.1, 1))));
      add(disks, UniformPoint(random, -1, 1));
    }
  }

  GeometryInput Input() const {
    GeometryInput input;
    input.AddSpheres(spheres);
    input.AddTriangles(vertices, indices, normals);
    input.AddDisks(disks);
    input.AddTriangles(bare, indices);
    return input;
  }
};

// Rays as arrays.
template <typename Real>
struct RayLists {
  std::vector<Real> number[6], t_min, t_max;
  std::vector<std::uint32_t> source;

  void Add(const scalar::Ray<Real>& ray) {
    const Real numbers[6] = {ray.origin.x,    ray.origin.y,    ray.origin.z,
                             ray.direction.x, ray.direction.y, ray.direction.z};
    for (int k = 0; k < 6; ++k) number[k].push_back(numbers[k]);
    t_min.push_back(ray.t_min);
    t_max.push_back(ray.t_max);
    source.push_back(ray.source);
  }
  std::size_t size() const { return t_min.size(); }
  RayArraysOf<Real> view() const {
    return {number[0].data(), number[1].data(), number[2].data(), number[3].data(),
            number[4].data(), number[5].data(), source.data()};
  }
  TraceIntervalOf<Real> interval() const { return {t_min.data(), t_max.data()}; }
};

template <typename Real>
struct HitLists {
  std::vector<Real> t, u, v;
  std::vector<std::uint32_t> primitive, object;

  explicit HitLists(std::size_t n) : t(n), u(n), v(n), primitive(n), object(n) {}
  HitArraysOf<Real> view() {
    return {t.data(), primitive.data(), object.data(), u.data(), v.data()};
  }
};

}  // namespace sheaf

#endif  // SHEAF_TESTS_RANDOM_RAYS_H_
