// Disks: the specification against 113 bits, and the kernels against the specification.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "expected_traces.h"
#include "one_disk.h"
#include "sheaf/geometry.h"
#include "src/bvh/primitive_rules.h"
#include "src/bvh/validate_tree.h"
#include "src/scalar/primitives.h"
#include "src/scene/bounds.h"
#include "src/scene/shapes.h"

namespace sheaf {
namespace {

using scalar::Ray;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST_CASE("t is within an ULP of the exact one and hits are judged right, grazing rays too") {
  Random random(1);
  int hits = 0;
  double worst = 0;
  for (int round = 0; round < 700; ++round) {
    OneDisk disk = AnyDisk(random);
    if (round % 5 == 0) disk.normal = {0, 0, round % 2 ? 1.0f : -1.0f};
    for (const Ray<float>& ray : RaysAt(random, disk, std::pow(10.0, round % 7))) {
      const ExactDiskHit exact(ray, disk);
      if (exact.is_parallel) continue;
      const auto hit = scalar::HitDisk(ray, disk.arrays(), 0);
      if (exact.is_in_doubt) continue;
      REQUIRE(hit.has_value() == exact.is_hit);
      if (!hit) continue;
      ++hits;
      worst = std::max(worst, UlpsOff(hit->t, exact.t));

      const auto surface =
          scalar::DiskSurface(ray, scalar::Hit<float>{hit->t, 0, hit->u, hit->v}, disk.arrays(), 0);
      const Vec3<Exact> normal = exact.normal;
      const bool is_back = Dot(normal, ray.direction.To<Exact>()) > 0;
      REQUIRE(Abs(Dot(surface.position.To<Exact>() - disk.center.To<Exact>(), normal)) <=
              Exact(surface.offset));
      const Vec3<Exact> off = surface.face.To<Exact>() - (is_back ? -normal : normal);
      REQUIRE(Sqrt(Dot(off, off)) <= Exact(1e-7));
      REQUIRE(surface.inside() == is_back);
      REQUIRE((surface.u > -1e-6f && surface.u < 1 + 1e-6f));
    }
  }
  CHECK(worst <= 1);
  CHECK(hits > 50'000);
  MESSAGE("largest error of t: ", worst, " ULP of ", hits, " hits");
}

TEST_CASE("boxes hold the whole disk and little more") {
  Random random(2);
  for (int round = 0; round < 2000; ++round) {
    const Vec3<float> c = Rounded(ToVec3(UniformPoint(random, -10, 10)));
    Vec3<float> n = Rounded(RandomUnit(random));
    if (round % 4 == 0) n = {0, round % 8 ? 1.0f : -1.0f, 0};
    const float fields[7] = {c.x, c.y, c.z, 0.75f, n.x, n.y, n.z};
    const scalar::Frame<double> frame(Normalize(n.To<double>()));
    for (int axis = 0; axis < 3; ++axis) {
      float lower = 0, upper = 0;
      bvh::Rules<PrimitiveKind::kDisk>::ExactBounds(fields, axis, lower, upper);
      const double reach = 0.75 * std::hypot(frame.x[axis], frame.y[axis]);
      const double center = static_cast<double>(c[axis]);
      REQUIRE(static_cast<double>(lower) <= center - reach + 1e-15);
      REQUIRE(static_cast<double>(upper) >= center + reach - 1e-15);
      REQUIRE(static_cast<double>(upper - lower) <= 2 * reach + 1e-5);
    }
  }
}

TEST_CASE("special rays and disks") {
  OneDisk disk;
  const auto hits = [&](const Ray<float>& ray) {
    const bool is_hit = scalar::TraceClosest(disk.geometry(), ray).primitive != kNoPrimitive;
    CHECK(scalar::TraceOccluded(disk.geometry(), ray) == is_hit);
    return is_hit;
  };
  const Ray<float> down{{0.25f, 0.5f, 2}, {0, 0, -1}};
  const scalar::Hit<float> hit = scalar::TraceClosest(disk.geometry(), down);
  CHECK(hit.t == 2);
  CHECK(hit.u == 0.625f);  // x to the right, y up
  CHECK(hit.v == 0.25f);
  CHECK(hits({{0.25f, 0.5f, -2}, {0, 0, 1}}));  // the back
  CHECK(hits({{1, 0, 2}, {0, 0, -1}}));         // the rim itself
  CHECK_FALSE(hits({{1.0000001f, 0, 2}, {0, 0, -1}}));
  CHECK_FALSE(hits({{-2, 0, 0}, {1, 0, 0}}));   // in the plane
  CHECK_FALSE(hits({{-2, 0, 1}, {1, 0, 0}}));   // beside it
  CHECK_FALSE(hits({{0, 0, -2}, {0, 0, -1}}));  // behind
  for (const std::uint32_t source : {disk.id, disk.id | kInsideBit}) {
    Ray<float> own = down;
    own.source = source;
    CHECK_FALSE(hits(own));
  }
  disk.normal = {0, 0, -3};  // turned round, and longer: v runs the other way
  CHECK(scalar::TraceClosest(disk.geometry(), down).t == 2);
  CHECK(scalar::TraceClosest(disk.geometry(), down).v == 0.75f);
  disk.radius = kNan;
  CHECK_FALSE(hits(down));
}

TEST_CASE("what is no disk is refused, what has no size never hit") {
  GeometryInput input;
  const std::vector<float> disks = {0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
  input.AddDisks(disks);
  const Result<Geometry> built = Geometry::Build(input);
  REQUIRE(built.ok());
  CHECK(built.value().statistics().primitives == 1);
  CHECK(built.value().statistics().never_hit == 1);
  const std::pair<std::vector<float>, const char*> wrong[] = {
      {{0, kNan, 0, 1, 0, 0, 1}, "coordinate"}, {{0, 0, 0, kInfinity, 0, 0, 1}, "radius"},
      {{0, 0, 0, -1, 0, 0, 1}, "negative"},     {{0, 0, 0, 1, 0, 0, kInfinity}, "normal"},
      {{0, 0, 0, 1, 0, 0, 0}, "normal is 0"},   {{0, 0, 0, 1, 0, 0}, "divide by 7"}};
  for (const auto& [fields, what] : wrong) {
    GeometryInput bad;
    bad.AddDisks(fields);
    const Result<Geometry> refused = Geometry::Build(bad);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().message.find(what) != std::string::npos);
  }
}

// Disks among other primitives; some lie along the axes, some have no size, a few are there twice.
Scene DiskScene(Random& random, int count, double size) {
  Scene scene;
  scene.materials.push_back({});
  for (int i = 0; i < count; ++i) {
    const Vec3d at = UniformPoint(random, -4, 4);
    Object object;
    if (i % 4 == 3) {
      object.shape = Triangle{
          {at, at + UniformPoint(random, -size, size), at + UniformPoint(random, -size, size)}};
    } else if (i % 8 == 2) {
      object.shape = Sphere{at, Uniform(random, 0.1, 0.5) * size};
    } else {
      Vec3d normal = UniformPoint(random, -1, 1);
      if (i % 3 == 0) normal = Vec3d(0, 0, i % 2 ? 1 : -2);
      object.shape = Disk{at, i % 16 == 1 ? 0.0 : Uniform(random, 0.1, 1) * size, normal};
    }
    scene.objects.push_back(object);
    if (i % 16 == 0) scene.objects.push_back(object);
  }
  return scene;
}

TEST_CASE_TEMPLATE("trees with disks are sound", Real, float, double) {
  Random random(3);
  for (const int count : {1, 5, 30, 1000}) {
    const CompiledScene<Real> scene = CompileScene<Real>(DiskScene(random, count, 1));
    const Result<Tree<Real>> tree = BuildTree(scene.geometry());
    REQUIRE(tree.ok());
    CHECK(FindTreeDefect(tree.value().view(), scene.geometry()) == "");
  }
}

TEST_CASE_TEMPLATE("disks trace as the scalar specification", Real, float, double) {
  Random random(4);
  std::uint32_t hits = 0;
  const auto check = [&](const Scene& scene, std::vector<Ray<Real>> rays) {
    const Expected<Real> want(scene, std::move(rays));
    hits += want.hit_count();
    CheckEverywhere(want);
  };
  for (const int count : {1, 3, 10, 1500}) {  // from every leaf at once to a deep tree
    const double size = count < 100 ? 2 : 0.4;
    std::vector<Ray<Real>> rays;
    for (int i = 0; i < 1500; ++i) {
      rays.push_back(RandomRay<Real>(random, static_cast<std::uint32_t>(count)));
    }
    check(DiskScene(random, count, size), rays);
    // One origin, then one direction, then one along the planes of many disks.
    const Vec3d origin = UniformPoint(random, -6, 6);
    check(DiskScene(random, count, size), GridRays<Real>(random, origin, -origin, 0.5));
    check(DiskScene(random, count, size), GridRays<Real>(random, {5, 0.1, 0}, {-1, 0, 0}, 0.5));
    rays = GridRays<Real>(random, Vec3d(0), Vec3d(0, 0, 1), 0.5);
    for (Ray<Real>& ray : rays) {
      if (!scalar::IsFinite(ray.direction)) ray.direction = {};
      ray.origin = ray.direction;
      ray.origin.z = -5;
      ray.direction = {Real(0.1), Real(-0.2), Real(1)};
    }
    check(DiskScene(random, count, size), rays);
  }
  CHECK(hits > 3000);
}

TEST_CASE_TEMPLATE("surfaces of disks are those of the specification", Real, float, double) {
  Random random(5);
  const CompiledScene<Real> scene = CompileScene<Real>(DiskScene(random, 200, 2));
  const GeometryView<Real> geometry = scene.geometry();
  for (const std::uint32_t count : {1u, 7u, 33u}) {
    RayStream<Real> rays;
    HitStream<Real> hits;
    rays.Allocate(count), hits.Allocate(count);
    AlignedArray<std::uint32_t> ray, index, primitive;
    for (auto* list : {&ray, &index, &primitive}) list->Allocate(StreamCapacity(count));
    std::vector<scalar::Surface<Real>> want;
    while (want.size() < count) {
      const Ray<Real> from{As<Real>(UniformPoint(random, -6, 6)), RandomUnit(random).To<Real>()};
      const scalar::Hit<Real> hit = scalar::TraceClosest(geometry, from);
      if (hit.primitive == kNoPrimitive) continue;
      const PrimitiveInfo& info = scene.objects.primitives[hit.primitive];
      if (info.kind() != PrimitiveKind::kDisk) continue;
      const auto i = static_cast<std::uint32_t>(want.size());
      const auto out = rays.output();
      out.origin_x[i] = from.origin.x, out.origin_y[i] = from.origin.y;
      out.origin_z[i] = from.origin.z, out.direction_x[i] = from.direction.x;
      out.direction_y[i] = from.direction.y, out.direction_z[i] = from.direction.z;
      hits.output().t[i] = hit.t, hits.output().u[i] = hit.u, hits.output().v[i] = hit.v;
      ray[i] = i, index[i] = info.index(), primitive[i] = hit.primitive;
      want.push_back(scalar::SurfaceAt(from, hit, geometry, info.place));
    }
    ForEachTarget([&](Target target) {
      SurfaceStream<Real> surfaces;
      surfaces.Allocate(count);
      StrictKernels<Real>(target.id())
          .surfaces_of(PrimitiveKind::kDisk)(geometry, rays.view(), hits.view(),
                                             {ray.data(), index.data(), primitive.data(), count},
                                             kNeedsAll, surfaces.output());
      const auto got = surfaces.view();
      for (std::uint32_t i = 0; i < count; ++i) {
        const scalar::Surface<Real>& w = want[i];
        CHECK((SameBits(got.position_x[i], w.position.x) &&
               SameBits(got.position_y[i], w.position.y) &&
               SameBits(got.position_z[i], w.position.z)));
        CHECK((SameBits(got.normal_x[i], w.normal.x) && SameBits(got.normal_y[i], w.normal.y) &&
               SameBits(got.normal_z[i], w.normal.z)));
        CHECK((SameBits(got.u[i], w.u) && SameBits(got.v[i], w.v)));
        CHECK(SameBits(got.offset[i], w.offset));
        CHECK(got.source[i] == w.source);
        CHECK(got.ray[i] == i);
      }
    });
  }
}

TEST_CASE("disks are moved, bounded and described") {
  Disk disk{{1, 2, 3}, 2, {0, 0, 4}};
  Shape shape = disk;
  Transform stretch;
  stretch.linear[0][0] = 2;
  CHECK(TransformShape(stretch, &shape) != "");
  Transform half;
  half.linear = glm::dmat3(0.5);
  half.translation = {1, 0, 0};
  CHECK(TransformShape(RotationAbout({1, 0, 0}, 90) * half, &shape) == "");
  const Disk& moved = std::get<Disk>(shape);
  CHECK(moved.radius == 1);
  CHECK(std::abs(moved.normal.z) < 1e-12);
  CHECK(moved.normal.y == doctest::Approx(-2));
  Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back({"", disk, 0});
  const auto bounds = BoundsOf(scene);
  REQUIRE(bounds);
  CHECK(bounds->min == Vec3d(-1, 0, 3));
  CHECK(bounds->max == Vec3d(3, 4, 3));
  CHECK(CountPrimitives(scene)[PrimitiveKind::kDisk] == 1);
}

}  // namespace
}  // namespace sheaf
