// Numbers at the edges of floating point: scales, signs, intervals, infinities and NaN.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {

void PowersOfTwo(Report& report) {
  Random random(16);
  const Vec a = random.InBox(1), b = random.InBox(1), c = random.InBox(1), s = random.InBox(1);
  std::vector<float> first;
  for (int power = -40; power <= 40; power += 10) {
    const float scale = std::ldexp(1.0f, power);
    Shapes shapes;
    shapes.AddTriangle(a * scale, b * scale, c * scale);
    shapes.AddSphere(s * scale, 0.3f * scale);
    std::vector<Ray> rays;
    for (int i = 0; i < 50; ++i) {
      Random ray_random(static_cast<std::uint32_t>(i));
      const Vec origin = ray_random.Direction() * 4.0f;
      const Vec inside = (a + b + c) * (1.0f / 3);
      rays.push_back({origin * scale, (i % 2 ? inside : s) - origin});
    }
    std::vector<float> distances;
    for (const Hit& hit : TraceEverywhere(report, shapes, rays)) {
      distances.push_back(IsHit(hit) ? hit.t / scale : -1);
    }
    if (first.empty()) first = distances;
    const auto hits = std::count_if(first.begin(), first.end(), [](float t) { return t > 0; });
    report.Expect(hits > 40, "the rays miss");
    report.Expect(distances == first, fmt::format("t at scale 2^{} is not that times t", power));
  }
}

void MinusZero(Report& report) {
  for (const float zero : {0.0f, -0.0f}) {
    ExpectHit(report, UnitSphere(), {{zero, zero, 3}, {zero, zero, -1}}, 0, 2, 0);
    ExpectHit(report, UnitTriangle(), {{0.25f, 0.25f, 3}, {zero, zero, -1}}, 0, 3, 0);
    ExpectHit(report, UnitTriangle(), {{zero, zero, 3}, {zero, zero, -1}}, 0, 3, 0);
  }
}

void BadDirections(Report& report) {
  Shapes shapes = UnitTriangle();
  shapes.AddSphere({0, 0, 0}, 1);
  std::vector<Ray> rays;
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    rays.push_back({{0.2f, 0.2f, 3}, {bad, 0, -1}});
    rays.push_back({{0.2f, 0.2f, 3}, {0, bad, -1}});
    rays.push_back({{0.2f, 0.2f, 3}, {0, 0, bad}});
  }
  rays.push_back({{0.2f, 0.2f, 3}, {0, 0, 0}});
  rays.push_back({{0.2f, 0.2f, 3}, {-0.0f, 0, -0.0f}});
  ExpectAllMiss(report, shapes, rays);
}

void BadNumbers(Report& report) {
  std::vector<Ray> rays(5, Ray{{0, 0, 3}, {0, 0, -1}});
  rays[0].origin.x = kNan;
  rays[1].origin.z = kInfinity;
  rays[2].t_min = kNan;
  rays[3].t_max = kNan;
  rays[4].t_min = kInfinity;
  ExpectAllMiss(report, UnitSphere(), rays);
}

void BoxFace(Report& report) {
  Shapes shapes;  // a flat box at x = 0, among others, so that there is a tree
  for (int i = 0; i < 40; ++i) {
    const float z = static_cast<float>(-i);
    shapes.AddQuad({0, 0, z}, {0, 1, z}, {0, 1, z - 1}, {0, 0, z - 1});
    shapes.AddQuad({0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z});
  }
  std::vector<Ray> rays;
  for (const float x : {0.0f, -0.0f}) {
    rays.push_back({{x, 0.5f, 3}, {x, 0, -1}});
    rays.push_back({{x, 0, 3}, {x, x, -1}});
    rays.push_back({{x, 1, 3}, {0, x, -1}});
  }
  ExpectAllHit(report, shapes, rays);
}

void Denormals(Report& report) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {1000 * tiny, 0, 0}, {0, 1000 * tiny, 0});
  shapes.AddTriangle({0, 0, -1}, {1, 0, -1}, {0, 1, -1});
  std::vector<Ray> rays;
  for (const float step : {tiny, 100 * tiny, 1e-30f}) {
    rays.push_back({{step, step, 1}, {0, 0, -1}});
    rays.push_back({{0.2f, 0.2f, 1}, {step, 0, -1}});
    rays.push_back({{0.2f, 0.2f, 1}, {0, 0, -step}});
  }
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  report.Expect(hits[1].primitive == 1, "a denormal direction misses the triangle", &rays[1]);
}

void Intervals(Report& report) {
  Ray ray{{0, 0, 3}, {0, 0, -1}};
  ray.t_min = ray.t_max = 2;
  ExpectHit(report, UnitSphere(), ray, 0, 2, 0);
  ray.t_min = 2;
  ray.t_max = std::nextafter(2.0f, 0.0f);
  ExpectAllMiss(report, UnitSphere(), {ray});
  ray.t_max = kInfinity;
  ExpectHit(report, UnitSphere(), ray, 0, 2, 0);
  ray.t_min = std::nextafter(2.0f, 3.0f);
  ExpectHit(report, UnitSphere(), ray, 0, 4, 0);
  Ray at_triangle{{0.25f, 0.25f, 3}, {0, 0, -1}};
  at_triangle.t_min = at_triangle.t_max = 3;
  ExpectHit(report, UnitTriangle(), at_triangle, 0, 3, 0);
}

void LongDirections(Report& report) {
  for (const float length : {1e-20f, 1e-10f, 1.0f, 1e10f, 1e20f}) {
    const double expected = 2 / static_cast<double>(length);
    ExpectHit(report, UnitSphere(), {{0, 0, 3}, {0, 0, -length}}, 0, expected, 1);
    const Ray ray{{0.2f, 0.2f, 2}, {0, 0, -length}};
    ExpectHit(report, UnitTriangle(), ray, 0, expected, 1);
  }
}

}  // namespace sheaf::stress
