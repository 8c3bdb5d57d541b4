// Rays at the edges and vertices of meshes slip through nowhere.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {
namespace {

void LeakAt(Report& report, Vec place) {
  Shapes sphere;
  AddSphereMesh(sphere, place, 2, report.is_thorough() ? 100 : 12);
  ExpectAllHit(report, sphere, AimAtEdges(sphere, place));
  Shapes plane;
  for (std::uint32_t y = 0; y <= 12; ++y) {
    for (std::uint32_t x = 0; x <= 12; ++x) {
      plane.AddVertex(place + Vec{static_cast<float>(x) - 6, 0, static_cast<float>(y) - 6});
    }
  }
  for (std::uint32_t y = 0; y < 12; ++y) {
    for (std::uint32_t x = 0; x < 12; ++x) {
      const std::uint32_t at = 13 * y + x;
      plane.AddTriangle(at, at + 1, at + 14);
      plane.AddTriangle(at, at + 14, at + 13);
    }
  }
  // The rim is a silhouette, which a ray may pass by a rounding error.
  std::vector<Ray> inner;
  for (std::uint32_t y = 1; y < 12; ++y) {
    for (std::uint32_t x = 1; x < 12; ++x) {
      inner.push_back(Towards(place + Vec{0, 8, 0}, plane.vertex(13 * y + x)));
    }
  }
  ExpectAllHit(report, plane, inner);
}

}  // namespace

void FarLeaks(Report& report) { LeakAt(report, {148376, 1234, -223423}); }
void OriginLeaks(Report& report) {
  LeakAt(report, {0, 0, 0});
  LeakAt(report, {1e7f, 1e7f, 1e7f});
}

void GridLeaks(Report& report) {
  Shapes grid;
  for (std::uint32_t y = 0; y <= 8; ++y) {
    for (std::uint32_t x = 0; x <= 8; ++x) {
      grid.AddVertex({static_cast<float>(x), static_cast<float>(y), 0});
    }
  }
  for (std::uint32_t at = 0; at < 71; ++at) {
    if (at % 9 == 8) continue;
    grid.AddTriangle(at, at + 1, at + 10);
    grid.AddTriangle(at, at + 10, at + 9);
  }
  std::vector<Ray> rays;
  for (int y = 0; y <= 16; ++y) {
    for (int x = 0; x <= 16; ++x) {
      const Vec at = {static_cast<float>(x) / 2, static_cast<float>(y) / 2, 5};
      rays.push_back({at, {0, 0, -1}});
      rays.push_back({{at.x, at.y, -5}, {0, 0, 1}});
    }
  }
  ExpectAllHit(report, grid, rays);
}

void Diagonal(Report& report) {
  Shapes quad;
  quad.AddQuad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  const Ray ray{{0, 0, 10}, {.30458447f, .30458447f, -.9024725f}};
  const Hit hit = TraceEverywhere(report, quad, {ray}).front();
  const float x = hit.t * ray.direction.x;
  report.Expect(IsHit(hit) && std::abs(x - 3.375f) < 1e-3f, "no hit near (3.375, 3.375, 0)", &ray);
}

void SlantedEdge(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({0, 0, -1}, {1, 0, -1}, {0, 1, -1});
  shapes.AddTriangle({1, 0, -1}, {1, 1, -1}, {0, 1, -1});
  const float x = 0x1.e1p-1f, y = 0x1.fp-5f;  // bits 0x3f708000 and 0x3d780000
  ExpectAllHit(report, shapes, {{{x, y, 0}, {0, 0, -1}}});
}

void HalfSphere(Report& report) {
  Shapes shapes;
  AddSphereMesh(shapes, {0, 0, 0}, 1, 16);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) {
    if (shapes.vertex(i).y > 0.1f) rays.push_back(Towards({0, 0, 0}, shapes.vertex(i)));
  }
  // The lower half goes away, but a ring below the equator.
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < shapes.indices.size(); i += 3) {
    float lowest = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      lowest = std::min(lowest, shapes.vertex(shapes.indices[i + k]).y);
    }
    if (lowest > -0.01f) kept.insert(kept.end(), &shapes.indices[i], &shapes.indices[i] + 3);
  }
  shapes.indices = kept;
  ExpectAllHit(report, shapes, rays);
}

void PerturbedSpheres(Report& report) {
  const std::uint32_t seeds = report.is_thorough() ? 100000 : 200;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    Shapes shapes;
    AddSphereMesh(shapes, {0, 0, 0}, random.In(1, 6), 8);
    for (float& number : shapes.vertices) number *= random.In(0.95f, 1.05f);
    std::vector<Ray> rays = AimAtEdges(shapes, {0, 0, 0});
    rays.resize(shapes.vertex_count());
    ExpectAllHit(report, shapes, rays);
  }
}

void Slivers(Report& report) {
  for (const float width : {1e-4f, 1e-5f, 1e-6f, 1e-7f, 1e-8f}) {
    Shapes strip;  // of quads 1 high and `width` wide
    for (int i = 0; i <= 64; ++i) {
      strip.AddVertex({static_cast<float>(i) * width, 0, 0});
      strip.AddVertex({static_cast<float>(i) * width, 1, 0});
    }
    for (std::uint32_t i = 0; i < 128; i += 2) {
      strip.AddTriangle(i, i + 2, i + 3);
      strip.AddTriangle(i, i + 3, i + 1);
    }
    std::vector<Ray> rays;
    for (std::uint32_t i = 4; i < 124; ++i) {
      const Vec at = strip.vertex(i);
      rays.push_back({{at.x, 0.25f + at.y / 2, 1}, {0, 0, -1}});
      rays.push_back(Towards({32 * width, 0.5f, 1}, {at.x, 0.5f, 0}));
    }
    ExpectAllHit(report, strip, rays);
  }
}

void Fan(Report& report) {
  Shapes fan;
  const std::uint32_t hub = fan.AddVertex({0.1f, 0.2f, 0.3f});
  constexpr std::uint32_t kBlades = 1000;
  for (std::uint32_t i = 0; i < kBlades; ++i) {
    const double angle = 2 * std::numbers::pi * i / kBlades;
    fan.AddVertex({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
  }
  for (std::uint32_t i = 0; i < kBlades; ++i) {
    fan.AddTriangle(hub, 1 + i, 1 + (i + 1) % kBlades);
  }
  std::vector<Ray> rays;
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    const Vec origin = random.InBox(1) * 0.2f + Vec{0, 0, 5};
    rays.push_back(Towards(origin, fan.vertex(hub)));
    const Vec rim = fan.vertex(1 + static_cast<std::uint32_t>(2 * i));
    rays.push_back(Towards(origin, fan.vertex(hub) + (rim - fan.vertex(hub)) * 0.5f));
  }
  ExpectAllHit(report, fan, rays);
}

// Nothing may depend on the size of the world or the place in it.
void ScaledWorld(Report& report) {
  for (int power = -6; power <= 6; power += 3) {
    for (const float place : {0.0f, 1e3f, 1e6f}) {
      const float scale = std::pow(10.0f, static_cast<float>(power));
      const Vec center = {place * scale, -place * scale, place * scale};
      Shapes shapes;
      AddSphereMesh(shapes, center, scale, 8);
      ExpectAllHit(report, shapes, AimAtEdges(shapes, center));
    }
  }
}

void Horizon(Report& report) {
  Shapes shapes;
  shapes.AddQuad({-1e6f, 0, -1e6f}, {1e6f, 0, -1e6f}, {1e6f, 0, 1e6f}, {-1e6f, 0, 1e6f});
  std::vector<Ray> down, up;
  Random random(43);
  for (int i = 0; i < 300; ++i) {
    const float slope = std::pow(10.0f, random.In(-5.5f, -1));
    down.push_back({{random.In(-1, 1), 1, 0}, {random.In(-1, 1), -slope, 1}});
    up.push_back({{random.In(-1, 1), 1, 0}, {random.In(-1, 1), slope, 1}});
  }
  ExpectAllHit(report, shapes, down);
  ExpectAllMiss(report, shapes, up);
}

}  // namespace sheaf::stress
