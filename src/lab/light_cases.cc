// Pictures of lights in odd places, of many lights, and of shadows at any scale.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

#include "sheaf/render.h"
#include "src/lab/picture_cases.h"
#include "src/lab/picture_metrics.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {
namespace {

// A floor of many triangles under a low sun, at any scale and place, has no acne: all of it is lit.
// Far away its corners are rounded to a part of a cell, which tilts the cells a little.
Mesh Floor(const Vec3d& at, double size) {
  constexpr std::uint32_t kCells = 8;
  Mesh floor;
  for (std::uint32_t z = 0; z <= kCells; ++z) {
    for (std::uint32_t x = 0; x <= kCells; ++x) {
      const Vec3d corner(2.0 * x / kCells - 1, 0.25 * (2.0 * x / kCells - 1), 1 - 2.0 * z / kCells);
      floor.positions.emplace_back(at + corner * size);
    }
  }
  for (std::uint32_t z = 0; z < kCells; ++z) {
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t first = z * (kCells + 1) + x, above = first + kCells + 1;
      floor.triangles.push_back({first, first + 1, above + 1});
      floor.triangles.push_back({first, above + 1, above});
    }
  }
  return floor;
}

}  // namespace

void LightsInTheWay(Report& report) {
  Scene scene = NewScene();
  scene.materials = {Matt()};
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0},
                   {"", Quad{{Vec3d(-4, -1, 0), {4, -1, 0}, {4, -1, -8}, {-4, -1, -8}}}, 0}};
  for (const Vec3d& place : {Vec3d(0, 0, -3), Vec3d(0, 0, -4), Vec3d(1, -1, -3), Vec3d(0, 0, 0),
                             Vec3d(0, 1, -4), Vec3d(2, -1 - 1e-9, -4)}) {
    scene.lights = {LampAt(place)};
    std::get<PointLight>(scene.lights[0].source).falloff = {0, 0, 1};
    RenderSmall(report, scene);
  }
  // A light within the ball lights nothing outside it.
  scene.settings.background = Colour(0.0);
  scene.lights = {LampAt({0, 0, -4})};
  ExpectUniform(report, RenderSmall(report, scene), 0, 0);
}

void Shininess(Report& report) {
  for (const double shininess : {0.0, 1.0, 1e6}) {
    Scene scene = NewScene();
    scene.materials = {Matt()};
    scene.materials[0].shininess = shininess;
    scene.objects = {{"", Sphere{{0, 0, -4}, 2}, 0}};
    scene.lights = {LampAt({0, 0, 0}), LampAt({3, 3, 0})};
    RenderSmall(report, scene);
  }
}

// Faces that turn away from a light are dark and no others are shadowed: a convex body casts no
// shadow on itself that its faces' normals do not tell already.
void ShadowTerminator(Report& report) {
  for (const std::uint32_t rings : {3u, 5u, 12u}) {
    Film films[2];
    for (const bool shadows : {false, true}) {
      Scene scene = NewScene();
      scene.cameras[0].eye = Vec3d(0, 0.5, 3);
      scene.settings.background = Colour(0.0);
      Material white;
      white.kd = 1;
      scene.materials = {white};
      scene.objects = {{"ball", SmoothBall(rings), 0}};
      scene.lights = {LampAt({3, 1, 0.5}),
                      {"sun", DirectionalLight{{0.3, -1, -0.2}}, Colour(1.0), 1, true}};
      for (Light& light : scene.lights) light.casts_shadows = shadows;
      films[shadows] = RenderSmall(report, scene);
    }
    report.Expect(CompareFilms(films[0], films[1], 0).pixels == 0,
                  fmt::format("a ball of {} rings shadows itself", rings));
    const auto [low, high] = std::minmax_element(films[1].rgb.begin(), films[1].rgb.end());
    report.Expect(low != films[1].rgb.end() && *low == 0 && *high > 0.5f, "no dark or no lit side");
  }
}

void OverbrightSurfaces(Report& report) {
  Scene scene = NewScene();
  scene.materials = {Matt()};
  scene.materials[0].kd = scene.materials[0].ks = 1;
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0}};
  scene.lights = {LampAt({0, 0, 0})};
  const Film film = RenderSmall(report, scene);
  float most = 0;
  for (const float value : film.rgb) most = std::max(most, value);
  report.Expect(most > 1, "kd + ks > 1 is clamped before the picture is written");
}

// Many faint lights add up to a bright one.
void ManyLights(Report& report) {
  constexpr int kCount = 1000000;
  Scene scene = NewScene();
  scene.materials = {Matt()};
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0}};
  scene.lights = {LampAt({2, 2, 0})};
  RenderOptions options = Small(scene);
  options.width = 4;
  options.height = 3;
  const Film one = RenderEverywhere(report, scene, options);
  scene.lights.assign(kCount, scene.lights[0]);
  for (Light& light : scene.lights) light.intensity = 1.0 / kCount;
  const Film many = RenderEverywhere(report, scene, options);
  for (std::size_t i = 0; i < one.rgb.size(); ++i) {
    // A float sum of n terms may err by n roundoffs.
    const double slack = 1e-6 + 6e-8 * kCount * static_cast<double>(one.rgb[i]);
    report.Expect(
        std::abs(static_cast<double>(many.rgb[i] - one.rgb[i])) <= slack,
        fmt::format("{} faint lights give {} and one {}", kCount, many.rgb[i], one.rgb[i]));
  }
}

void ScaledPictures(Report& report) {
  for (int power = -6; power <= 6; power += 2) {
    for (const double place : {0.0, 1e3, 1e6}) {
      const double s = std::pow(10.0, power);
      const Vec3d at = Vec3d(1, -1, 1) * (place * s);
      Scene scene = NewScene();
      scene.settings.background = Colour(0.0);
      scene.cameras[0].eye = at + Vec3d(-1, 12, 4) * s;
      scene.cameras[0].look_at = at;
      scene.cameras[0].up = Vec3d(0, 0, -1);
      Material white;
      white.kd = 1;
      scene.materials = {white};
      scene.objects = {{"floor", Floor(at, 50 * s), 0}};
      // Ten degrees above the floor's slope.
      scene.lights = {{"sun", DirectionalLight{{-1, -0.44, 0.1}}, Colour(1.0), 1, true}};
      const Film film = RenderSmall(report, scene);
      for (const float value : film.rgb) {
        report.Expect(value > 0.14f && value < 0.2f,
                      fmt::format("scale 1e{} at {}: a lit pixel is {}", power, place, value));
      }
    }
  }
}

}  // namespace sheaf::stress
