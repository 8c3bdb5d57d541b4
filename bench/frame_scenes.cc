#include "bench/frame_scenes.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bench/make_scenes.h"

namespace sheaf::bench {
namespace {

Vec3d ToVec3d(const float* v) { return {v[0], v[1], v[2]}; }

// Adds the triangles and spheres of `from`, each of one material.
void AddObjects(Scene& scene, const BenchScene& from, std::uint32_t triangles,
                std::uint32_t spheres) {
  for (std::size_t i = 0; i < from.indices.size(); i += 3) {
    const auto vertex = [&](std::size_t k) {
      return ToVec3d(&from.vertices[3 * std::size_t{from.indices[i + k]}]);
    };
    scene.objects.push_back({"", Triangle{{vertex(0), vertex(1), vertex(2)}}, triangles});
  }
  for (std::size_t i = 0; i < from.spheres.size(); i += 4) {
    const Sphere sphere{ToVec3d(&from.spheres[i]), from.spheres[i + 3]};
    scene.objects.push_back({"", sphere, spheres});
  }
}

Material Matt(std::string name, Colour colour, double kd) {
  Material material;
  material.name = std::move(name);
  material.base_colour = colour;
  material.kd = kd;
  return material;
}

Material Shiny(std::string name, Colour colour, double kd, double ks, double shininess) {
  Material material = Matt(std::move(name), colour, kd);
  material.ks = ks;
  material.shininess = shininess;
  return material;
}

void AddLights(Scene& scene, std::initializer_list<Vec3d> positions) {
  for (const Vec3d& position : positions) {
    Light light;
    light.name = "light " + std::to_string(scene.lights.size() + 1);
    light.source = PointLight{position, {1, 0, 0}};
    light.intensity = 1 / std::sqrt(static_cast<double>(positions.size()));
    scene.lights.push_back(light);
  }
}

// Haines's background, and no ambient light.
Scene NewFrame(int width, int height, const Camera& camera) {
  Scene scene;
  scene.settings.width = width;
  scene.settings.height = height;
  scene.settings.background = {0.078, 0.361, 0.753};
  scene.settings.ambient = Colour(0.0);
  scene.cameras = {camera};
  return scene;
}

Scene Balls() {
  Scene scene =
      NewFrame(1024, 1024, {"eye", {2.1, 1.3, 1.7}, {0, 0, 0}, {0, 0, 1}, Perspective{45}});
  Material mirror = Shiny("mirror", {1, 0.9, 0.7}, 0.5, 0.5, 3.0827);
  mirror.reflect = Colour(0.5);
  scene.materials = {Matt("ground", {1, 0.75, 0.33}, 0.8), mirror};
  AddObjects(scene, SphereFlake(4), 0, 1);
  AddLights(scene, {{4, 3, 2}, {1, -4, 4}, {-3, 1, 5}});
  return scene;
}

Scene Tetra() {
  Scene scene = NewFrame(1024, 1024,
                         {"eye",
                          {1.02285, -3.17715, -2.17451},
                          {-0.004103, -0.004103, 0.216539},
                          {-0.816497, -0.816497, 0.816497},
                          Perspective{45}});
  scene.materials = {Matt("red", {1, 0.2, 0.2}, 1)};
  AddObjects(scene, TetraPyramid(5), 0, 0);
  AddLights(scene, {{2, -18, -5}});
  return scene;
}

Scene Mount() {
  Scene scene =
      NewFrame(1024, 1024, {"eye", {-1.6, 1.6, 1.7}, {0, 0, 0}, {0, 0, 1}, Perspective{45}});
  Material glass = Shiny("glass", {1, 1, 1}, 0.1, 0.1, 101.148);
  glass.transmit = Colour(0.9);
  glass.ior = 1.5;
  scene.materials = {Matt("rock", {0.5, 0.45, 0.35}, 1), glass};
  AddObjects(scene, Mountain(64), 0, 0);
  for (const Vec3d& center :
       {Vec3d(-0.8, 0.8, 1.20821), Vec3d(-0.661196, 0.661196, 0.930598),
        Vec3d(-0.749194, 0.98961, 0.930598), Vec3d(-0.98961, 0.749194, 0.930598)}) {
    scene.objects.push_back({"", Sphere{center, 0.17}, 1});
  }
  AddLights(scene, {{-100, -100, 100}});
  return scene;
}

// A torus knot of 100,352 triangles behind a glass ball and a mirror ball, over a floor.
Scene Knot() {
  Scene scene =
      NewFrame(1280, 960, {"eye", {0, 1.2, 11.5}, {0, -0.6, 0}, {0, 1, 0}, Perspective{45}});
  scene.settings.ambient = scene.settings.background;
  Material clay = Shiny("clay", {0.9, 0.45, 0.25}, 0.7, 0.4, 40);
  clay.ambient = 0.15;
  Material glass = Shiny("glass", {1, 1, 1}, 0.02, 0.3, 200);
  glass.transmit = Colour(0.95);
  glass.ior = 1.5;
  Material mirror = Shiny("mirror", {0.8, 0.85, 0.9}, 0.1, 0.5, 100);
  mirror.reflect = Colour(0.8);
  Material floor = Matt("floor", {1, 1, 1}, 0.7);
  floor.base_colour = Checker{Colour(0.9), Colour(0.25), {20, 20}};
  floor.ambient = 0.15;
  scene.materials = {clay, glass, mirror, floor};
  AddObjects(scene, TorusKnot(), 0, 0);
  scene.objects.push_back({"", Sphere{{2.6, -2.1, 3.9}, 1.3}, 1});
  scene.objects.push_back({"", Sphere{{-3.4, -2.0, 2.4}, 1.5}, 2});
  scene.objects.push_back(
      {"", Quad{{Vec3d(-12, -3.6, 10), {12, -3.6, 10}, {12, -3.6, -14}, {-12, -3.6, -14}}}, 3});
  AddLights(scene, {{8, 12, 9}, {-9, 7, 6}, {1, 15, -4}});
  return scene;
}

constexpr FrameScene kScenes[] = {
    {"balls", "7,381 mirror spheres over a ground, three lights", Balls},
    {"tetra", "a tetrahedral pyramid of 4,096 triangles, one light", Tetra},
    {"mount", "a mountain of 8,192 triangles under four glass spheres, one light", Mount},
    {"knot", "a torus knot of 100,352 triangles, a glass and a mirror ball, three lights", Knot},
};

}  // namespace

std::span<const FrameScene> FrameScenes() { return kScenes; }

}  // namespace sheaf::bench
