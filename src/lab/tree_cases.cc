// Trees over many primitives, over equal ones and over random ones.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "sheaf/geometry.h"
#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {

void Duplicates(Report& report) {
  Shapes shapes;
  const std::uint32_t copies = report.is_thorough() ? 1000000 : 100000;
  const std::uint32_t a = shapes.AddVertex({0, 0, 0}), b = shapes.AddVertex({1, 0, 0}),
                      c = shapes.AddVertex({0, 1, 0});
  for (std::uint32_t i = 0; i < copies; ++i) shapes.AddTriangle(a, b, c);
  ExpectHit(report, shapes, {{0.2f, 0.3f, 3}, {0, 0, -1}}, 0, 3, 0);
}

void ManyInOnePlace(Report& report) {
  const std::uint32_t count = 1000000;
  Shapes point, line;
  for (std::uint32_t i = 0; i < count; ++i) {
    point.AddSphere({1, 2, 3}, 1);
    line.AddSphere({static_cast<float>(i), 0, 0}, 0.25f);
  }
  const Ray at_point{{1, 2, 9}, {0, 0, -1}};
  const Hit hit = TraceEverywhere(report, point, {at_point}, Oracle::kTreeOnly).front();
  report.Expect(hit.primitive == 0 && hit.t == 5, "not the first of many equal spheres", &at_point);
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) {
    const float x = static_cast<float>(i * (static_cast<int>(count) / 100));
    rays.push_back({{x, 0, 5}, {0, 0, -1}});
  }
  rays.push_back({{-5, 0, 0}, {1, 0, 0}});
  const std::vector<Hit> hits = TraceEverywhere(report, line, rays, Oracle::kTreeOnly);
  for (std::size_t i = 0; i < 100; ++i) {
    report.Expect(hits[i].primitive == static_cast<std::uint32_t>(rays[i].origin.x),
                  "not the sphere ahead", &rays[i]);
  }
  report.Expect(hits[100].primitive == 0, "not the first along the line", &rays[100]);
}

void LinearMemory(Report& report) {
  for (const std::uint32_t count : {1000u, 100000u, report.is_thorough() ? 10000000u : 1000000u}) {
    Shapes shapes;
    Random random(37);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec at = random.InBox(100);
      shapes.AddTriangle(at, at + Vec{0.1f, 0, 0}, at + Vec{0, 0.1f, 0.05f});
    }
    GeometryInput input;
    input.AddTriangles(shapes.vertices, shapes.indices);
    const Result<Geometry> geometry = Geometry::Build(input);
    report.Expect(geometry.ok(), "no geometry");
    if (!geometry) return;
    const double bytes = static_cast<double>(geometry.value().statistics().bytes) / count;
    report.Expect(bytes <= 70, fmt::format("{:.1f} bytes a triangle of {}", bytes, count));
  }
}

void RandomScenes(Report& report) {
  const std::uint32_t scenes = report.is_thorough() ? 5000 : 100;
  std::uint64_t sphere_hits = 0, triangle_hits = 0;
  for (std::uint32_t seed = 0; seed < scenes; ++seed) {
    Random random(seed + 1000);
    Shapes shapes;
    const int triangles = static_cast<int>(random.In(0, 60)),
              spheres = static_cast<int>(random.In(0, 30));
    const float size = std::pow(10.0f, random.In(-3, 1));
    for (int i = 0; i < triangles; ++i) AddRandomTriangle(random, shapes, size);
    for (int i = 0; i < spheres; ++i) {
      const Vec center = random.InBox(4);
      shapes.AddSphere(center, random.In(0, size));
    }
    std::vector<Ray> rays;
    const Vec eye = random.InBox(8);
    for (int i = 0; i < 150; ++i) {
      const Vec origin = i % 3 == 0 ? random.InBox(8) : eye;
      Ray ray{origin, i % 2 ? random.Direction() : random.InBox(4) - origin};
      if (i % 7 == 0) ray.t_max = random.In(0, 6);
      rays.push_back(ray);
    }
    for (const Hit& hit : TraceEverywhere(report, shapes, rays)) {
      if (IsHit(hit)) ++(hit.primitive < shapes.indices.size() / 3 ? triangle_hits : sphere_hits);
    }
  }
  report.Expect(sphere_hits > 5 * scenes && triangle_hits > 5 * scenes,
                fmt::format("only {} and {} hits", triangle_hits, sphere_hits));
}

}  // namespace sheaf::stress
