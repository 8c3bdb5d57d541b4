// Spheres at a distance, from within, near their rims and without a size.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "sheaf/geometry.h"
#include "simd/query.h"
#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {
namespace {

// The squared distance of a unit sphere's centre, the origin, from the ray's line.
long double SquaredDistance(const Ray& ray) {
  const auto d = ray.direction.To<long double>();
  const auto across = Cross(ray.origin.To<long double>(), d);
  return Dot(across, across) / Dot(d, d);
}

}  // namespace

void NearlyEqualSpheres(Report& report) {
  Shapes shapes = UnitSphere();
  shapes.AddSphere({0, 0, 0}, 1.00004f);
  const Ray outer{{0, 0, 5}, {0, 0, -1}};
  ExpectHit(report, shapes, outer, 1, 5 - static_cast<double>(1.00004f), 0.5);
  Ray inner = outer;
  inner.t_min = 3.99998f;
  ExpectHit(report, shapes, inner, 0, 4, 0.5);
}

void NearTangent(Report& report) {
  Random random(11);
  const Shapes sphere = UnitSphere();
  for (int power = 0; power <= 6; ++power) {
    const double distance = std::pow(10.0, power) + 1;
    std::vector<Ray> rays;
    for (int i = 0; i < 400; ++i) {
      // Through a point about 0.999 or 1.001 radii from the centre; far away a direction of float
      // misses that by more, so what counts is where the line passes.
      const Vec view = random.Direction();
      const Vec across = Normalize(Cross(view, random.Direction()));
      const Vec origin = view * static_cast<float>(distance);
      const float aim = i % 2 ? 0.999f : 1.001f;
      rays.push_back({origin, Normalize(across * aim - origin)});
    }
    // docs/numerics.md, "Spheres".
    const long double band = 16 * 0x1p-53L * (static_cast<long double>(distance) + 1);
    const std::vector<Hit> hits = TraceEverywhere(report, sphere, rays);
    int within = 0, judged = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const long double past = SquaredDistance(rays[i]) - 1;
      if (std::abs(past) <= band) continue;
      report.Expect(IsHit(hits[i]) == (past < 0), "misjudged", &rays[i]);
      within += past < 0;
      ++judged;
    }
    report.Expect(within > 100 && judged > 390, "rays that pass on one side alone, or in doubt");
  }
}

void GroundSphere(Report& report) {
  Shapes shapes;
  shapes.AddSphere({0, -1e6f, 0}, 1e6f);
  Random random(12);
  for (int i = 0; i < 100; ++i) {
    const Vec d = Normalize(Vec{random.In(-1, 1), random.In(-1, -0.01f), random.In(-1, 1)});
    const Ray ray{{0, 1, 0}, d};
    // The root without cancellation, in long double.
    const long double a = static_cast<long double>(d.x) * d.x +
                          static_cast<long double>(d.y) * d.y + static_cast<long double>(d.z) * d.z;
    const long double b = -1000001.0L * static_cast<long double>(d.y);
    const long double c = 1000001.0L * 1000001.0L - 1e12L;
    const long double t = c / (b + std::sqrt(b * b - a * c));
    ExpectHit(report, shapes, ray, 0, static_cast<double>(t), 1);
  }
}

void OnSphere(Report& report) {
  const Ray out{{0, 0, 1}, {0, 0, 1}}, in{{0, 0, 1}, {0, 0, -1}};
  ExpectAllMiss(report, UnitSphere(), {out});
  ExpectHit(report, UnitSphere(), in, 0, 2, 0);
  // Points that rounding put off the sphere, to either side: the source decides.
  Random random(13);
  std::vector<Ray> outward, inward;
  for (int i = 0; i < 500; ++i) {
    const Vec at = random.Direction();
    outward.push_back({at, at, 0});
    inward.push_back({at, -at, kInsideBit});
  }
  ExpectAllMiss(report, UnitSphere(), outward);
  const std::vector<Hit> hits = TraceEverywhere(report, UnitSphere(), inward);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    report.Expect(IsHit(hits[i]) && hits[i].u == 1, "not the far root", &inward[i]);
  }
}

void FromCentre(Report& report) {
  for (const float radius : {1e-6f, 0.1f, 1.0f, 3.7f, 1e8f}) {
    Shapes shapes;
    shapes.AddSphere({1, 2, 3}, radius);
    ExpectHit(report, shapes, {{1, 2, 3}, {0, 0, 1}}, 0, static_cast<double>(radius), 0);
    ExpectHit(report, shapes, {{1, 2, 3}, {0, -2, 0}}, 0, static_cast<double>(radius) / 2, 0);
  }
}

void BadRadius(Report& report) {
  Shapes point;
  point.AddSphere({0, 0, 0}, 0);
  point.AddSphere({0, 0, 0}, -0.0f);
  ExpectAllMiss(report, point, {{{0, 0, 5}, {0, 0, -1}}, {{0, 0, 0}, {0, 0, -1}}});
  for (const float radius : {-1.0f, kInfinity, kNan}) {
    const std::array<float, 4> sphere = {0, 0, 0, radius};
    GeometryInput input;
    input.AddSpheres(sphere);
    report.Expect(!Geometry::Build(input), fmt::format("a radius of {} is accepted", radius));
  }
}

}  // namespace sheaf::stress
