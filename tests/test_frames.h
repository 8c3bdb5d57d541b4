// Scenes that whole frames are tested with.
#ifndef SHEAF_TESTS_TEST_FRAMES_H_
#define SHEAF_TESTS_TEST_FRAMES_H_

#include <doctest/doctest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "random_scene.h"
#include "src/formats/scene_json.h"

namespace sheaf {

// Of the project's own, in scenes/.
inline Scene SceneNamed(const std::string& name) {
  Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/" + name + ".json");
  REQUIRE(scene.ok());
  return std::move(scene).value();
}
inline Scene CrystalBall() { return SceneNamed("crystal-ball"); }
inline Scene SoftScene() { return SceneNamed("soft-light"); }

// A scene with everything at once: several mirrors and glasses, so that several materials spawn
// rays at one depth, triangles seen from both sides, every kind of light, overlapping and
// coincident objects.
inline Scene EverythingScene(std::uint64_t seed) {
  Random random(seed);
  Scene scene = RandomScene(random, 14);
  const auto colour = [&] { return UniformPoint(random, 0, 1); };
  scene.materials.clear();
  for (int i = 0; i < 6; ++i) {
    Material material;
    material.name = std::to_string(i);
    if (i % 2) {
      material.base_colour = Checker{colour(), colour(), {Uniform(random, 1, 9), 5}};
    } else {
      material.base_colour = colour();
    }
    material.ambient = 0.2;
    material.kd = i == 4 ? 0 : 0.6;
    material.ks = i == 3 ? 0 : 0.4;
    material.shininess = i == 2 ? 11.1434 : 60;
    if (i == 1 || i == 4) material.reflect = colour() * 0.7;
    if (i >= 4) material.transmit = colour() * 0.8;
    material.ior = i == 4 ? 1.5 : 0.8;
    scene.materials.push_back(material);
  }
  for (Object& object : scene.objects) object.material = static_cast<std::uint32_t>(random() % 6);
  // Smooth triangles with colours: glass, and one with a texture.
  auto image = std::make_shared<Image>(Image{"", 5, 3, {}});
  for (int i = 0; i < 15; ++i) image->texels.push_back(static_cast<std::uint32_t>(random()));
  Material textured = scene.materials[0];
  textured.base_colour =
      Texture{image, Transfer::kSrgb, Wrap::kMirror, Wrap::kRepeat, Filter::kLinear, colour()};
  textured.emission = colour() * 0.1;
  scene.materials.push_back(textured);
  for (const std::uint32_t material : {6, 4}) {
    scene.objects.push_back({"", RandomMesh(random, 8), material});
  }
  scene.lights = {
      {"near", PointLight{UniformPoint(random, -6, 6), {0, 0, 1}}, {1, 1, 0.9}, 20},
      {"far", PointLight{{3000, 4000, 5000}, {1, 0, 0}}, {0.5, 0.6, 1}, 0.5},
      {"general", PointLight{{2, 7, 3}, {1, 0.1, 0.01}}, {1, 0.5, 0.5}, 1},
      {"sun", DirectionalLight{{-1, -2, -3}}, {0.3, 0.3, 0.3}, 1},
      {"soft", DirectionalLight{{1, -1, 0.5}}, {0.2, 0.2, 0.2}, 1, false},
      {"spot", PointLight{{4, 5, 6}, {0, 0, 1}, Cone{{-4, -5, -6}, 5, 30}}, {1, 1, 1}, 40}};
  scene.settings.background = {0.1, 0.2, 0.3};
  Camera camera{"eye", UniformPoint(random, 7, 9), {0, 0, 0}, {0, 1, 0}, Perspective{50}};
  Camera flat{"flat", {0, 0, 9}, {0, 0, 0}, {0, 1, 0}, Orthographic{9}};
  Camera inside{"inside", {0.1, 0.2, 0.1}, {3, 1, 0}, {0, 1, 0}, Perspective{90}};
  scene.cameras = {camera, flat, inside};
  return scene;
}

// Two glasses and a mirror side by side, so that rays of one pixel leave different materials at one
// depth: the order in which their children are added is then not that of the materials.
inline Scene GlassAndMirrors() {
  Random random(9);
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    Material material;
    material.base_colour = UniformPoint(random, 0.2, 1);
    material.ambient = 0.3;
    material.kd = 0.3;
    if (i < 2) material.transmit = Colour(0.9, 0.8, 0.7);
    if (i > 0) material.reflect = Colour(0.1, 0.15, 0.2) * static_cast<double>(i);
    material.ior = i == 0 ? 1.5 : 1.2;
    scene.materials.push_back(material);
  }
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = 0; z < 3; ++z) {
        const auto material = static_cast<std::uint32_t>(random() % 3);
        scene.objects.push_back({"", Sphere{{x * 0.9, y * 0.9, z * -0.9}, 0.5}, material});
      }
    }
  }
  scene.lights = {{"key", PointLight{{5, 8, 9}, {1, 0, 0}}, {1, 0.9, 0.8}, 1}};
  scene.settings.background = {0.3, 0.4, 0.7};
  scene.cameras = {{"c", {0.3, 0.2, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{55}}};
  return scene;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_TEST_FRAMES_H_
