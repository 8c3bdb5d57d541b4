// `Geometry::Update` of all kinds of primitives, and of meshes of floats, which take a shorter way.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "random_rays.h"
#include "same_geometry.h"
#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "targets.h"

namespace sheaf {
namespace {

// A wavy grid with normals, spheres and disks, in order of `spheres_first` or not.
struct Shapes {
  std::vector<double> vertices, normals, spheres, disks;
  std::vector<std::uint32_t> indices;

  explicit Shapes(std::uint32_t side) {
    for (std::uint32_t y = 0; y <= side; ++y) {
      for (std::uint32_t x = 0; x <= side; ++x) {
        vertices.insert(vertices.end(), {x * 0.5, std::sin(x * 0.7) * std::cos(y * 0.4), y * 0.5});
        normals.insert(normals.end(), {0.1, 1, 0.2});
      }
    }
    for (std::uint32_t y = 0; y < side; ++y) {
      for (std::uint32_t x = 0; x < side; ++x) {
        const std::uint32_t a = y * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
        indices.insert(indices.end(), {a, b, c, c, b, d});
      }
    }
    for (int i = 0; i < 20; ++i) {
      spheres.insert(spheres.end(), {i * 0.4, 1.5, i * 0.3, 0.3});
      disks.insert(disks.end(), {i * 0.3, -1.5, i * 0.4, 0.5, 0.3, 1, 0.1});
    }
  }

  void Move(Random& random, double by) {
    for (double& x : vertices) x += Uniform(random, -by, by);
    for (double& x : normals) x += Uniform(random, -0.1, 0.1);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      if (i % 4 < 3) spheres[i] += Uniform(random, -by, by);
    }
    for (std::size_t i = 0; i < disks.size(); ++i) {
      if (i % 7 < 3) disks[i] += Uniform(random, -by, by);
    }
  }
  void Scale(double factor) {
    for (double& x : vertices) x *= factor;
    for (double& x : spheres) x *= factor;
    for (std::size_t i = 0; i < disks.size(); ++i) disks[i] *= i % 7 < 4 ? factor : 1;
  }

  GeometryInput Input() const {
    GeometryInput input;
    input.AddSpheres(spheres);
    input.AddTriangles(vertices, indices, normals);
    input.AddDisks(disks);
    return input;
  }
};

template <typename Real>
struct Answers {
  HitLists<Real> hits;
  std::vector<std::uint32_t> occluded;
  bool operator==(const Answers& other) const {
    return SameHits(hits, other.hits) && occluded == other.occluded;
  }
};

// Of rays through the box around everything, wherever that is.
template <typename Real>
Answers<Real> AnswersOf(const GeometryOf<Real>& geometry, const Target& target) {
  constexpr std::size_t kRays = 600;
  Random random(3);
  RayLists<Real> rays;
  const std::array<float, 3> low = geometry.lower(), high = geometry.upper();
  const bool has_size = low[0] <= high[0];
  for (std::size_t i = 0; i < kRays; ++i) {
    double from[3], along[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double a = has_size ? static_cast<double>(low[axis]) : -1;
      const double b = has_size ? static_cast<double>(high[axis]) : 1;
      from[axis] = Uniform(random, 2 * a - b, 2 * b - a);
      along[axis] = Uniform(random, a, b) - from[axis];
    }
    scalar::Ray<Real> ray;
    ray.origin = Vec3<double>{from[0], from[1], from[2]}.To<Real>();
    ray.direction = Vec3<double>{along[0], along[1], along[2]}.To<Real>();
    ray.source = kNoPrimitive;
    rays.Add(ray);
  }
  Answers<Real> answers{HitLists<Real>(kRays), std::vector<std::uint32_t>(kRays)};
  const TraceOptionsOf<Real> options{.target = target};
  REQUIRE(TraceClosest(geometry, rays.view(), kRays, answers.hits.view(), options));
  REQUIRE(TraceOccluded(geometry, rays.view(), kRays, answers.occluded.data(), options));
  return answers;
}

template <typename Real>
void CheckLikeBuilt(const GeometryOf<Real>& updated, const GeometryInput& input) {
  const auto built = GeometryOf<Real>::Build(input);
  REQUIRE(built);
  CHECK(updated.lower() == built.value().lower());
  CHECK(updated.upper() == built.value().upper());
  CHECK(updated.statistics().never_hit == built.value().statistics().never_hit);
  CHECK(updated.statistics().primitives == built.value().statistics().primitives);
  const Answers<Real> scalar = AnswersOf(built.value(), Target::Scalar());
  CHECK(AnswersOf(updated, Target::Scalar()) == scalar);
  ForEachTarget([&](Target target) { CHECK(AnswersOf(updated, target) == scalar); });
}

TEST_CASE_TEMPLATE("updates have the hits of a build", Real, float, double) {
  Random random(11);
  Shapes shapes(24);
  auto built = GeometryOf<Real>::Build(shapes.Input());
  REQUIRE(built);
  GeometryOf<Real>& geometry = built.value();
  int refits = 0, rebuilds = 0;
  for (int step = 0; step < 12; ++step) {
    // Near, then anywhere, then in other units.
    shapes.Move(random, step % 4 == 3 ? 9 : 0.05);
    if (step % 5 == 4) shapes.Scale(step == 4 ? 1e24 : 1e-24);
    UpdateOptions options;
    options.threads = 1 + step % 2;
    const auto updated = geometry.Update(shapes.Input(), options);
    REQUIRE(updated);
    (updated.value() == Updated::kRefitted ? refits : rebuilds) += 1;
    CheckLikeBuilt(geometry, shapes.Input());
  }
  CHECK(refits >= 3);
  CHECK(rebuilds >= 1);
}

TEST_CASE("what is not moved leaves a built tree as it is, on any number of threads") {
  const Shapes shapes(60);
  auto built = Geometry::Build(shapes.Input());
  REQUIRE(built);
  Geometry& geometry = built.value();
  const TreeView<float>& tree = GeometryAccess::TreeOf(geometry);
  const std::vector<TreeNode> before(tree.nodes, tree.nodes + tree.node_count);
  REQUIRE(before.size() > 200);
  for (const int threads : {1, 2}) {
    UpdateOptions options;
    options.threads = threads;
    options.rebuild_ratio = 1;  // not even a rounding
    CHECK(geometry.Update(shapes.Input(), options).value() == Updated::kRefitted);
    const TreeView<float>& after = GeometryAccess::TreeOf(geometry);
    REQUIRE(after.node_count == before.size());
    CHECK(std::memcmp(after.nodes, before.data(), before.size() * sizeof(TreeNode)) == 0);
  }
}

TEST_CASE("meshes of floats, which take a shorter way") {
  Random random(14);
  Shapes shapes(30);
  const auto input_of = [](const std::vector<float>& vertices, const Shapes& shape) {
    GeometryInput input;
    input.AddTriangles(vertices, std::span(shape.indices).first(999));
    input.AddTriangles(vertices, std::span(shape.indices).subspan(999));
    return input;
  };
  const auto floats = [&] {
    return std::vector<float>(shapes.vertices.begin(), shapes.vertices.end());
  };
  std::vector<float> vertices = floats();
  auto built = Geometry::Build(input_of(vertices, shapes));
  REQUIRE(built);
  Geometry& geometry = built.value();
  const auto update = [&](Updated wanted) {
    const auto updated = geometry.Update(input_of(vertices, shapes));
    REQUIRE(updated);
    CHECK(updated.value() == wanted);
    CheckLikeBuilt(geometry, input_of(vertices, shapes));
  };
  for (int step = 0; step < 4; ++step) {
    shapes.Move(random, 0.02);
    vertices = floats();
    update(Updated::kRefitted);
  }
  // A sliver has an area all the same.
  for (int axis = 0; axis < 3; ++axis) {
    vertices[3 + axis] = (vertices[axis] + vertices[93 + axis]) / 2;
  }
  update(Updated::kRefitted);
  vertices = floats();
  // Nothing left of one triangle; another scale; a giant.
  std::copy_n(vertices.begin(), 3, vertices.begin() + 3);
  update(Updated::kRebuilt);
  update(Updated::kRefitted);
  vertices = floats();
  update(Updated::kRebuilt);
  for (float& x : vertices) x *= 1e-20f;
  update(Updated::kRefitted);
  vertices = floats();
  vertices[0] = 1e13f;
  REQUIRE(geometry.Update(input_of(vertices, shapes)));
  CheckLikeBuilt(geometry, input_of(vertices, shapes));
  vertices = floats();
  REQUIRE(geometry.Update(input_of(vertices, shapes)));
  CheckLikeBuilt(geometry, input_of(vertices, shapes));
  const Answers<float> before = AnswersOf(geometry, Target::Scalar());
  GeometryInput bare;
  bare.AddTriangles(std::span(vertices).first(0), std::span(shapes.indices).first(999));
  bare.AddTriangles(vertices, std::span(shapes.indices).subspan(999));
  CHECK(!geometry.Update(bare));
  vertices[7] = std::numeric_limits<float>::infinity();
  CHECK(!geometry.Update(input_of(vertices, shapes)));
  vertices = floats();
  shapes.indices[5] = 1000000;
  CHECK(!geometry.Update(input_of(vertices, shapes)));
  CHECK(AnswersOf(geometry, Target::Scalar()) == before);
}

TEST_CASE("the tree is kept as long as it is good enough") {
  Random random(12);
  Shapes shapes(40);
  auto built = Geometry::Build(shapes.Input());
  REQUIRE(built);
  Shapes scattered = shapes;
  scattered.Move(random, 8);
  UpdateOptions never;
  never.rebuild_ratio = std::numeric_limits<double>::infinity();
  CHECK(built.value().Update(scattered.Input(), never).value() == Updated::kRefitted);
  CheckLikeBuilt(built.value(), scattered.Input());
  // Still beside the tree that was built.
  CHECK(built.value().Update(scattered.Input()).value() == Updated::kRebuilt);
  CHECK(built.value().Update(scattered.Input()).value() == Updated::kRefitted);
  CheckLikeBuilt(built.value(), scattered.Input());
}

TEST_CASE("other primitives than before") {
  const Shapes shapes(10);
  const auto update = [&](Geometry& geometry, const GeometryInput& input) {
    const auto updated = geometry.Update(input);
    REQUIRE(updated);
    CheckLikeBuilt(geometry, input);
    return updated.value();
  };
  Geometry geometry;
  CHECK(update(geometry, shapes.Input()) == Updated::kRebuilt);
  // One of no area is left out; then it comes back.
  Shapes flat = shapes;
  for (int k = 0; k < 3; ++k) flat.vertices[k] = flat.vertices[3 + k];
  CHECK(update(geometry, flat.Input()) == Updated::kRebuilt);
  CHECK(update(geometry, flat.Input()) == Updated::kRefitted);
  // As many of no area, but others.
  Shapes other = shapes;
  for (int k = 0; k < 3; ++k) other.vertices[33 + k] = other.vertices[36 + k];
  const auto never_hit = [&](const Shapes& of) {
    return Geometry::Build(of.Input()).value().statistics().never_hit;
  };
  REQUIRE(never_hit(other) >= 1);
  update(geometry, other.Input());
  CHECK(update(geometry, shapes.Input()) == Updated::kRebuilt);
  // An object more, and none.
  GeometryInput more = shapes.Input();
  more.AddSpheres(shapes.spheres);
  CHECK(update(geometry, more) == Updated::kRebuilt);
  CHECK(update(geometry, GeometryInput()) == Updated::kRebuilt);
  CHECK(update(geometry, GeometryInput()) == Updated::kRefitted);
  // Spheres and disks change places: as many objects and primitives of each kind.
  GeometryInput a, b;
  a.AddSpheres(shapes.spheres);
  a.AddDisks(shapes.disks);
  b.AddDisks(shapes.disks);
  b.AddSpheres(shapes.spheres);
  CHECK(update(geometry, a) == Updated::kRebuilt);
  CHECK(update(geometry, b) == Updated::kRebuilt);
  CHECK(update(geometry, b) == Updated::kRefitted);
}

TEST_CASE("giants, and what becomes one") {
  Random random(13);
  Shapes shapes(10);
  Shapes wide = shapes;
  wide.spheres[3] = 1e13;
  auto built = Geometry::Build(shapes.Input());
  REQUIRE(built);
  for (const Shapes* each : {&wide, &wide, &shapes, &wide, &shapes}) {
    REQUIRE(built.value().Update(each->Input()));
    CheckLikeBuilt(built.value(), each->Input());
  }
}

TEST_CASE("what is refused leaves the geometry as it was") {
  const Shapes shapes(10);
  auto built = Geometry::Build(shapes.Input());
  REQUIRE(built);
  const Answers<float> before = AnswersOf(built.value(), Target::Scalar());
  Shapes broken = shapes;
  broken.vertices[31] = std::numeric_limits<double>::quiet_NaN();
  const auto refused = built.value().Update(broken.Input());
  REQUIRE(!refused);
  CHECK(refused.error().kind == ErrorKind::kUsage);
  CHECK(refused.error().message.find("object 1, triangle") != std::string::npos);
  CHECK(AnswersOf(built.value(), Target::Scalar()) == before);
  const UpdateOptions options = {.not_finite = NotFinite::kSkipped};
  REQUIRE(built.value().Update(broken.Input(), options));
  CHECK(built.value().statistics().skipped >= 1);
}

}  // namespace
}  // namespace sheaf
