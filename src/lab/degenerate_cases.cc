// Triangles without area, shapes in one place, rays in the plane of a triangle.
#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {

void Collinear(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({-1113.45459f, -79.049614f, -56.2431908f},
                     {-1113.45459f, -87.0922699f, -56.2431908f},
                     {-1113.45459f, -79.2090149f, -56.2431908f});
  Ray ray{{-1081.47925f, 99.9999542f, 87.7701111f}, {-32.1072998f, -183.355865f, -144.607635f}};
  ray.t_max = .9999f;
  ExpectAllMiss(report, shapes, {ray});
}

void ZeroArea(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {0, 0, 0}, {1, 1, 0});
  shapes.AddTriangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0});
  shapes.AddTriangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0});
  std::vector<Ray> rays;
  for (const Vec target : {Vec{0, 0, 0}, Vec{1, 1, 0}, Vec{0.5f, 0.5f, 0}}) {
    rays.push_back(Towards({0.3f, 0.1f, 4}, target));
    rays.push_back({{target.x, target.y, 4}, {0, 0, -1}});
  }
  ExpectAllMiss(report, shapes, rays);
}

void CoplanarDuplicates(Report& report) {
  Shapes shapes;
  for (int copy = 0; copy < 3; ++copy) {
    shapes.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    shapes.AddSphere({0.5f, 0.5f, 0}, 0.125f);
  }
  ExpectHit(report, shapes, {{0.75f, 0.25f, 3}, {0, 0, -1}}, 0, 3, 0);
  ExpectHit(report, shapes, {{0.25f, 0.75f, 3}, {0, 0, -1}}, 1, 3, 0);
  // On the diagonal both triangles have it; a sphere in front of them has the first id of three.
  ExpectHit(report, shapes, {{0.875f, 0.875f, 3}, {0, 0, -1}}, 0, 3, 0);
  ExpectHit(report, shapes, {{0.5f, 0.5f, 3}, {0, 0, -1}}, 6, 2.875, 0);
}

void InPlane(Report& report) {
  std::uint64_t hit_count = 0;
  for (std::uint32_t seed = 0; seed < (report.is_thorough() ? 5000u : 50u); ++seed) {
    Random random(seed);
    Shapes shapes;
    for (int i = 0; i < 30; ++i) AddRandomTriangle(random, shapes, 1);
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 90; i += 3) {
      const Vec a = shapes.vertex(i), b = shapes.vertex(i + 1), c = shapes.vertex(i + 2);
      // Along an edge, past the triangle, and across it, all within its plane but for rounding.
      rays.push_back({a + (a - b) * 2.0f, b - a});
      rays.push_back({b + (b - c) + (b - a), (c - b) + (a - b) * random.In(-2, 2)});
      const auto in_plane = [&](float most) {
        const float along_b = random.In(-most, most), along_c = random.In(-most, most);
        return (b - a) * along_b + (c - a) * along_c;
      };
      const Vec origin = a + in_plane(9);
      rays.push_back({origin, in_plane(1)});
    }
    // A fan from one origin, all of it in the plane of the first triangle.
    const Vec a = shapes.vertex(0), b = shapes.vertex(1), c = shapes.vertex(2);
    const Vec eye = a + (a - b) * 2.0f;
    for (int i = 0; i < 64; ++i) {
      rays.push_back(Towards(eye, b + (c - b) * (static_cast<float>(i) / 32 - 0.5f)));
    }
    for (const Hit& hit : TraceEverywhere(report, shapes, rays)) {
      report.Expect(hit.t == hit.t && hit.u == hit.u && hit.v == hit.v, "NaN in a hit");
      hit_count += IsHit(hit);
    }
  }
  report.Expect(hit_count > 100, fmt::format("only {} hits", hit_count));
}

void UlpApart(Report& report) {
  const float above = std::nextafter(1.0f, 2.0f);
  Shapes shapes;
  shapes.AddQuad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1});
  shapes.AddQuad({-1, -1, above}, {1, -1, above}, {1, 1, above}, {-1, 1, above});
  // Where the origin's distance keeps the last place.
  ExpectHit(report, shapes, {{0.3f, 0.2f, 2}, {0, 0, -1}}, 2, 2 - static_cast<double>(above), 1);
  ExpectHit(report, shapes, {{0.3f, 0.2f, 0.5f}, {0, 0, 1}}, 0, 0.5, 0);
}

}  // namespace sheaf::stress
