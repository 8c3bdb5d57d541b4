#include "src/lab/picture_cases.h"

#include <fmt/format.h>

#include <cmath>

#include "src/lab/picture_metrics.h"
#include "src/lab/probe.h"

namespace sheaf::stress {

Film RenderEverywhere(Report& report, const Scene& scene, RenderOptions options) {
  options.target = Target::Scalar();
  const Result<Film> expected = Render(scene, scene.cameras.at(0), options);
  report.Expect(expected.ok(), "the frame does not render");
  if (!expected) return {};
  for (const float value : expected.value().rgb) {
    report.Expect(std::isfinite(value), "a pixel is not finite");
  }
  ForEachTarget(report, [&](Target target) {
    options.target = target;
    const Result<Film> film = Render(scene, scene.cameras.at(0), options);
    const bool same = film && CompareFilms(expected.value(), film.value(), 0).pixels == 0;
    report.Expect(same, target.name() + " has other bits than src/scalar");
  });
  return expected.value();
}

RenderOptions Small(const Scene& scene) {
  RenderOptions options;
  options.width = 40;
  options.height = 30;
  options.max_depth = scene.settings.max_depth;
  return options;
}

Film RenderSmall(Report& report, const Scene& scene) {
  return RenderEverywhere(report, scene, Small(scene));
}

Scene NewScene() {
  Scene scene;
  scene.settings.background = Colour(0.5);
  scene.cameras = {{"eye", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, Perspective{60}}};
  return scene;
}

Material Matt() {
  Material material;
  material.name = "matt";
  material.kd = 0.8;
  material.ks = 0.4;
  material.shininess = 20;
  return material;
}

Material Glass(double ior) {
  Material material;
  material.name = "glass";
  material.transmit = Colour(1.0);
  material.ior = ior;
  return material;
}

Light LampAt(const Vec3d& position) {
  Light light;
  light.name = "lamp";
  light.source = PointLight{position, {1, 0, 0}};
  return light;
}

Mesh SmoothBall(std::uint32_t rings) {
  Shapes shapes;
  AddSphereMesh(shapes, {0, 0, 0}, 1, rings);
  Mesh ball;
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) {
    const Vec out = shapes.vertex(i);
    ball.positions.emplace_back(out.x, out.y, out.z);
  }
  ball.normals = ball.positions;
  for (std::size_t i = 0; i < shapes.indices.size(); i += 3) {
    ball.triangles.push_back({shapes.indices[i], shapes.indices[i + 1], shapes.indices[i + 2]});
  }
  return ball;
}

void ExpectUniform(Report& report, const Film& film, double low, double high) {
  for (const float value : film.rgb) {
    const double v = static_cast<double>(value);
    report.Expect(v >= low && v <= high, fmt::format("a pixel is {}, not {} to {}", v, low, high));
  }
}

}  // namespace sheaf::stress
