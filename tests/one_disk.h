// A disk, rays at and beside it, and what 113 bits say of them.
#ifndef SHEAF_TESTS_ONE_DISK_H_
#define SHEAF_TESTS_ONE_DISK_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "exact.h"
#include "random_scene.h"
#include "src/scalar/disk.h"

namespace sheaf {

struct OneDisk {
  Vec3<float> center{0, 0, 0}, normal{0, 0, 1};
  float radius = 1;
  std::uint32_t id = 0;

  DiskArrays<float> arrays() const {
    return {1, &center.x, &center.y, &center.z, &radius, &normal.x, &normal.y, &normal.z, &id};
  }
  GeometryView<float> geometry() const {
    GeometryView<float> view{};
    view.disks = arrays();
    return view;
  }
};

inline OneDisk AnyDisk(Random& random) {
  OneDisk disk;
  disk.center = Rounded(ToVec3(UniformPoint(random, -10, 10)));
  disk.radius = Rounded({std::exp2(Uniform(random, -6, 6)), 0, 0}).x;
  disk.normal = Rounded(RandomUnit(random) * std::exp2(Uniform(random, -3, 3)));
  return disk;
}

// Rays at and beside a disk from 1 to 10^6 radii, half of them grazing it, half of them at its rim.
inline std::vector<scalar::Ray<float>> RaysAt(Random& random, const OneDisk& disk,
                                              double distance) {
  const Vec3<double> n = Normalize(disk.normal.To<double>());
  const scalar::Frame<double> frame(n);
  std::vector<scalar::Ray<float>> rays;
  for (int i = 0; i < 256; ++i) {
    const double rho = i % 4 < 2 ? Uniform(random, 0, 1.5) : 1 + Uniform(random, -1e-5, 1e-5);
    const Vec3<double> across = RandomUnit(random);
    const Vec3<double> rim = Normalize(frame.x * across.x + frame.y * across.y);
    const Vec3<double> target = disk.center.To<double>() + rim * (rho * disk.radius);
    Vec3<double> away = RandomUnit(random);
    const double steep = i % 2 ? 1 : std::pow(10.0, -Uniform(random, 0, 7));
    away = away - n * (Dot(away, n) * (1 - steep));
    const Vec3<float> origin = Rounded(target + away * (distance * disk.radius));
    rays.push_back({origin, Rounded((target - origin.To<double>()) * Uniform(random, 0.1, 2))});
  }
  return rays;
}

// Of the numbers as they stand.
struct ExactDiskHit {
  bool is_parallel;          // to the plane; only the normal is told then
  bool is_hit = false;       // in front of the origin
  bool is_in_doubt = false;  // in the band of docs/numerics.md: a kernel may decide either way
  Exact t = 0;
  Vec3<Exact> normal;

  ExactDiskHit(const scalar::Ray<float>& ray, const OneDisk& disk) {
    const auto o = ray.origin.To<Exact>(), d = ray.direction.To<Exact>();
    const auto c = disk.center.To<Exact>(), n = disk.normal.To<Exact>();
    const Exact r = disk.radius, slope = Dot(n, d);
    normal = Unit(n);
    is_parallel = slope == 0;
    if (is_parallel) return;
    t = Dot(n, c - o) / slope;
    const Vec3<Exact> l = o + d * t - c;
    const Exact l2 = Dot(l, l), reach = Sqrt(Dot(o - c, o - c));
    is_hit = l2 < r * r && t > 0;
    is_in_doubt = Abs(r * r - l2) <= 16 * 0x1p-53 * r * (reach + r);
  }
};

}  // namespace sheaf

#endif  // SHEAF_TESTS_ONE_DISK_H_
