// Pictures do not depend on where in the world a scene lies, or on its unit of length.
#include <cmath>

#include "pixels_over.h"
#include "same_bits.h"
#include "sheaf/render.h"
#include "src/render/place_scene.h"
#include "src/scene/transform.h"
#include "test_frames.h"

namespace sheaf {
namespace {

// The crystal ball on a small picture, with a mirror of triangles in it.
Scene SmallBall() {
  Scene scene = CrystalBall();
  scene.settings.width = 320;
  scene.settings.height = 240;
  Material mirror;
  mirror.name = "mirror";
  mirror.kd = 0.2;
  mirror.reflect = Colour(0.7);
  scene.materials.push_back(mirror);
  const Vec3d tip(3.1, 0.4, -10.2), left(1.9, -2.7, -9.8), right(4.2, -2.6, -9.3);
  const Vec3d back(3.3, -2.8, -11.7);
  const std::uint32_t material = static_cast<std::uint32_t>(scene.materials.size()) - 1;
  scene.objects.push_back({"", Triangle{{left, right, tip}}, material});
  scene.objects.push_back({"", Triangle{{right, back, tip}}, material});
  scene.objects.push_back({"", Disk{{-3.5, -2.5, -8}, 0.7, {0.3, 1, 0.4}}, material});
  return scene;
}

// First scaled about the world's origin, then moved. Light falls off over the same share of the
// scene.
Scene Placed(const Scene& scene, const Vec3d& offset, double scale) {
  Transform transform;
  transform.linear = glm::dmat3(scale);
  transform.translation = offset;
  Scene placed = scene;
  REQUIRE(TransformScene(transform, &placed) == "");
  for (Light& light : placed.lights) {
    auto* const point = std::get_if<PointLight>(&light.source);
    if (point == nullptr) continue;
    point->falloff.linear /= scale;
    point->falloff.quadratic /= scale * scale;
  }
  return placed;
}

// Strict on every target against double of the same scene, and that against where the scene was
// made.
void CheckPlaced(const Scene& made, const Scene& placed, std::size_t camera, int most) {
  RenderOptions options;
  options.precision = Precision::kDouble;
  const Film exact = RenderOrFail(placed, placed.cameras[camera], options);
  CHECK(PixelsOver(exact, RenderOrFail(made, made.cameras[camera], options)) <= most);
  options.precision = Precision::kStrict;
  Film first;
  ForEachTarget([&](Target target) {
    options.target = target;
    const Film film = RenderOrFail(placed, placed.cameras[camera], options);
    if (first.rgb.empty()) {
      first = film;
      CHECK(PixelsOver(film, exact) <= most);
    }
    CHECK(PixelsThatDiffer(film, first) == 0);
  });
  options.target = Target::Scalar();
  options.crop = PixelRect{60, 80, 200, 140};
  const Film scalar = RenderOrFail(placed, placed.cameras[camera], options);
  options.target = {};
  CHECK(PixelsThatDiffer(RenderOrFail(placed, placed.cameras[camera], options), scalar) == 0);
}

constexpr int kMostPixels = 20;  // of 76,800

TEST_CASE("a scene may lie anywhere") {
  const Scene scene = SmallBall();
  for (const std::size_t camera : {0, 5, 6}) {
    for (const double far : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
      CAPTURE(camera);
      CAPTURE(far);
      CheckPlaced(scene, Placed(scene, {far, -far, 0.7 * far}, 1), camera, kMostPixels);
    }
  }
  // Along the view too, where no picture shows the distance.
  CheckPlaced(scene, Placed(scene, {0, 0, 3e6}, 1), 0, kMostPixels);
}

TEST_CASE("a scene may have any unit of length") {
  const Scene scene = SmallBall();
  for (const int power : {-60, -40, -21, -9, 9, 21, 40, 60}) {
    CAPTURE(power);
    const double scale = std::ldexp(1.0, power);
    CheckPlaced(scene, Placed(scene, Vec3d(0), scale), 0, kMostPixels);
    CheckPlaced(scene, Placed(scene, Vec3d(1e5, 2e5, -3e5) * scale, scale), 6, kMostPixels);
  }
}

TEST_CASE("other projections see a scene anywhere") {
  Scene scene = SmallBall();
  scene.views.clear();  // they name cameras that go
  scene.cameras = {{"flat", {0, 3, 3}, {0, -1, -10}, {0, 1, 0}, Orthographic{9}},
                   {"all", {0, 0, -5}, {0, -1, -10}, {0, 1, 0}, Equirectangular{}},
                   {"fish", {0, 2, -4}, {0, -1, -10}, {0, 1, 0}, Fisheye{170}}};
  for (std::size_t camera = 0; camera < 3; ++camera) {
    CAPTURE(camera);
    CheckPlaced(scene, Placed(scene, {1e5, -1e5, 1e5}, 1), camera, kMostPixels);
    CheckPlaced(scene, Placed(scene, {3e19, 1e19, 0}, 0x1p50), camera, kMostPixels);
  }
}

TEST_CASE("layers speak the user's lengths") {
  const Scene scene = SmallBall();
  RenderOptions options;
  for (const Layer layer : {Layer::kDepth, Layer::kId, Layer::kNormal}) options.layers.Add(layer);
  options.width = 64;
  options.height = 48;
  for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
    options.precision = precision;
    const Film made = RenderOrFail(scene, scene.cameras[0], options);
    for (const double scale : {0x1p-50, 1.0, 0x1p50}) {
      const Scene placed = Placed(scene, Vec3d(1e5, 0, -1e5) * scale, scale);
      const Film film = RenderOrFail(placed, placed.cameras[0], options);
      int different = 0;
      for (int y = 0; y < film.height; ++y) {
        for (int x = 0; x < film.width; ++x) {
          const double was = static_cast<double>(*made.at(Layer::kDepth, x, y));
          const double is = static_cast<double>(*film.at(Layer::kDepth, x, y)) / scale;
          const bool same_id = *made.at(Layer::kId, x, y) == *film.at(Layer::kId, x, y);
          const bool same_depth = was == is || std::abs(was - is) <= 1e-4 * was;
          different += !same_id || !same_depth;
        }
      }
      CHECK(different <= 3);
    }
  }
}

TEST_CASE("what lies well stays where it is") {
  const auto stays = [](const Scene& scene) {
    for (const Camera& camera : scene.cameras) {
      const ScenePlacement placement = PlaceScene(scene, camera);
      CHECK(placement.origin == Vec3d(0));
      CHECK(placement.scale == 1);
    }
  };
  stays(SmallBall());
  stays(EverythingScene(3));
  Scene scene = SmallBall();
  const double s = 1e7;
  scene.objects.push_back(
      {"ground", Quad{{Vec3d(-s, -4, s), {s, -4, s}, {s, -4, -s}, {-s, -4, -s}}}, 0});
  scene.objects.push_back({"sky", Sphere{{0, 0, 0}, 1e9}, 0});
  stays(scene);
  scene.objects.clear();
  scene.cameras[0].eye = Vec3d(1e9, 0, 0);
  stays(scene);

  // The ground does not hide that everything else is far away.
  scene = SmallBall();
  scene.objects.push_back(
      {"ground", Quad{{Vec3d(-s, -4, s), {s, -4, s}, {s, -4, -s}, {-s, -4, -s}}}, 0});
  scene = Placed(scene, {1e5, 0, 0}, 1);
  const ScenePlacement moved = PlaceScene(scene, scene.cameras[0]);
  CHECK(std::abs(moved.origin.x - 1e5) < 10);
  CHECK(moved.Point(scene.cameras[0].eye) == scene.cameras[0].eye - moved.origin);
  const Scene tiny = Placed(SmallBall(), Vec3d(0), 0x1p-60);
  const ScenePlacement grown = PlaceScene(tiny, tiny.cameras[0]);
  CHECK(grown.Length(0x1p-60) > 0.01);
  CHECK(std::exp2(std::round(std::log2(grown.scale))) == grown.scale);
}

}  // namespace
}  // namespace sheaf
