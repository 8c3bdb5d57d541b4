// Pictures of glass and mirrors: light is neither made nor lost.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "sheaf/render.h"
#include "src/lab/picture_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {

// Light is neither made nor lost in clear glass, however surfaces nest: all of it is background.
void NestedGlass(Report& report) {
  Scene scene = NewScene();
  scene.settings.max_depth = 40;
  scene.materials = {Glass(1.5), Glass(1.33)};
  scene.objects = {{"around the eye", Sphere{{0, 0, 0}, 1}, 0},
                   {"bubble in it", Sphere{{0, 0, -0.5}, 0.25}, 1},
                   {"touching from outside", Sphere{{0, 0, -2}, 1}, 0},
                   {"concentric", Sphere{{0, 0, -2}, 0.5}, 1}};
  RenderOptions options = Small(scene);
  options.width = 12;
  options.height = 9;
  options.max_depth = 14;
  ExpectUniform(report, RenderEverywhere(report, scene, options), 0.2, 0.5 + 1e-5);
}

void ClearGlass(Report& report) {
  Scene scene = NewScene();
  scene.materials = {Glass(1)};
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0}};
  ExpectUniform(report, RenderSmall(report, scene), 0.5, 0.5);
  RenderStats stats;
  const Result<Film> film = Render(scene, scene.cameras[0], Small(scene), &stats);
  report.Expect(film.ok() && stats.rays.refracted > 0, "nothing goes through");
  report.Expect(stats.rays.reflected == 0, "something is reflected");
}

// Indices so far apart that nearly all is reflected, or nearly every angle is beyond the critical.
void ExtremeGlass(Report& report) {
  for (const double ior : {1e-3, 0.5, 1e3}) {
    Scene scene = NewScene();
    scene.settings.max_depth = 8;
    scene.materials = {Glass(ior)};
    scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0},
                     {"", Quad{{Vec3d(-3, -2, 1), {3, -2, 1}, {3, -2, -9}, {-3, -2, -9}}}, 0}};
    ExpectUniform(report, RenderSmall(report, scene), 0, 0.5 + 1e-5);
  }
}

// Between two mirrors, a ray to the limit: the number of rays stays that of the pixels.
void HallOfMirrors(Report& report) {
  Scene scene = NewScene();
  Material mirror;
  mirror.reflect = Colour(1.0);
  scene.materials = {mirror};
  for (const double z : {-5.0, 5.0}) {
    scene.objects.push_back(
        {"", Quad{{Vec3d(-1e6, -1e6, z), {1e6, -1e6, z}, {1e6, 1e6, z}, {-1e6, 1e6, z}}}, 0});
  }
  RenderOptions options = Small(scene);
  options.width = options.height = 4;
  options.max_depth = report.is_thorough() ? 10000 : 1000;
  RenderEverywhere(report, scene, options);
  RenderStats stats;
  const Result<Film> film = Render(scene, scene.cameras[0], options, &stats);
  // What is deeper counts, and is black.
  const std::uint64_t all = 16u * static_cast<std::uint64_t>(options.max_depth + 1);
  report.Expect(film.ok() && stats.rays.reflected == all,
                fmt::format("{} reflected rays, not {}", stats.rays.reflected, all));
}

// Inside a sphere that glows with 1 and reflects a half: 1 + 1/2 + 1/4 + ... to the depth limit.
void MirrorSeries(Report& report) {
  Scene scene = NewScene();
  scene.settings.ambient = Colour(1.0);
  scene.settings.max_depth = 12;
  Material mirror;
  mirror.ambient = 1;
  mirror.reflect = Colour(0.5);
  scene.materials = {mirror};
  scene.objects = {{"", Sphere{{0.1, 0.2, 0.3}, 3}, 0}};
  const double sum = 2 - std::ldexp(1, -12);
  ExpectUniform(report, RenderSmall(report, scene), sum, sum);
}

}  // namespace sheaf::stress
