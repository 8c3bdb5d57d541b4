// Shading, Fresnel's split, and the starts of secondary and shadow rays, against closed forms and
// wider arithmetic.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "exact.h"
#include "random_scene.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/scalar/render_pixel.h"

namespace sheaf {
namespace {

using scalar::Ray;
using scalar::Surface;

Vec3d ToGlm(Vec3<double> v) { return {v.x, v.y, v.z}; }
double Length(Vec3<double> a) { return std::sqrt(Dot(a, a)); }
// A unit vector on the side of `normal`.
Vec3<double> RandomAbout(Random& random, Vec3<double> normal) {
  const Vec3<double> v = RandomUnit(random);
  return Dot(v, normal) < 0 ? -v : v;
}
bool IsBlack(Vec3<float> c) { return c.x == 0 && c.y == 0 && c.z == 0; }

// A level surface at `position` seen from straight above.
Surface<float> Floor(Vec3<float> position = {0, 0, 0}) {
  Surface<float> surface;
  surface.position = position;
  surface.normal = surface.face = {0, 1, 0};
  surface.direction = {0, -1, 0};
  surface.offset = 1e-6f;
  surface.source = 0;
  return surface;
}

MaterialData<float> White(float kd, float ks, float shininess) {
  MaterialData<float> material{};
  for (float& c : material.even) c = 1;
  material.kd = kd, material.ks = ks, material.shininess = shininess, material.ior = 1;
  return material;
}

LightData<float> PointLightAt(Vec3<float> at, float kc, float kl, float kq) {
  return {LightKind::kPointFromLight, {at.x, at.y, at.z}, {2, 3, 5}, {kc, kl, kq}, 1};
}

Vec3<float> Lit(const LightData<float>& light, const MaterialData<float>& material,
                const Surface<float>& surface) {
  return scalar::LitBy(light, material, surface, scalar::BaseColourAt(material, {}, surface),
                       scalar::IncidenceOf(light, surface));
}

// ---- What the surface sends

TEST_CASE("a checker is odd where the sum of its cells is") {
  MaterialData<float> checker{};
  checker.kind = BaseColour::kChecker;
  checker.odd[0] = 1;
  const auto is_odd = [&](float u, float v, float across, float along) {
    checker.cells[0] = across, checker.cells[1] = along;
    Surface<float> surface = Floor();
    surface.u = u, surface.v = v;
    return scalar::BaseColourAt(checker, {}, surface).x == 1;
  };
  CHECK_FALSE(is_odd(0.1f, 0.1f, 8, 8));
  CHECK(is_odd(0.2f, 0.1f, 8, 8));
  CHECK(is_odd(0.1f, 0.2f, 8, 8));
  CHECK_FALSE(is_odd(0.2f, 0.2f, 8, 8));
  // A border belongs to the cell above it.
  CHECK(is_odd(0.125f, 0, 8, 8));
  CHECK_FALSE(is_odd(std::nextafter(0.125f, 0.0f), 0, 8, 8));
  CHECK_FALSE(is_odd(1, 1, 8, 8));
  CHECK(is_odd(1, 1, 8, 5));
  // Below zero the pattern goes on, without a doubled cell around 0.
  CHECK(is_odd(-0.1f, 0.1f, 1, 1));
  CHECK(is_odd(-1, 0, 1, 1));
  CHECK_FALSE(is_odd(-1.1f, 0, 1, 1));
  CHECK_FALSE(is_odd(-0.1f, -0.1f, 1, 1));
  CHECK(is_odd(-0x1p-149f, 0, 1, 1));
  CHECK_FALSE(is_odd(-0.0f, 0, 1, 1));
  // Uneven cells and any coordinates, against whole numbers.
  Random random(50);
  for (int i = 0; i < 100000; ++i) {
    const auto u = static_cast<float>(Uniform(random, -3, 3));
    const auto v = static_cast<float>(Uniform(random, -3, 3));
    const auto across = static_cast<float>(Uniform(random, 0.3, 1e4));
    const auto along = static_cast<float>(random() % 1000 + 1);
    const auto cell = static_cast<long long>(std::floor(u * across)) +
                      static_cast<long long>(std::floor(v * along));
    REQUIRE(is_odd(u, v, across, along) == (cell % 2 != 0));
  }
}

TEST_CASE("falloffs follow one over kc + kl r + kq r^2") {
  Random random(51);
  const MaterialData<float> matte = White(0.5f, 0, 1);
  const double falloffs[][3] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0.5, 0.25, 2}};
  for (const auto& [kc, kl, kq] : falloffs) {
    for (int i = 0; i < 2000; ++i) {
      const Surface<float> surface = Floor(ToVec3(UniformPoint(random, -3, 3)).To<float>());
      const Vec3<double> towards = RandomAbout(random, {0, 1, 0}) * Uniform(random, 0.1, 100);
      const Vec3<float> at = surface.position + towards.To<float>();
      const LightData<float> light =
          PointLightAt(at, static_cast<float>(kc), static_cast<float>(kl), static_cast<float>(kq));
      const Vec3<double> way = (at - surface.position).To<double>();
      const double r = Length(way);
      const double want = 0.5 * (way.y / r) / (kc + kl * r + kq * r * r);
      const Vec3<float> got = Lit(light, matte, surface);
      REQUIRE(got.x == doctest::Approx(2 * want).epsilon(2e-6));
      REQUIRE(got.y == doctest::Approx(3 * want).epsilon(2e-6));
      REQUIRE(got.z == doctest::Approx(5 * want).epsilon(2e-6));
    }
  }
}

TEST_CASE("the highlight is (n.h)^shininess in the light's colour") {
  Random random(52);
  for (int i = 0; i < 20000; ++i) {
    const Vec3<double> n = RandomUnit(random), l = RandomAbout(random, n);
    const Vec3<double> eye = RandomAbout(random, n);
    const double powers[] = {0, 1, 11.1434, 25, 200, 1e4};
    const double shininess = powers[i % 6];
    Surface<float> surface = Floor();
    surface.normal = surface.face = n.To<float>(), surface.direction = -eye.To<float>();
    MaterialData<float> material = White(0.25f, 0.75f, static_cast<float>(shininess));
    material.even[1] = 0.5f, material.even[2] = 0;
    LightData<float> light = PointLightAt({0, 0, 0}, 1, 0, 0);
    light.kind = LightKind::kDirectional;
    const Vec3<float> towards = l.To<float>();
    for (int axis = 0; axis < 3; ++axis) light.vector[axis] = towards[axis];
    const double n_dot_h = Dot(n, Normalize(l + eye));
    const double highlight = 0.75 * std::pow(std::min(n_dot_h, 1.0), shininess);
    const double diffuse = 0.25 * Dot(n, l);
    const Vec3<float> got = Lit(light, material, surface);
    // The power multiplies the roundoffs of n.h.
    const double tolerance = 1e-6 * (1 + highlight * shininess);
    REQUIRE(std::abs(got.x - 2 * (diffuse + highlight)) < 2 * tolerance);
    REQUIRE(std::abs(got.y - 3 * (diffuse / 2 + highlight)) < 3 * tolerance);
    REQUIRE(std::abs(got.z - 5 * highlight) < 5 * tolerance);
  }
  // The mirror direction shows the whole highlight, whatever its power.
  for (const float shininess : {0.0f, 1.0f, 200.0f, 1e6f}) {
    const auto got = Lit(PointLightAt({0, 2, 0}, 1, 0, 0), White(0, 1, shininess), Floor());
    CHECK(got.x == 2);
  }
}

TEST_CASE("a directional light is as bright everywhere") {
  LightData<float> light = PointLightAt({0.6f, 0.8f, 0}, 1, 0, 0);
  light.kind = LightKind::kDirectional;
  for (const float far : {0.0f, 1.0f, -1e4f, 1e8f}) {
    const auto incidence = scalar::IncidenceOf(light, Floor({far, far, far}));
    CHECK(incidence.attenuation == 1);
    CHECK(incidence.n_dot_l == 0.8f);
    CHECK(Lit(light, White(1, 0, 1), Floor({far, far, far})).x == 2 * 0.8f);
  }
}

TEST_CASE("ambient light is ka times the base colour, with no light at all") {
  MaterialData<float> material = White(1, 1, 10);
  material.even[1] = 0.5f, material.even[2] = 0.25f;
  material.ambient[0] = 0.1f, material.ambient[1] = 0.2f, material.ambient[2] = 0.5f;
  const auto colour = scalar::AmbientLight(material, scalar::BaseColourAt(material, {}, Floor()));
  CHECK(colour.x == 0.1f);
  CHECK(colour.y == 0.1f);
  CHECK(colour.z == 0.125f);
  RayCounts tally;
  const auto local = scalar::LocalLight(FrameView<float>{}, material, Floor(), tally);
  CHECK(local.x == 0.1f);
  CHECK(local.z == 0.125f);
}

// LocalLight of `material` on the floor under one light, in a scene of nothing or of one sphere.
Vec3<float> UnderOneLight(const LightData<float>& light, const MaterialData<float>& material,
                          const std::vector<Sphere>& spheres = {}) {
  Scene scene;
  scene.materials.push_back({});
  for (const Sphere& sphere : spheres) scene.objects.push_back({"", sphere, 0});
  const CompiledScene<float> compiled = CompileScene<float>(scene);
  const Result<Tree<float>> tree = BuildTree<float>(compiled.geometry());
  FrameView<float> frame{};
  frame.tree = tree.value().view();
  frame.geometry = compiled.geometry();
  frame.lights = {&light, 1};
  Surface<float> surface = Floor();
  surface.source = 99;
  RayCounts tally;
  return scalar::LocalLight(frame, material, surface, tally);
}

TEST_CASE("a light at, below or behind the surface gives nothing and no NaN") {
  const MaterialData<float> material = White(1, 1, 10);
  CHECK(UnderOneLight(PointLightAt({0, 1, 0}, 0, 0, 1), material).x > 2);
  CHECK(IsBlack(UnderOneLight(PointLightAt({0, 0, 0}, 0, 0, 1), material)));   // at the point
  CHECK(IsBlack(UnderOneLight(PointLightAt({1, 0, 0}, 0, 0, 1), material)));   // in the plane
  CHECK(IsBlack(UnderOneLight(PointLightAt({1, -1, 0}, 0, 0, 1), material)));  // below
  for (float height = 1; height > 1e-18f; height /= 8) {
    const auto colour = UnderOneLight(PointLightAt({0, height, 0}, 0, 0, 1), material);
    CHECK(std::isfinite(colour.x));
    CHECK(colour.x > 0);
  }
  // Where the squared distance is no normal number, the light is at the point, or out of reach.
  for (const float far : {1e-25f, 1e-22f, 0.5e-19f, 1.9e19f, 1e30f}) {
    CAPTURE(far);
    CHECK(IsBlack(UnderOneLight(PointLightAt({0, far, 0}, 1, 0, 0), material)));
    CHECK(IsBlack(UnderOneLight(PointLightAt({far, far, far}, 1, 0, 0), material)));
  }
  for (const float far : {1.1e-19f, 1.8e19f}) {
    const auto colour = UnderOneLight(PointLightAt({0, far, 0}, 1, 0, 0), White(1, 0, 1));
    CHECK(colour.x == Lit(PointLightAt({0, 1, 0}, 1, 0, 0), White(1, 0, 1), Floor()).x);
  }
  // Opposite the eye the half vector has no length: then there is no highlight, and no NaN.
  Surface<float> grazed = Floor();
  grazed.direction = {1, 0, 0};
  LightData<float> light = PointLightAt({1, 0, 0}, 1, 0, 0);
  light.kind = LightKind::kDirectional;
  CHECK(Lit(light, White(0, 1, 10), grazed).x == 0);
}

TEST_CASE("a body between surface and light casts its shadow, unless the light casts none") {
  const MaterialData<float> material = White(1, 0, 1);
  LightData<float> light = PointLightAt({0, 10, 0}, 0, 0, 1);
  for (const LightKind kind :
       {LightKind::kPointFromLight, LightKind::kPointFromSurface, LightKind::kDirectional}) {
    light.kind = kind;
    light.casts_shadows = 1;
    CHECK(UnderOneLight(light, material).x > 0);
    CHECK(IsBlack(UnderOneLight(light, material, {{{0, 5, 0}, 1.0}})));
    CHECK(UnderOneLight(light, material, {{{3, 5, 0}, 1.0}}).x > 0);
    // Behind a point light is no shadow.
    const bool is_point = kind != LightKind::kDirectional;
    CHECK(IsBlack(UnderOneLight(light, material, {{{0, 15, 0}, 1.0}})) != is_point);
    light.casts_shadows = 0;
    CHECK(UnderOneLight(light, material, {{{0, 5, 0}, 1.0}}).x > 0);
  }
}

// ---- Fresnel and Snell

TEST_CASE("at normal incidence the reflectance is ((n1 - n2) / (n1 + n2))^2") {
  for (double ior = 0.3; ior < 4; ior += 0.01) {
    const double want = (1 - ior) / (1 + ior) * ((1 - ior) / (1 + ior));
    const auto in = scalar::FresnelSplit(static_cast<float>(1 / ior), 1.0f);
    const auto out = scalar::FresnelSplit(static_cast<float>(ior), 1.0f);
    CHECK(std::abs(in.reflectance - want) < 2e-7);
    CHECK(std::abs(out.reflectance - want) < 2e-7);
    CHECK_FALSE(in.is_total);
  }
}

float StepUlps(float x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, 2.0f);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -2.0f);
  return x;
}

float CriticalCosine(float eta) {
  const long double e = eta;
  return static_cast<float>(std::sqrt((1 - 1 / e) * (1 + 1 / e)));
}

// The critical cosine itself, 1 ULP to either side, and all around it.
TEST_CASE("around the critical angle the split decides as the oracle") {
  Random random(53);
  int wrong = 0, total = 0, judged = 0;
  for (int i = 0; i < 100000; ++i) {
    const float eta = i == 0 ? 1.5f : static_cast<float>(Uniform(random, 1.01, 3));
    const int reach = i % 50 == 0 ? 64 : 1;
    for (int ulps = -reach; ulps <= reach; ++ulps) {
      const float cos_i = StepUlps(CriticalCosine(eta), ulps);
      const bool want = scalar::FresnelSplit<long double>(eta, cos_i).is_total;
      wrong += scalar::FresnelSplit(eta, cos_i).is_total != want;
      total += want, ++judged;
    }
  }
  CHECK(wrong == 0);
  CHECK(total > judged / 3);
  CHECK(total < judged * 2 / 3);
}

TEST_CASE("reflectance lies in [0, 1], grows to 1 at grazing and is the oracle's") {
  Random random(54);
  double worst = 0;
  for (int i = 0; i < 300000; ++i) {
    const auto eta = static_cast<float>(std::exp2(Uniform(random, -1.5, 1.5)));
    const auto cos_i = static_cast<float>(i % 3 ? Uniform(random, 0, 1) : Uniform(random, 0, 1e-4));
    const auto split = scalar::FresnelSplit(eta, cos_i);
    REQUIRE(split.reflectance >= 0);
    REQUIRE(split.reflectance <= 1);
    REQUIRE(split.cos_t >= 0);
    const auto want = scalar::FresnelSplit<long double>(eta, cos_i);
    worst = std::max(worst, std::abs(static_cast<double>(split.reflectance - want.reflectance)));
  }
  MESSAGE("largest error of the reflectance: ", worst);
  CHECK(worst < 6e-8);
  CHECK(scalar::FresnelSplit(1.5f, 0.0f).reflectance == 1);
  CHECK(scalar::FresnelSplit(1 / 1.5f, 0.0f).reflectance == 1);
}

MaterialData<float> Glass(float ior) {
  MaterialData<float> glass{};
  for (float& c : glass.transmit) c = 1;
  glass.ior = ior;
  return glass;
}

// A surface met by a ray of direction `d`, entering a body or leaving it.
Surface<float> Interface(Vec3<double> n, Vec3<double> d, bool is_inside) {
  Surface<float> surface = Floor();
  surface.normal = surface.face = n.To<float>(), surface.direction = d.To<float>();
  surface.source = is_inside ? kInsideBit : 0;
  return surface;
}

constexpr float kFull[3] = {1, 1, 1};

TEST_CASE("mirror law, Snell's law, energy and sides, for random directions") {
  Random random(55);
  int totals = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3<double> n = RandomUnit(random), d = -RandomAbout(random, n);
    const bool is_inside = i % 2;
    const auto ior = static_cast<float>(Uniform(random, 0.5, 2.5));
    const auto spawned = scalar::Spawn(Glass(ior), Interface(n, d, is_inside), kFull);
    const Vec3<double> mirrored = spawned.reflected.ray.direction.To<double>();
    REQUIRE(Length(mirrored - (d - n * (2 * Dot(n, d)))) < 1e-6);
    REQUIRE(spawned.reflected.throughput[0] >= 0);
    REQUIRE(spawned.reflected.throughput[0] <= 1);
    REQUIRE(spawned.reflected.throughput[0] + spawned.refracted.throughput[0] ==
            doctest::Approx(1).epsilon(1e-6));
    if (!spawned.refracted.counts()) {
      ++totals;
      REQUIRE(spawned.reflected.throughput[0] == 1);
      continue;
    }
    const Vec3<double> t = spawned.refracted.ray.direction.To<double>();
    REQUIRE(std::abs(Length(t) - 1) < 1e-6);
    // n1 sin i = n2 sin t, in the plane of incidence: the vectors are the same.
    const double n1 = is_inside ? ior : 1.0, n2 = is_inside ? 1.0 : ior;
    REQUIRE(Length(Cross(n, d) * n1 - Cross(n, t) * n2) < 1e-6 * (n1 + n2));
    REQUIRE(Dot(n, t) < 1e-6);
    // The refracted ray changes sides, the reflected one does not.
    REQUIRE(spawned.refracted.ray.source == (is_inside ? 0 : kInsideBit));
    REQUIRE(spawned.reflected.ray.source == (is_inside ? kInsideBit : 0));
  }
  CHECK(totals > 5000);
}

TEST_CASE("a refracted ray turned round comes back, with the same reflectance") {
  Random random(56);
  int reversed = 0;
  for (int i = 0; i < 50000; ++i) {
    const Vec3<double> n = RandomUnit(random), d = -RandomAbout(random, n);
    if (Dot(n, d) > -0.1) continue;  // where cos i is small, its square has lost its bits
    const bool is_inside = i % 2;
    const MaterialData<float> glass = Glass(static_cast<float>(Uniform(random, 0.6, 2.5)));
    const auto there = scalar::Spawn(glass, Interface(n, d, is_inside), kFull);
    if (!there.refracted.counts()) continue;
    const Vec3<double> t = there.refracted.ray.direction.To<double>();
    if (Dot(n, t) > -0.1) continue;
    const auto back = scalar::Spawn(glass, Interface(-n, -t, !is_inside), kFull);
    REQUIRE(back.refracted.counts());
    REQUIRE(Length(back.refracted.ray.direction.To<double>() + d) < 1e-5);
    REQUIRE(std::abs(back.reflected.throughput[0] - there.reflected.throughput[0]) < 1e-4);
    ++reversed;
  }
  CHECK(reversed > 20000);
}

TEST_CASE("ior 1 lets everything through unbent") {
  Random random(57);
  for (int i = 0; i < 20000; ++i) {
    const Vec3<double> n = RandomUnit(random), d = -RandomAbout(random, n);
    const auto spawned = scalar::Spawn(Glass(1), Interface(n, d, i % 2), kFull);
    REQUIRE_FALSE(spawned.reflected.counts());
    REQUIRE(spawned.refracted.throughput[0] == 1);
    REQUIRE(Length(spawned.refracted.ray.direction.To<double>() - d) < 2e-7);
  }
}

// ---- Where new rays start

// Shapes around points up to 1e5 away, with sizes from 1e-4 to 1e4.
struct Placement {
  Vec3<double> center;
  double size;

  explicit Placement(Random& random) {
    size = std::pow(10.0, Uniform(random, -4, 4));
    center = ToVec3(UniformPoint(random, -1, 1)) * std::pow(10.0, Uniform(random, -2, 5));
  }
};

CompiledScene<float> CompileOne(const Object& object) {
  Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back(object);
  return CompileScene<float>(scene);
}

FrameView<float> FrameOf(const CompiledScene<float>& scene) {
  FrameView<float> frame{};
  frame.geometry = scene.geometry();
  frame.primitives = scene.primitives;
  return frame;
}

// A ray at the shape from outside or, half the time, from its middle.
Ray<float> RayAt(Random& random, const Placement& at, bool from_inside) {
  const Vec3<double> origin =
      at.center + RandomUnit(random) * (at.size * (from_inside ? 0.3 : Uniform(random, 1.5, 30)));
  const Vec3<double> target = at.center + RandomUnit(random) * (at.size * Uniform(random, 0, 1));
  const Vec3<float> start = origin.To<float>();
  return {start, Normalize(target - start.To<double>()).To<float>()};
}

// Positive outside the sphere.
Exact SphereSide(const SphereArrays<float>& spheres, Vec3<float> p) {
  const Vec3<float> center{spheres.center_x[0], spheres.center_y[0], spheres.center_z[0]};
  const Vec3<Exact> f = p.To<Exact>() - center.To<Exact>();
  const Exact r = spheres.radius[0];
  return Dot(f, f) - r * r;
}

// A direction on the normal's side, a third of them grazing.
Vec3<float> AwayFrom(Random& random, Vec3<float> normal, int i) {
  const Vec3<double> n = normal.To<double>();
  const Vec3<double> v = RandomAbout(random, n);
  if (i % 3 != 0) return v.To<float>();
  const Vec3<double> along = Normalize(v - n * Dot(v, n));
  return Normalize(along + n * std::exp2(Uniform(random, -30, -3))).To<float>();
}

TEST_CASE("rays that a sphere spawns start on their side and do not hit it again") {
  Random random(58);
  int outside = 0, inside = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", Sphere{ToGlm(at.center), at.size}, 0});
    const GeometryView<float> geometry = scene.geometry();
    const Ray<float> ray = RayAt(random, at, i % 2);
    const auto hit = scalar::TraceClosest(geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SphereSurface(ray, hit, geometry.spheres, 0);
    const Vec3<float> away = surface.normal * surface.offset;
    const Vec3<float> front = surface.position + away, back = surface.position - away;
    const Vec3<float> direction = AwayFrom(random, surface.normal, i);
    // The exact rule: by its id the sphere is not there for a ray outside it.
    const Vec3<float> out_start = surface.inside() ? back : front;
    const Vec3<float> outward = surface.inside() ? -direction : direction;
    REQUIRE_FALSE(scalar::TraceOccluded(geometry, {out_start, outward, 0}));
    // Where floats cannot resolve the sphere, a start beyond its middle is on no side of it.
    if (surface.offset > 0.05 * at.size) continue;
    const Vec3<float> in_start = surface.inside() ? front : back;
    const Vec3<float> inward = surface.inside() ? direction : -direction;
    REQUIRE(SphereSide(geometry.spheres, out_start) > 0);
    REQUIRE(SphereSide(geometry.spheres, in_start) < 0);
    // Even without its id, a ray that leaves misses: not by its rule but by where it starts.
    const bool is_grazing = i % 3 == 0;
    if (!is_grazing || at.size > 1e4 * surface.offset) {
      REQUIRE_FALSE(scalar::TraceOccluded(geometry, {out_start, outward}));
    }
    const auto far = scalar::TraceClosest(geometry, {in_start, inward, kInsideBit});
    REQUIRE(far.primitive == 0);
    REQUIRE(far.u == 1);
    ++(surface.inside() ? inside : outside);
  }
  MESSAGE(outside, " hits from outside, ", inside, " from inside");
  CHECK(outside > 10000);
  CHECK(inside > 10000);
}

// Positive on the side that the counter-clockwise normal shows to.
Exact TriangleSide(const TriangleArrays<float>& triangles, std::uint32_t i, Vec3<float> p) {
  const Vec3<Exact> a = scalar::TriangleVertex(triangles, i, 0).To<Exact>();
  const Vec3<Exact> b = scalar::TriangleVertex(triangles, i, 1).To<Exact>();
  const Vec3<Exact> c = scalar::TriangleVertex(triangles, i, 2).To<Exact>();
  return Dot(Cross(b - a, c - a), p.To<Exact>() - a);
}

// A square of two triangles, turned any way; its corners are rounded to float first.
Quad RandomQuad(Random& random, const Placement& at) {
  const Vec3<double> n = RandomUnit(random);
  const Vec3<double> e = Normalize(Cross(n, RandomUnit(random))) * at.size;
  const Vec3<double> f = Cross(n, e);
  const auto corner = [&](double a, double b) {
    return ToGlm((at.center + e * a + f * b).To<float>().To<double>());
  };
  return {{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}};
}

TEST_CASE("rays that a triangle spawns start on their side; a coplanar neighbour is not hit") {
  Random random(59);
  int hits = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", RandomQuad(random, at), 0});
    const FrameView<float> frame = FrameOf(scene);
    const Ray<float> ray = RayAt(random, at, false);
    const auto hit = scalar::TraceClosest(frame.geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SurfaceOf(frame, ray, hit);
    const Vec3<float> away = surface.normal * surface.offset;
    const Exact sign = surface.inside() ? -1 : 1;
    const TriangleArrays<float>& triangles = frame.geometry.triangles;
    for (const std::uint32_t triangle : {0u, 1u}) {
      // Where rounding folded the square the neighbour is not coplanar any more.
      if (triangle != hit.primitive && surface.offset > 1e-3 * at.size) continue;
      REQUIRE(TriangleSide(triangles, triangle, surface.position + away) * sign > 0);
      REQUIRE(TriangleSide(triangles, triangle, surface.position - away) * sign < 0);
    }
    if (surface.offset > 1e-3 * at.size) continue;
    ++hits;
    const Vec3<float> direction = AwayFrom(random, surface.normal, i);
    if (Dot(direction, surface.normal) <= 0) continue;
    REQUIRE_FALSE(scalar::TraceOccluded(frame.geometry,
                                        {surface.position + away, direction, surface.source}));
    REQUIRE_FALSE(scalar::TraceOccluded(
        frame.geometry, {surface.position - away, -direction, surface.source ^ kInsideBit}));
  }
  MESSAGE(hits, " hits");
  CHECK(hits > 20000);
}

// A light within 32 roundoffs of the distance over the quad lies in its plane as far as floats
// tell: the vertices are rounded when seen from it, and so is n.l, whose sign alone lets it shine.
TEST_CASE("shadow rays do not meet the quad they are for, grazing light included") {
  constexpr float kInPlane = 32 * kRoundoff<float>;
  Random random(60);
  int lit = 0, grazing = 0, in_plane = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", RandomQuad(random, at), 0});
    const FrameView<float> frame = FrameOf(scene);
    const Ray<float> ray = RayAt(random, at, false);
    const auto hit = scalar::TraceClosest(frame.geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SurfaceOf(frame, ray, hit);
    if (surface.offset > 1e-3 * at.size) continue;
    const Vec3<float> towards = AwayFrom(random, surface.normal, i);
    LightData<float> light = PointLightAt({0, 0, 0}, 1, 0, 0);
    const LightKind kinds[] = {LightKind::kPointFromLight, LightKind::kPointFromSurface,
                               LightKind::kDirectional};
    light.kind = kinds[random() % 3];
    const bool is_point = light.kind != LightKind::kDirectional;
    const auto distance = static_cast<float>(at.size * std::exp2(Uniform(random, -2, 6)));
    const Vec3<float> at_light = is_point ? surface.position + towards * distance : towards;
    for (int axis = 0; axis < 3; ++axis) light.vector[axis] = at_light[axis];
    const auto incidence = scalar::IncidenceOf(light, surface);
    if (!(incidence.n_dot_l > 0)) continue;
    const Exact sign = surface.inside() ? -1 : 1;
    const TriangleArrays<float>& triangles = frame.geometry.triangles;
    const auto is_over = [&](std::uint32_t triangle) {
      return TriangleSide(triangles, triangle, at_light) * sign > 0;
    };
    if (is_point && !(is_over(0) && is_over(1))) continue;
    const bool is_occluded =
        scalar::TraceOccluded(frame.geometry, scalar::ShadowRay(light, surface, incidence));
    if (incidence.n_dot_l <= kInPlane) {
      in_plane += is_occluded;
      continue;
    }
    ++lit;
    grazing += incidence.n_dot_l < 1e-3f;
    if (is_occluded) {
      FAIL_CHECK("round ", i, " light kind ", static_cast<int>(light.kind), " n.l ",
                 incidence.n_dot_l, " size ", at.size, " offset ", surface.offset);
    }
  }
  MESSAGE(lit, " shadow rays, ", grazing, " of them grazing; ", in_plane,
          " occluded with the light in the plane");
  CHECK(lit > 20000);
  CHECK(grazing > 2000);
}

TEST_CASE("shadow rays do not meet the sphere they are for, from outside and inside") {
  Random random(61);
  int outside = 0, inside = 0;
  for (int i = 0; i < 200000; ++i) {
    const Placement at(random);
    const CompiledScene<float> scene = CompileOne({"", Sphere{ToGlm(at.center), at.size}, 0});
    const GeometryView<float> geometry = scene.geometry();
    const Ray<float> ray = RayAt(random, at, i % 2);
    const auto hit = scalar::TraceClosest(geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const Surface<float> surface = scalar::SphereSurface(ray, hit, geometry.spheres, 0);
    if (surface.offset > 1e-3 * at.size) continue;
    // A light inside lights the inside; one outside the outside.
    const double reach =
        surface.inside() ? Uniform(random, 0, 0.99) : std::exp2(Uniform(random, 0.1, 8));
    const Vec3<float> at_light = (at.center + RandomUnit(random) * (at.size * reach)).To<float>();
    for (const LightKind kind : {LightKind::kPointFromLight, LightKind::kPointFromSurface}) {
      LightData<float> light = PointLightAt(at_light, 1, 0, 0);
      light.kind = kind;
      const auto incidence = scalar::IncidenceOf(light, surface);
      if (!(incidence.n_dot_l > 0)) continue;
      ++(surface.inside() ? inside : outside);
      const Ray<float> shadow = scalar::ShadowRay(light, surface, incidence);
      // Outside, the id is the exact rule; from inside, a light may be beyond the sphere itself.
      const bool is_named = !surface.inside() || kind == LightKind::kPointFromSurface;
      REQUIRE(shadow.source == (is_named ? surface.source : kNoPrimitive));
      if (scalar::TraceOccluded(geometry, shadow)) {
        FAIL_CHECK("round ", i, " inside ", surface.inside(), " light kind ",
                   static_cast<int>(kind), " n.l ", incidence.n_dot_l, " size ", at.size,
                   " offset ", surface.offset);
      }
    }
  }
  MESSAGE(outside, " shadow rays outside, ", inside, " inside");
  CHECK(outside > 10000);
  CHECK(inside > 10000);
}

TEST_CASE("a light outside a sphere leaves its inside dark") {
  const CompiledScene<float> scene = CompileOne({"", Sphere{{0, 0, 0}, 1.0}, 0});
  const Ray<float> ray{{0, 0, 0}, {0, 1, 0}};
  const auto hit = scalar::TraceClosest(scene.geometry(), ray);
  REQUIRE(hit.primitive == 0);
  const Surface<float> surface = scalar::SphereSurface(ray, hit, scene.geometry().spheres, 0);
  REQUIRE(surface.inside());
  for (const LightKind kind : {LightKind::kPointFromLight, LightKind::kPointFromSurface}) {
    LightData<float> light = PointLightAt({0.5f, -5, 0}, 1, 0, 0);
    light.kind = kind;
    const auto incidence = scalar::IncidenceOf(light, surface);
    REQUIRE(incidence.n_dot_l > 0);
    CHECK(scalar::TraceOccluded(scene.geometry(), scalar::ShadowRay(light, surface, incidence)));
  }
}

}  // namespace
}  // namespace sheaf
