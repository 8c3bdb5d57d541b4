#include "src/lab/ray_cases.h"

#include <fmt/format.h>

#include <cmath>

namespace sheaf::stress {

Shapes UnitSphere() {
  Shapes shapes;
  shapes.AddSphere({0, 0, 0}, 1);
  return shapes;
}

Shapes UnitTriangle() {
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return shapes;
}

void AddRandomTriangle(Random& random, Shapes& shapes, float size) {
  const Vec a = random.InBox(4);
  const Vec b = a + random.InBox(size);
  shapes.AddTriangle(a, b, a + random.InBox(size));
}

std::vector<Ray> AimAtEdges(const Shapes& shapes, Vec origin) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) {
    rays.push_back(Towards(origin, shapes.vertex(i)));
  }
  for (std::size_t i = 0; i < shapes.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const Vec a = shapes.vertex(shapes.indices[i]), b = shapes.vertex(shapes.indices[next]);
    rays.push_back(Towards(origin, a + (b - a) * 0.5f));
  }
  return rays;
}

void ExpectAllHit(Report& report, const Shapes& shapes, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    report.Expect(IsHit(hits[i]), "a miss where there is a surface", &rays[i]);
  }
}

void ExpectAllMiss(Report& report, const Shapes& shapes, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    report.Expect(!IsHit(hits[i]), "a hit where there is nothing", &rays[i]);
  }
}

double UlpsOff(float t, double exact) {
  const float rounded = static_cast<float>(exact);
  const double ulp = static_cast<double>(std::nextafter(std::abs(rounded), kInfinity)) -
                     std::abs(static_cast<double>(rounded));
  return std::abs(static_cast<double>(t) - exact) / ulp;
}

void ExpectHit(Report& report, const Shapes& shapes, const Ray& ray, std::uint32_t primitive,
               double t, double ulps) {
  const Hit hit = TraceEverywhere(report, shapes, {ray}).front();
  report.Expect(hit.primitive == primitive, fmt::format("not primitive {}", primitive), &ray);
  const double error = UlpsOff(hit.t, t);
  report.Expect(error <= ulps, fmt::format("t is {:.3g} ULP off, not up to {}", error, ulps), &ray);
}

}  // namespace sheaf::stress
