// Pictures do not tell how large a scene is, where it lies, or what huge or thin things are in it.
#include <fmt/format.h>

#include <cmath>

#include "src/lab/picture_cases.h"
#include "src/lab/picture_metrics.h"
#include "src/lab/stress_cases.h"
#include "src/scene/transform.h"

namespace sheaf::stress {
namespace {

// A matt ball and one of glass on a square of this half size, lit by a lamp and a sun.
Scene Still(double half_size) {
  Scene scene = NewScene();
  scene.settings.ambient = Colour(0.2);
  Material ball = Matt(), mirror = Matt();
  ball.base_colour = Colour(0.9, 0.3, 0.2);
  ball.ambient = mirror.ambient = 0.5;
  mirror.reflect = Colour(0.5);
  scene.materials = {ball, Glass(1.5), mirror};
  const double s = half_size;
  scene.objects = {{"matt", Sphere{{0.8, 0, -5}, 1}, 0},
                   {"glass", Sphere{{-1, -0.4, -4}, 0.6}, 1},
                   {"ground", Quad{{Vec3d(-s, -1, s), {s, -1, s}, {s, -1, -s}, {-s, -1, -s}}}, 2}};
  scene.lights = {LampAt({2, 4, -2}),
                  {"sun", DirectionalLight{{-1, -1.5, -0.7}}, Colour(1.0), 0.4, true}};
  scene.cameras[0].eye = Vec3d(0, 1, 0);
  scene.cameras[0].look_at = Vec3d(0, -0.3, -4);
  return scene;
}

// At most `most` of 160 x 120 pixels differ from double by more than 1/255.
void ExpectNearDouble(Report& report, const Scene& scene, std::uint64_t most,
                      const std::string& what) {
  RenderOptions options = Small(scene);
  options.width = 160;
  options.height = 120;
  const Film film = RenderEverywhere(report, scene, options);
  options.precision = Precision::kDouble;
  const Result<Film> exact = Render(scene, scene.cameras.at(0), options);
  report.Expect(exact.ok(), "the frame does not render in double");
  if (!exact || film.rgb.empty()) return;
  const auto over = MeasurePictures(exact.value(), film, Transfer::kLinear).over;
  report.Expect(over <= most, fmt::format("{}: {} pixels differ from double", what, over));
}

Scene Placed(const Scene& scene, const Transform& transform) {
  Scene placed = scene;
  TransformScene(transform, &placed);
  return placed;
}

}  // namespace

void MovedScenes(Report& report) {
  for (double far = 1e2; far < 2e7; far *= 10) {
    Transform transform;
    transform.translation = Vec3d(far, -far, 0.7 * far);
    ExpectNearDouble(report, Placed(Still(5), transform), 8, fmt::format("moved by {:g}", far));
  }
}

void UnitsOfLength(Report& report) {
  for (const int power : {-60, -30, 30, 60}) {
    Transform transform;
    transform.linear = glm::dmat3(std::ldexp(1.0, power));
    // A ground and a bead, whose edge functions leave the range of float, and a lamp that fades
    // with the square of distances, which do.
    Scene scene = Still(500);
    Mesh bead = SmoothBall(8);
    for (glm::vec3& p : bead.positions) p = p * 0.1f + glm::vec3(-0.1f, -0.9f, -2.5f);
    scene.objects.push_back({"bead", bead, 0});
    std::get<PointLight>(scene.lights[0].source).falloff = {0, 0, std::ldexp(0.05, -2 * power)};
    ExpectNearDouble(report, Placed(scene, transform), 8, fmt::format("2^{} large", power));
  }
}

void HugeGround(Report& report) {
  for (double half_size = 1e2; half_size < 2e7; half_size *= 10) {
    for (const double degrees : {0, 12}) {
      const Scene scene = Placed(Still(half_size), RotationAbout({0, 0, 1}, degrees));
      ExpectNearDouble(report, scene, 8, fmt::format("a ground of {:g}", half_size));
    }
  }
}

void ThinWalls(Report& report) {
  for (const double ulps : {4, 8, 1000}) {
    Scene scene = NewScene();
    scene.settings.ambient = Colour(1.0);
    Material checker;
    checker.ambient = 1;
    checker.base_colour = Checker{Colour(1.0), Colour(0.0), {20, 20}};
    scene.materials = {Glass(1.5), Glass(1 / 1.5), checker};
    scene.settings.max_depth = 8;
    const double wall = std::ldexp(ulps, -21);
    scene.objects = {
        {"", Sphere{{0, 0, -5}, 1.5}, 0},
        {"", Sphere{{0, 0, -5}, 1.5 - wall}, 1},
        {"", Quad{{Vec3d(-6, -6, -9.5), {6, -6, -9.5}, {6, 6, -9.5}, {-6, 6, -9.5}}}, 2}};
    ExpectNearDouble(report, scene, 30, fmt::format("a wall of {} ULP", ulps));
  }
}

// From a light to the shadow side no pixel differs from the next by more than a fiftieth.
void SmoothTerminator(Report& report) {
  for (const bool casts_shadows : {false, true}) {
    Scene scene = NewScene();
    scene.settings.background = Colour(0.0);
    Material white;
    white.kd = 1;
    scene.materials = {white};
    scene.objects = {{"ball", SmoothBall(8), 0}};
    scene.lights = {{"sun", DirectionalLight{{-1, -0.3, -0.2}}, Colour(1.0), 1, casts_shadows}};
    scene.cameras[0] = {"c", {0, 0, 4}, {0, 0, 0}, {0, 1, 0}, Perspective{32}};
    RenderOptions options = Small(scene);
    options.width = options.height = 300;
    const Film film = RenderEverywhere(report, scene, options);
    float step = 0;
    for (int y = 90; y < 210; ++y) {
      for (int x = 90; x < 210; ++x) {
        step = std::max(step, std::abs(film.pixel(x, y)[0] - film.pixel(x - 1, y)[0]));
        step = std::max(step, std::abs(film.pixel(x, y)[0] - film.pixel(x, y - 1)[0]));
      }
    }
    report.Expect(step <= 0.02f, fmt::format("neighbouring pixels differ by {}", step));
  }
}

}  // namespace sheaf::stress
