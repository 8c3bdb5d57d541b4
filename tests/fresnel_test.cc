// Fresnel's split and Snell's law against closed forms and wider arithmetic.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "plain_surfaces.h"
#include "random_scene.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "src/scalar/spawn.h"

namespace sheaf {
namespace {

using scalar::Surface;

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

}  // namespace
}  // namespace sheaf
