// Light goes on behind what transmits, straight and coloured, unless shadows are opaque.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/formats/write_scene_json.h"
#include "test_frames.h"

namespace sheaf {
namespace {

Object FloorAt(double y, double half, std::uint32_t material) {
  return {"",
          Quad{{Vec3d{-half, y, -half}, Vec3d{-half, y, half}, Vec3d{half, y, half},
                Vec3d{half, y, -half}}},
          material};
}

// A ball over a floor, with a lamp above that does not fade.
Scene BallOverFloor() {
  Scene scene;
  scene.settings.width = 100;
  scene.settings.height = 75;
  scene.settings.background = Colour(0.2);
  scene.settings.ambient = Colour(0.0);
  Material floor, glass;
  floor.name = "floor", glass.name = "glass";
  floor.kd = 1;
  glass.transmit = Colour(1.0);
  scene.materials = {floor, glass};
  scene.objects = {FloorAt(0, 5, 0), {"", Sphere{{0, 1.5, 0}, 1}, 1}};
  scene.lights = {{"lamp", PointLight{{0, 6, 0}, {1, 0, 0}}, Colour(1.0), 1.0}};
  scene.cameras = {{"c", {0, 4, 9}, {0, 0.5, 0}, {0, 1, 0}, Perspective{45}}};
  return scene;
}

// What the floor's middle sends to the eye, from below the sheets.
glm::dvec3 Middle(const Scene& scene) {
  RenderOptions options;
  options.width = options.height = 1;
  const Camera below{"below", {0, 0.5, 0}, {0, 0, 0}, {0, 0, 1}, Orthographic{0.01}};
  const Film film = RenderOrFail(scene, below, options);
  return {film.rgb[0], film.rgb[1], film.rgb[2]};
}

TEST_CASE("a ball that does not bend light is not seen, and casts no shadow") {
  Scene scene = BallOverFloor();
  const Film with = RenderOrFail(scene, scene.cameras[0], {});
  scene.settings.shadows = Shadows::kOpaque;
  const Film opaque = RenderOrFail(scene, scene.cameras[0], {});
  scene.objects.pop_back();
  const Film without = RenderOrFail(scene, scene.cameras[0], {});
  int darker = 0;
  float largest = 0;
  for (std::size_t i = 0; i < with.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(with.rgb[i] - without.rgb[i]));
    darker += opaque.rgb[i] < without.rgb[i] - 0.5f;
  }
  CHECK(largest < 1e-5f);
  CHECK(darker > 300);
}

TEST_CASE("each surface on the way takes its share, colour by colour") {
  Scene scene = BallOverFloor();
  scene.materials[1].transmit = {1, 0.5, 0.25};
  scene.materials[1].ior = 1.5;  // light goes straight on even so
  scene.objects = {FloorAt(0, 5, 0), FloorAt(2, 1, 1), FloorAt(3, 1, 1)};
  const Light lamp = scene.lights[0];
  const Light sun{"sun", DirectionalLight{{0, -1, 0}}, Colour(1.0), 1.0};
  for (const Light& light : {lamp, sun}) {
    scene.lights = {light};
    scene.settings.shadows = Shadows::kThrough;
    CHECK(Middle(scene).x == doctest::Approx(1).epsilon(1e-6));
    CHECK(Middle(scene).y == doctest::Approx(0.25).epsilon(1e-6));
    CHECK(Middle(scene).z == doctest::Approx(0.0625).epsilon(1e-6));
    // What is only partly there takes less.
    Scene veiled = scene;
    veiled.materials[1].alpha = {AlphaMode::kBlend, 0.5, 0};
    CHECK(Middle(veiled).y == doctest::Approx(0.75 * 0.75).epsilon(1e-6));
    scene.settings.shadows = Shadows::kOpaque;
    CHECK(Middle(scene) == glm::dvec3(0.0));
    veiled.settings.shadows = Shadows::kOpaque;
    CHECK(Middle(veiled).y == doctest::Approx(0.25).epsilon(1e-6));
  }
  // Behind an opaque body all is dark, however much glass lies before it.
  Material wall;
  scene.settings.shadows = Shadows::kThrough;
  scene.materials.push_back(wall);
  scene.objects.push_back(FloorAt(4, 1, 2));
  CHECK(Middle(scene) == glm::dvec3(0.0));
}

// Two sheets, with what they shut in between.
Scene Slab(double thickness) {
  Scene scene = BallOverFloor();
  scene.materials[1].attenuation = {1, 0.5, 0.25};
  scene.materials[1].attenuation_distance = 2;
  Object under = FloorAt(1, 4, 1);
  std::swap(std::get<Quad>(under.shape).corners[1], std::get<Quad>(under.shape).corners[3]);
  scene.objects = {FloorAt(0, 5, 0), under, FloorAt(1 + thickness, 4, 1)};
  return scene;
}

TEST_CASE("a body takes light by its thickness") {
  for (const double thickness : {0.5, 2.0, 3.0}) {
    CAPTURE(thickness);
    Scene scene = Slab(thickness);
    const glm::dvec3 left(1, std::pow(0.5, thickness / 2), std::pow(0.25, thickness / 2));
    const Light lamp = scene.lights[0];
    for (const Light& light :
         {lamp, Light{"sun", DirectionalLight{{0, -1, 0}}, Colour(1.0), 1.0}}) {
      scene.lights = {light};
      const glm::dvec3 lit = Middle(scene);
      for (int i = 0; i < 3; ++i) CHECK(lit[i] == doctest::Approx(left[i]).epsilon(1e-5));
    }
    // Seen from above it is the floor, lit through the slab, through the slab.
    RenderOptions options;
    options.width = options.height = 1;
    const Camera above{"above", {0, 9, 0}, {0, 0, 0}, {0, 0, 1}, Orthographic{0.01}};
    const Film film = RenderOrFail(scene, above, options);
    for (int i = 0; i < 3; ++i) {
      CHECK(static_cast<double>(film.rgb[static_cast<std::size_t>(i)]) ==
            doctest::Approx(left[i] * left[i]).epsilon(1e-5));
    }
    // In other units of length the same picture.
    Scene small = scene;
    small.materials[1].attenuation_distance *= 0x1p-40;
    for (Object& object : small.objects) {
      for (Vec3d& corner : std::get<Quad>(object.shape).corners) corner *= 0x1p-40;
    }
    const Camera near{"near", {0, 9 * 0x1p-40, 0}, {0, 0, 0}, {0, 0, 1}, Orthographic{0x1p-47}};
    const Film scaled = RenderOrFail(small, near, options);
    for (int i = 0; i < 3; ++i) {
      CHECK(static_cast<double>(scaled.rgb[static_cast<std::size_t>(i)]) ==
            doctest::Approx(left[i] * left[i]).epsilon(1e-5));
    }
  }
}

TEST_CASE("shadows of glass have the same bits everywhere") {
  RenderOptions options;
  options.width = 61;
  options.height = 47;
  options.max_depth = 3;
  for (Scene scene : {BallOverFloor(), GlassAndMirrors(), EverythingScene(5), Slab(2)}) {
    for (Material& material : scene.materials) {
      if (material.transmit.x > 0) material.attenuation = {0.9, 0.5, 0.7};
    }
    options.precision = Precision::kStrict;
    CheckSameBits(scene, scene.cameras[0], options);
    options.precision = Precision::kDouble;
    CheckSameBits(scene, scene.cameras[0], options);
  }
}

TEST_CASE("scene files say whether shadows are opaque") {
  Scene scene = BallOverFloor();
  CHECK(SceneJsonText(scene).find("\"opaque\"") == std::string::npos);
  scene.settings.shadows = Shadows::kOpaque;
  scene.materials[1].attenuation = {0.25, 0.5, 1};
  scene.materials[1].attenuation_distance = 3;
  const Result<Scene> read = ParseSceneJson(SceneJsonText(scene), "x.json");
  REQUIRE(read.ok());
  CHECK(read.value().settings.shadows == Shadows::kOpaque);
  CHECK(read.value().materials[1].attenuation == Colour(0.25, 0.5, 1));
  CHECK(read.value().materials[1].attenuation_distance == 3);
  const Result<Scene> wrong =
      ParseSceneJson(R"({"settings": {"shadows": "soft"}, "cameras": []})", "x.json");
  REQUIRE(!wrong.ok());
  CHECK(wrong.error().message.find("/settings/shadows: expected \"through\" or \"opaque\"") !=
        std::string::npos);
}

}  // namespace
}  // namespace sheaf
