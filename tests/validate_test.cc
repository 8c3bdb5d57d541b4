// Scenes that programs make: whatever breaks a rule is named, by Validate and by Render.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "test_frames.h"

namespace sheaf {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr auto kFloatNaN = static_cast<float>(kNaN);

// A scene of one material, one object of each shape, two lights and two cameras.
Scene SoundScene() {
  Random random(1);
  Scene scene;
  scene.materials = {{}, {}};
  scene.materials[1].name = "glass";
  scene.objects = {{"ball", Sphere{}, 0},
                   {"", Quad{{Vec3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 1},
                   {"", Triangle{{Vec3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}}}, 0},
                   {"wall", RandomMesh(random, 3), 0},
                   {"", Disk{}, 0}};
  scene.lights = {{"lamp", PointLight{{1, 2, 3}, {}, Cone{}}}, {"sun", DirectionalLight{}}};
  scene.cameras = {{"front", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, {}},
                   {"wide", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, {}}};
  scene.cameras[1].projection = Fisheye{};
  scene.views = {{"both", {0, 1}}};
  scene.settings.width = scene.settings.height = 4;
  return scene;
}

struct Misuse {
  const char* error;
  std::function<void(Scene&)> break_it;
};

template <typename Shape>
Shape& ShapeOf(Scene& scene, std::size_t object) {
  return std::get<Shape>(scene.objects[object].shape);
}

const std::vector<Misuse>& IndexMisuses() {
  static const std::vector<Misuse> kMisuses = {
      {"object 0 \"ball\": material 2 of 2", [](Scene& s) { s.objects[0].material = 2; }},
      {"object 4: material 4294967295 of 2", [](Scene& s) { s.objects[4].material = ~0u; }},
      {"object 0 \"ball\": material 0 of 0", [](Scene& s) { s.materials.clear(); }},
      {"object 3 \"wall\": triangle 1: vertex 9 of 9",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).triangles[1][2] = 9; }},
      {"object 3 \"wall\": 8 normals for 9 vertices",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).normals.pop_back(); }},
      {"object 3 \"wall\": 1 uv for 9 vertices",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).uv.resize(1); }},
      {"object 3 \"wall\": 10 colours for 9 vertices",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).colours.resize(10); }},
      {"view 0 \"both\": camera 2 of 2", [](Scene& s) { s.views[0].cameras.push_back(2); }},
      {"material 1 \"glass\": base_colour.image is null",
       [](Scene& s) { s.materials[1].base_colour = Texture{}; }},
      {"material 1 \"glass\": base_colour.image has 5 texels, not 2 x 3",
       [](Scene& s) {
         s.materials[1].base_colour =
             Texture{std::make_shared<Image>(Image{"", 2, 3, std::vector<std::uint32_t>(5)})};
       }},
      {"material 1 \"glass\": base_colour.image.width is 0, not a number in [1, 16384]",
       [](Scene& s) { s.materials[1].base_colour = Texture{std::make_shared<Image>()}; }},
  };
  return kMisuses;
}

const std::vector<Misuse>& NumberMisuses() {
  static const std::vector<Misuse> kMisuses = {
      {"object 0 \"ball\": center is nan, not a number in [-1e30, 1e30]",
       [](Scene& s) { ShapeOf<Sphere>(s, 0).center.y = kNaN; }},
      {"object 0 \"ball\": radius is -1, not a number in [0, 1e30]",
       [](Scene& s) { ShapeOf<Sphere>(s, 0).radius = -1; }},
      {"object 1: a corner is inf, not a number in [-1e30, 1e30]",
       [](Scene& s) { ShapeOf<Quad>(s, 1).corners[3].z = kInfinity; }},
      {"object 2: a vertex is 1e+31, not a number in [-1e30, 1e30]",
       [](Scene& s) { ShapeOf<Triangle>(s, 2).vertices[1].x = 1e31; }},
      {"object 2: uv is nan, not a finite float",
       [](Scene& s) { ShapeOf<Triangle>(s, 2).uv[1].x = kNaN; }},
      {"object 3 \"wall\": vertex 4: one of the positions is nan, not a number in [-1e30, 1e30]",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).positions[4].x = kFloatNaN; }},
      {"object 3 \"wall\": vertex 0: one of the normals is nan, not a finite float",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).normals[0].x = kFloatNaN; }},
      {"object 3 \"wall\": vertex 2: one of the colours is -1, not a finite float of at least 0",
       [](Scene& s) { ShapeOf<Mesh>(s, 3).colours[2].z = -1; }},
      {"object 4: normal is nan, not a number in [-1e30, 1e30]",
       [](Scene& s) { ShapeOf<Disk>(s, 4).normal.x = kNaN; }},
      {"material 0: base_colour is nan, not a finite float of at least 0",
       [](Scene& s) { s.materials[0].base_colour = Colour(kNaN, 0, 0); }},
      {"material 1 \"glass\": base_colour.cells is 0, not a finite float above 0",
       [](Scene& s) {
         s.materials[1].base_colour = Checker{Colour(1), Colour(0), {1, 0}};
       }},
      {"material 1 \"glass\": ior is 0, not a finite float above 0",
       [](Scene& s) { s.materials[1].ior = 0; }},
      {"material 1 \"glass\": reflect is 1.5, not a number in [0, 1]",
       [](Scene& s) { s.materials[1].reflect.y = 1.5; }},
      {"material 1 \"glass\": transmit is nan, not a number in [0, 1]",
       [](Scene& s) { s.materials[1].transmit.y = kNaN; }},
      {"material 1 \"glass\": shininess is -1, not a finite float of at least 0",
       [](Scene& s) { s.materials[1].shininess = -1; }},
      {"material 0: emission is inf, not a finite float of at least 0",
       [](Scene& s) { s.materials[0].emission.x = kInfinity; }},
      {"light 0 \"lamp\": position is nan, not a number in [-1e30, 1e30]",
       [](Scene& s) { std::get<PointLight>(s.lights[0].source).position.x = kNaN; }},
      {"light 0 \"lamp\": falloff: one of the terms must be at least 1e-38",
       [](Scene& s) {
         std::get<PointLight>(s.lights[0].source).falloff = {0, 0, 0};
       }},
      {"light 0 \"lamp\": cone.inner must be below cone.outer",
       [](Scene& s) { std::get<PointLight>(s.lights[0].source).cone->inner = 45; }},
      {"light 1 \"sun\": direction is 0 and gives no direction",
       [](Scene& s) {
         s.lights[1].source = DirectionalLight{{0, 0, 0}};
       }},
      {"light 1 \"sun\": intensity is 1e+60, not a finite float of at least 0",
       [](Scene& s) { s.lights[1].intensity = 1e60; }},
      {"light 1 \"sun\": colour is nan, not a finite float of at least 0",
       [](Scene& s) { s.lights[1].colour.z = kNaN; }},
      {"settings: background is nan, not a finite float of at least 0",
       [](Scene& s) { s.settings.background.x = kNaN; }},
      {"settings: exposure is 0, not a finite float above 0",
       [](Scene& s) { s.settings.exposure = 0; }},
      {"settings: samples is 0, not a number in [1, 65536]",
       [](Scene& s) { s.settings.samples = 0; }},
  };
  return kMisuses;
}

const std::vector<Misuse>& CameraMisuses() {
  static const std::vector<Misuse> kMisuses = {
      {"camera 0 \"front\": eye is nan, not a number in [-1e30, 1e30]",
       [](Scene& s) { s.cameras[0].eye.x = kNaN; }},
      {"camera 0 \"front\": the camera looks at its own eye",
       [](Scene& s) { s.cameras[0].look_at = s.cameras[0].eye; }},
      {"camera 0 \"front\": the view direction is parallel to up",
       [](Scene& s) {
         s.cameras[0].up = {0, 0, -3};
       }},
      {"camera 0 \"front\": up is 0 and gives no direction",
       [](Scene& s) {
         s.cameras[0].up = {0, 0, 0};
       }},
      {"camera 0 \"front\": fov_y is 180, not a number in (0, 180)",
       [](Scene& s) { s.cameras[0].projection = Perspective{180}; }},
      {"camera 0 \"front\": height is nan, not a number in (0, 1e30]",
       [](Scene& s) { s.cameras[0].projection = Orthographic{kNaN}; }},
      {"camera 0 \"front\": fov is 361, not a number in (0, 360]",
       [](Scene& s) { s.cameras[0].projection = Fisheye{361}; }},
  };
  return kMisuses;
}

void CheckMisuse(const Misuse& misuse) {
  CAPTURE(misuse.error);
  Scene scene = SoundScene();
  misuse.break_it(scene);
  const Status status = Validate(scene);
  REQUIRE_FALSE(status.ok());
  CHECK(status.error().message == misuse.error);
  CHECK(status.error().kind == ErrorKind::kScene);
  for (const Target target : {Target(), Target::Scalar()}) {
    RenderOptions options;
    options.target = target;
    options.samples = 1;
    const Result<Film> film = Render(scene, scene.cameras[0], options);
    REQUIRE_FALSE(film.ok());
    CHECK(film.error().message == misuse.error);
  }
}

TEST_CASE("sound scenes are valid") {
  const Scene sound = SoundScene();
  REQUIRE(Validate(sound).ok());
  CHECK(Render(sound, sound.cameras[0]).ok());
  CHECK(Validate(Scene{}).ok());
  CHECK(Validate(CrystalBall()).ok());
  for (std::uint64_t seed = 0; seed < 20; ++seed) CHECK(Validate(EverythingScene(seed)).ok());
}

TEST_CASE("a vertex may lie at the very limit, which floats round up") {
  Scene scene = SoundScene();
  ShapeOf<Mesh>(scene, 3).positions[0].x = 1e30f;
  CHECK(Validate(scene).ok());
  ShapeOf<Mesh>(scene, 3).positions[0].x = std::nextafter(1e30f, 2e30f);
  CHECK_FALSE(Validate(scene).ok());
}

TEST_CASE("what is out of range is named") {
  for (const Misuse& misuse : IndexMisuses()) CheckMisuse(misuse);
}

TEST_CASE("numbers that are not finite or out of range are named") {
  for (const Misuse& misuse : NumberMisuses()) CheckMisuse(misuse);
}

TEST_CASE("cameras without a view are named, those of the scene and any other") {
  for (const Misuse& misuse : CameraMisuses()) {
    CheckMisuse(misuse);
    Scene scene = SoundScene();
    const Scene sound = scene;
    misuse.break_it(scene);
    CHECK(Validate(scene.cameras[0]).error().message == misuse.error);
    const Result<Film> film = Render(sound, scene.cameras[0]);
    REQUIRE_FALSE(film.ok());
    CHECK(film.error().message == misuse.error);
  }
}

TEST_CASE("a name does not break a message in two") {
  Scene scene = SoundScene();
  scene.objects[0].name = "a\nb";
  scene.objects[0].material = 5;
  CHECK(Validate(scene).error().message == "object 0 \"a?b\": material 5 of 2");
}

}  // namespace
}  // namespace sheaf
