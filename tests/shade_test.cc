// Shading against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "plain_surfaces.h"
#include "random_scene.h"
#include "simd/shading.h"
#include "src/bvh/build_tree.h"
#include "src/scalar/render_pixel.h"

namespace sheaf {
namespace {

using scalar::Surface;

bool IsBlack(Vec3<float> c) { return c.x == 0 && c.y == 0 && c.z == 0; }

Vec3<float> Lit(const LightData<float>& light, const MaterialData<float>& material,
                const Surface<float>& surface) {
  return scalar::LitBy(light, material, surface, scalar::BaseColourAt(material, {}, surface),
                       scalar::IncidenceOf(light, surface));
}

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
  Surface<float> floor = Floor();
  const scalar::ShadedPoint<float> at{material, material, scalar::PatternAt(material, floor),
                                      floor};
  const auto local = scalar::LocalLight(FrameView<float>{}, at, {}, tally);
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
  const scalar::ShadedPoint<float> at{material, material, scalar::PatternAt(material, surface),
                                      surface};
  return scalar::LocalLight(frame, at, {}, tally);
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

}  // namespace
}  // namespace sheaf
