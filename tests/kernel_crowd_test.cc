// Incoherent rays through trees so large that they go as a crowd, against src/scalar, bit by bit,
// on every target.
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "expected_traces.h"

namespace sheaf {
namespace {

constexpr int kPrimitives = 8000;
constexpr std::uint32_t kLeastNodes = 256;  // of the tree of a crowd

// Primitives of all kinds that reach `size` far, around the origin.
Scene ManyObjects(Random& random, double size) {
  Scene scene;
  scene.materials.push_back({});
  for (int i = 0; i < kPrimitives; ++i) {
    const Vec3d at = UniformPoint(random, -4, 4);
    Object object;
    if (i % 8 == 0) {
      object.shape = Sphere{at, 0.3 * size};
    } else if (i % 8 == 1) {
      object.shape = Disk{at, 0.5 * size, UniformPoint(random, -1, 1)};
    } else {
      object.shape = Triangle{
          {at, at + UniformPoint(random, -size, size), at + UniformPoint(random, -size, size)}};
    }
    scene.objects.push_back(object);
  }
  return scene;
}

// Neighbours go different ways. Every hundredth ray is one that box tests do not hold for.
template <typename Real>
std::vector<scalar::Ray<Real>> StrayRays(Random& random, std::uint32_t count) {
  std::vector<scalar::Ray<Real>> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    scalar::Ray<Real> ray;
    ray.origin = As<Real>(UniformPoint(random, -4, 4));
    ray.direction = As<Real>(UniformPoint(random, -1, 1));
    if (i % 3 == 0) ray.t_max = static_cast<Real>(Uniform(random, 0, 4));
    if (i % 5 == 0) ray.t_min = static_cast<Real>(Uniform(random, 0, 2));
    if (i % 7 == 0) ray.source = i % kPrimitives;
    if (i % 14 == 0) ray.source |= kInsideBit;
    if (i % 16 == 0) ray.direction.x = 0;
    if (i % 100 == 50) ray.direction = ray.direction * Real(0x1p100);
    if (i % 100 == 51) ray.t_min = -1;
    rays.push_back(ray);
  }
  return rays;
}

TEST_CASE_TEMPLATE("a crowd traces as the scalar specification", Real, float, double) {
  Random random(11);
  const Expected<Real> want(ManyObjects(random, 0.3), StrayRays<Real>(random, 3000));
  CHECK(want.tree.view().node_count >= kLeastNodes);
  CHECK(want.hit_count() > 1000);
  CHECK(want.hit_count() < 2900);
  CheckEverywhere(want);
}

// Boxes lie in one another: rays meet all children of most nodes, until lists have no room.
TEST_CASE_TEMPLATE("a crowd among primitives that overlap traces as the scalar specification", Real,
                   float, double) {
  Random random(12);
  std::vector<scalar::Ray<Real>> rays = StrayRays<Real>(random, 4096);
  for (std::size_t i = 0; i < rays.size(); i += 2) {
    // Of one octant.
    Vec3<Real>& direction = rays[i].direction;
    direction = {std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)};
  }
  const Expected<Real> want(ManyObjects(random, 40), rays);
  CHECK(want.tree.view().node_count >= kLeastNodes);
  CheckEverywhere(want);
}

}  // namespace
}  // namespace sheaf
