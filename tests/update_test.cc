// A geometry whose vertices move: whatever it was before, its hits are those of a fresh build.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "random_rays.h"
#include "same_geometry.h"
#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/refit_tree.h"
#include "src/bvh/validate_tree.h"

namespace sheaf {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();  // builds anew

template <typename Real>
void CheckSound(const GeometryOf<Real>& geometry, const GeometryInput& input) {
  auto flat = GeometryAccess::FlattenTo<Real>(input, {}).value();
  Rescale(flat);
  CHECK(FindTreeDefect(GeometryAccess::TreeOf(geometry), flat.arrays.view()) == "");
}

TEST_CASE_TEMPLATE("random moves give the hits of a fresh build", Real, float, double) {
  Random random(23);
  for (const std::uint32_t count : {1u, 3u, 40u, 900u}) {
    RandomObjects<Real> objects(random, count);
    auto geometry = GeometryOf<Real>::Build(objects.Input()).value();
    for (int step = 0; step < 6; ++step) {
      CAPTURE(step);
      MoveObjects(random, step < 3 ? 0.05 : 4, objects);
      const UpdateOptions options{.threads = 1 + step % 3, .rebuild_ratio = kNever};
      CHECK(geometry.Update(objects.Input(), options).value() == Updated::kRefitted);
      CheckSound(geometry, objects.Input());
      CheckSame(geometry, GeometryOf<Real>::Build(objects.Input()).value(), random);
    }
  }
}

TEST_CASE("threads do not change a refitted tree") {
  Random random(7);
  RandomObjects<float> objects(random, 3000);
  auto one = Geometry::Build(objects.Input()).value();
  auto many = Geometry::Build(objects.Input()).value();
  MoveObjects(random, 1, objects);
  one.Update(objects.Input(), {.threads = 1, .rebuild_ratio = kNever}).value();
  many.Update(objects.Input(), {.threads = 4, .rebuild_ratio = kNever}).value();
  const TreeView<float>&a = GeometryAccess::TreeOf(one), &b = GeometryAccess::TreeOf(many);
  REQUIRE(a.node_count == b.node_count);
  REQUIRE(a.node_count > 600);
  CHECK(std::memcmp(a.nodes, b.nodes, a.node_count * sizeof(TreeNode)) == 0);
  CHECK(std::memcmp(a.lower, b.lower, sizeof(a.lower)) == 0);
}

TEST_CASE("a tree that has become dear is built anew, others are not") {
  Random random(11);
  RandomObjects<float> objects(random, 2000);
  auto geometry = Geometry::Build(objects.Input()).value();
  const double built = CostOfTree(GeometryAccess::TreeOf(geometry));
  CHECK(built > 1);
  CHECK(geometry.Update(objects.Input()).value() == Updated::kRefitted);
  CHECK(CostOfTree(GeometryAccess::TreeOf(geometry)) == built);
  CHECK(geometry.Update(objects.Input(), {.rebuild_ratio = 0}).value() == Updated::kRebuilt);

  // Small triangles that change places at random: the old tree is worth nothing.
  for (std::size_t i = 0; i < objects.vertices.size(); ++i) {
    objects.vertices[i] = objects.vertices[i % 3 + i / 9 * 9] + 0.01f * static_cast<float>(i % 7);
    objects.bare[i] = objects.bare[i % 3 + i / 9 * 9] + 0.01f * static_cast<float>(i % 7);
  }
  geometry = Geometry::Build(objects.Input()).value();
  for (std::size_t i = 0; i < objects.bare.size(); ++i) {
    std::swap(objects.bare[i], objects.bare[objects.bare.size() - 9 - i / 9 * 9 + i % 9]);
  }
  for (std::size_t i = 0; i < objects.vertices.size() / 9; ++i) {
    const double by = Uniform(random, -8, 8);
    for (std::size_t k = 0; k < 9; ++k) objects.vertices[9 * i + k] += static_cast<float>(by);
  }
  CHECK(geometry.Update(objects.Input()).value() == Updated::kRebuilt);
  CheckSame(geometry, Geometry::Build(objects.Input()).value(), random);
  // What the ratio is of is the last build.
  CHECK(geometry.Update(objects.Input()).value() == Updated::kRefitted);
}

TEST_CASE_TEMPLATE("objects come, go and change", Real, float, double) {
  Random random(5);
  RandomObjects<Real> few(random, 20), many(random, 50);
  GeometryOf<Real> geometry;
  for (const auto* objects : {&few, &many, &few}) {
    CHECK(geometry.Update(objects->Input()).value() == Updated::kRebuilt);
    CheckSame(geometry, GeometryOf<Real>::Build(objects->Input()).value(), random);
  }
  // As many primitives, of other kinds.
  std::vector<Real> spheres(4 * 7, 1), disks(7 * 7, 1);
  GeometryInput first, second;
  first.AddSpheres(spheres), first.AddDisks(disks);
  second.AddDisks(disks), second.AddSpheres(spheres);
  CHECK(geometry.Update(first).value() == Updated::kRebuilt);
  CHECK(geometry.Update(second).value() == Updated::kRebuilt);
  CheckSame(geometry, GeometryOf<Real>::Build(second).value(), random);
  CHECK(geometry.Update(GeometryInput()).value() == Updated::kRebuilt);
  CHECK(geometry.object_count() == 0);
}

TEST_CASE("what can be hit no more, or again, and other scales") {
  Random random(3);
  RandomObjects<float> objects(random, 60);
  const UpdateOptions options{.rebuild_ratio = kNever};
  auto geometry = Geometry::Build(objects.Input()).value();
  const auto check = [&](Updated expected) {
    CHECK(geometry.Update(objects.Input(), options).value() == expected);
    CheckSame(geometry, Geometry::Build(objects.Input()).value(), random);
    CheckSound(geometry, objects.Input());
  };
  const float radius = objects.spheres[3];
  objects.spheres[3] = 0;
  check(Updated::kRebuilt);
  MoveObjects(random, 0.1, objects);
  check(Updated::kRefitted);  // around what cannot be hit
  // Another sphere instead: as many as before.
  objects.spheres[3] = radius;
  objects.spheres[7] = 0;
  check(Updated::kRebuilt);
  // One that is larger than boxes can be, and triangles beyond where products fit.
  objects.spheres[11] = 0x1p60f;
  check(Updated::kRefitted);
  objects.spheres[11] = 1;
  for (float& x : objects.bare) x *= 0x1p70f;
  check(Updated::kRefitted);
}

TEST_CASE("a failed update leaves the geometry as it was") {
  Random random(9);
  RandomObjects<float> objects(random, 30);
  auto geometry = Geometry::Build(objects.Input()).value();
  const auto before = Geometry::Build(objects.Input()).value();
  MoveObjects(random, 1, objects);
  objects.vertices[4] = std::numeric_limits<float>::infinity();
  const Result<Updated> failed = geometry.Update(objects.Input());
  REQUIRE(!failed.ok());
  CHECK(failed.error().message == "object 1, triangle 0: a coordinate is not finite");
  CheckSame(geometry, before, random);
  const UpdateOptions skip{.not_finite = NotFinite::kSkipped};
  CHECK(geometry.Update(objects.Input(), skip).value() == Updated::kRebuilt);
  CHECK(geometry.statistics().skipped == 1);
}

}  // namespace
}  // namespace sheaf
