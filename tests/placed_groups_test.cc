// Scenes of instances: the same bits on every target, and the picture of the copies that they stand
// for.
#include "src/scene/placed_groups.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "same_bits.h"
#include "scene_text.h"
#include "sheaf/render.h"
#include "src/formats/scene_json.h"
#include "src/formats/write_scene_json.h"

namespace sheaf {
namespace {

std::shared_ptr<const Image> Spots(bool has_holes) {
  Image image;
  image.width = image.height = 16;
  for (std::uint32_t i = 0; i < 256; ++i) {
    const std::uint32_t x = i % 16, y = i / 16, is_spot = (x / 4 + y / 4) % 2;
    const std::uint32_t alpha = has_holes && x % 8 < 2 ? 0x20u : 0xffu;
    image.texels.push_back(alpha << 24 | (0x30u + 9 * x) << 16 | (is_spot * 0xa0u) << 8 |
                           (0x40u + 11 * y));
  }
  return std::make_shared<const Image>(std::move(image));
}

// A ball of triangles with smooth normals, coordinates and colours.
Mesh Ball() {
  constexpr std::uint32_t kRings = 8, kSegments = 12;
  constexpr double kPi = 3.14159265358979323846;
  Mesh mesh;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    for (std::uint32_t segment = 0; segment <= kSegments; ++segment) {
      const double a = kPi * ring / kRings, b = 2 * kPi * segment / kSegments;
      const Vec3d p{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)};
      mesh.positions.push_back(glm::vec3(p));
      mesh.normals.push_back(glm::vec3(p));
      mesh.uv.push_back(
          {static_cast<float>(segment) / kSegments, static_cast<float>(ring) / kRings});
      mesh.colours.push_back({1.0f, 0.5f + 0.04f * static_cast<float>(segment), 0.8f});
      if (ring == kRings || segment == kSegments) continue;
      const std::uint32_t at = ring * (kSegments + 1) + segment, below = at + kSegments + 1;
      mesh.triangles.push_back({at, at + 1, below});
      mesh.triangles.push_back({at + 1, below + 1, below});
    }
  }
  return mesh;
}

Transform RandomTurn(Random& random, double size) {
  const Vec3d axis = ToGlm(RandomUnit(random));
  Transform turn = RotationAbout(axis, Uniform(random, 0, 360));
  turn.linear *= size;
  return turn;
}

Instance At(std::uint32_t group, const Transform& turn, const Vec3d& place) {
  return {"", group, turn.linear, place};
}

std::vector<Material> Materials() {
  std::vector<Material> materials(7);
  materials[0].base_colour = Checker{Colour(0.9), Colour(0.2), {8, 8}, true};
  materials[0].kd = 0.8;
  materials[1].base_colour = Texture{Spots(false)};
  materials[1].kd = 0.7, materials[1].ks = 0.3, materials[1].shininess = 20;
  materials[1].ambient = 0.2;
  materials[2].reflect = Colour(0.8), materials[2].kd = 0.1;
  materials[3].transmit = Colour(0.9), materials[3].ior = 1.5;
  materials[3].attenuation = Colour(0.5, 0.9, 0.9);
  materials[4].base_colour = Texture{Spots(true)};
  materials[4].kd = 0.9, materials[4].alpha.mode = AlphaMode::kBlend;
  materials[5].base_colour = Colour(0.3, 0.6, 0.2), materials[5].kd = 0.8;
  materials[5].normal_map = NormalMap{Texture{Spots(false)}, 0.3};
  std::get<Texture>(materials[1].base_colour).filter = Filter::kMip;
  materials[6].kd = 0.5, materials[6].emission = Colour(0.5, 0.4, 0.3);
  return materials;
}

// A floor, groups of everything, one of them made of the others; instances that keep spheres.
Scene Grove(Random& random) {
  Scene scene;
  scene.settings.width = 64, scene.settings.height = 48;
  scene.settings.background = Colour(0.3, 0.4, 0.6);
  scene.settings.max_depth = 4;
  scene.materials = Materials();
  scene.objects = {
      {"floor", Quad{{Vec3d{-12, -1, 12}, {12, -1, 12}, {12, -1, -12}, {-12, -1, -12}}}, 0}};
  Mesh bumpy = Ball();
  bumpy.colours.clear();
  scene.groups = {{"balls", {{"", Ball(), 1}, {"", Sphere{{0, 1.5, 0}, 0.5}, 2}}, {}},
                  {"round",
                   {{"", Sphere{{0, 0, 0}, 0.6}, 3}, {"", Disk{{0, -0.8, 0}, 0.8, {0.2, 1, 0}}, 6}},
                   {}},
                  {"leaf",
                   {{"", Quad{{Vec3d{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, 4},
                    {"", std::move(bumpy), 5}},
                   {}},
                  {"nested", {}, {}}};
  for (std::uint32_t i = 0; i < 3; ++i) {
    scene.groups[3].instances.push_back(
        At(i, RandomTurn(random, Uniform(random, 0.5, 1)), UniformPoint(random, -1, 1)));
  }
  for (int i = 0; i < 9; ++i) {
    Transform turn = RandomTurn(random, Uniform(random, 0.3, 1.2));
    if (i % 3 == 1) turn.linear[0] *= -1.0;  // a mirror
    const auto group = static_cast<std::uint32_t>(i % 4);
    scene.instances.push_back(
        At(group, turn, {Uniform(random, -5, 5), Uniform(random, 0, 3), Uniform(random, -6, 2)}));
  }
  Light sun, lamp;
  sun.source = DirectionalLight{{-0.4, -1, -0.3}};
  sun.intensity = 0.6;
  lamp.source = PointLight{{3, 6, 5}, {1, 0, 0.01}};
  lamp.intensity = 0.8;
  scene.lights = {sun, lamp};
  Camera camera;
  camera.eye = {0.5, 2, 9};
  camera.look_at = {0, 0.5, -1};
  camera.projection = Perspective{50};
  scene.cameras = {camera};
  return scene;
}

RenderOptions SizeOf(const Scene& scene) {
  RenderOptions options;
  options.width = scene.settings.width;
  options.height = scene.settings.height;
  return options;
}

// Pixels of which a channel differs by more than `much`.
int PixelsFarApart(const Film& a, const Film& b, float much) {
  int far = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    bool is_far = false;
    for (std::size_t c = 0; c < 3; ++c) is_far |= !(std::abs(a.rgb[i + c] - b.rgb[i + c]) <= much);
    far += is_far;
  }
  return far;
}

TEST_CASE("instances are the same bits on every target") {
  Random random(5);
  for (int round = 0; round < 2; ++round) {
    Scene scene = Grove(random);
    // Not only what copies could be: spheres become ellipsoids, meshes are sheared.
    for (std::size_t i = 0; i < scene.instances.size(); i += 2) {
      scene.instances[i].linear[1] += scene.instances[i].linear[0] * 0.4;
      scene.instances[i].linear[2] *= 1.7;
    }
    CheckSameBits(scene, scene.cameras[0], SizeOf(scene));
    RenderOptions options = SizeOf(scene);
    options.precision = Precision::kDouble;
    CheckSameBits(scene, scene.cameras[0], options);
  }
}

TEST_CASE("lights with a size, lenses and paths meet instances with the same bits") {
  Random random(6);
  Scene scene = Grove(random);
  scene.settings.width = 56, scene.settings.height = 44;
  scene.lights[1].source = SphereLight{{3, 6, 5}, 1};
  scene.lights[1].intensity = 20;
  scene.materials[2].roughness = 0.4;
  scene.cameras[0].lens = Lens{};
  RenderOptions options = SizeOf(scene);
  options.samples = 4;
  CheckSameBits(scene, scene.cameras[0], options);
  options.integrator = Integrator::kPath;
  CheckSameBits(scene, scene.cameras[0], options);
}

TEST_CASE("instances look like the copies that they stand for") {
  Random random(7);
  for (int round = 0; round < 3; ++round) {
    const Scene scene = Grove(random);
    const Result<Scene> flat = Flattened(scene);
    REQUIRE(flat.ok());
    CHECK(flat.value().objects.size() > 15);
    CHECK(flat.value().instances.empty());
    RenderOptions options = SizeOf(scene);
    options.precision = Precision::kDouble;
    const Film placed = RenderOrFail(scene, scene.cameras[0], options);
    const Film copied = RenderOrFail(flat.value(), scene.cameras[0], options);
    // Copies of meshes have vertices that were rounded to floats.
    CHECK(PixelsFarApart(placed, copied, 1e-3f) <= 12);
    Scene bare = scene;
    bare.instances.clear();
    const Film without = RenderOrFail(bare, scene.cameras[0], options);
    CHECK(PixelsFarApart(placed, without, 1e-2f) > 300);
  }
}

TEST_CASE("where a group lies far away from itself, its instance is as sharp") {
  Random random(8);
  Scene scene = Grove(random);
  const Film here = RenderOrFail(scene, scene.cameras[0], SizeOf(scene));
  // The group 1e7 off, and brought back.
  for (Group& group : scene.groups) {
    for (Object& object : group.objects) {
      if (auto* sphere = std::get_if<Sphere>(&object.shape)) sphere->center.x += 1e7;
      if (auto* disk = std::get_if<Disk>(&object.shape)) disk->center.x += 1e7;
    }
  }
  std::vector<Instance> kept;
  for (const Instance& instance : scene.instances) {
    if (instance.group == 1) kept.push_back(instance);
  }
  scene.instances = kept;
  for (Instance& instance : scene.instances) instance.translation -= instance.linear[0] * 1e7;
  Scene near = Grove(random = Random(8));
  near.instances.clear();
  for (Instance instance : kept) near.instances.push_back(instance);
  const Film far_off = RenderOrFail(scene, scene.cameras[0], SizeOf(scene));
  const Film beside = RenderOrFail(near, near.cameras[0], SizeOf(near));
  CHECK(PixelsFarApart(far_off, beside, 2e-3f) <= 6);
  CHECK(PixelsFarApart(here, beside, 1e-2f) > 200);
}

TEST_CASE("a scene file has groups and instances, and writing keeps them") {
  const std::string text = R"({
    "materials": [{"name": "m", "kd": 1}],
    "groups": [
      {"name": "twig", "objects": [{"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "m"}]},
      {"name": "tree", "objects": [], "instances": [
        {"group": "twig", "transform": {"translate": [0, 1, 0]}},
        {"name": "low", "group": "twig"}]}],
    "instances": [
      {"name": "oak", "group": "tree", "transform": [{"scale": [1, 2, 1]}, {"translate": [5, 0, 0]}]},
      {"group": "twig", "transform": {"rotate": {"axis": [0, 1, 0], "degrees": 90}}}],
    "cameras": [{"name": "c", "eye": [0, 0, 9], "look_at": [0, 0, 0]}]})";
  const Result<Scene> read = ParseSceneJson(text, "grove.json");
  if (!read.ok()) FAIL(read.error().message);
  const Scene& scene = read.value();
  REQUIRE(scene.groups.size() == 2);
  REQUIRE(scene.instances.size() == 2);
  CHECK(scene.objects.empty());
  CHECK(scene.groups[0].objects.size() == 1);
  CHECK(scene.instances[0].group == 1);
  CHECK(scene.instances[0].linear[1][1] == 2);
  CHECK(scene.instances[0].translation == Vec3d(5, 0, 0));
  const auto placed = PlaceGroups(scene);
  REQUIRE(placed.size() == 3);
  CHECK(CountPlacedGroups(scene) == 3);
  CHECK(placed[0].group == 0);
  CHECK(placed[0].to_world.translation == Vec3d(5, 2, 0));
  CHECK(placed[1].to_world.translation == Vec3d(5, 0, 0));
  const std::optional<Bounds> bounds = BoundsOf(scene);
  REQUIRE(bounds.has_value());
  CHECK(bounds->max == Vec3d(6, 4, 1));

  Scene named = scene;
  MakeNamesUnique(&named);
  const Result<Scene> again = ParseSceneJson(SceneJsonText(named), "again.json");
  if (!again.ok()) FAIL(again.error().message);
  CHECK(SceneJsonText(again.value()) == SceneJsonText(named));
  CHECK(again.value().groups[1].instances[1].name == "low");
}

std::string FaultOfText(const std::string& groups, const std::string& instances) {
  const Result<Scene> read = ParseSceneJson(
      "{\"materials\": [{\"name\": \"m\"}],\n\"groups\": [" + groups + "],\n\"instances\": [" +
          instances +
          "],\n\"cameras\": [{\"name\": \"c\", \"eye\": [0, 0, 9], \"look_at\": [0, 0, 0]}]}",
      "s.json");
  return read.ok() ? "" : read.error().message;
}

TEST_CASE("what is wrong with groups is said with its place") {
  CHECK(FaultOfText("{\"name\": \"a\"}", "{\"group\": \"a\"}").empty());
  CHECK(FaultOfText("{\"name\": \"a\"}", "{\"group\": \"b\"}").find("no group \"b\"") !=
        std::string::npos);
  CHECK(
      FaultOfText("{\"name\": \"a\", \"instances\": [{\"group\": \"a\"}]}", "").find("no group") !=
      std::string::npos);
  CHECK(FaultOfText("{\"name\": \"a\"}, {\"name\": \"a\"}", "").find("exists already") !=
        std::string::npos);
  CHECK(FaultOfText("{\"name\": \"a\"}",
                    "{\"group\": \"a\", \"transform\": {\"matrix\": [[1, 1, 0, 0], "
                    "[1, 1.0000001, 0, 0], [0, 0, 1, 0]]}}")
            .find("flattens") != std::string::npos);
  Scene scene;
  scene.instances.push_back({"x", 3, glm::dmat3(1.0), Vec3d(0.0)});
  const Status status = Validate(scene);
  REQUIRE(!status.ok());
  CHECK(status.error().message == "instance 0 \"x\": group 3 of 0");
  // Forty levels of two make more than anyone can count.
  scene.instances[0].group = 39;
  scene.groups.push_back({"leaf", {{"", Sphere{}, 0}}, {}});
  scene.materials.push_back({});
  for (std::uint32_t i = 1; i < 40; ++i) {
    scene.groups.push_back(
        {"",
         {},
         {{"", i - 1, glm::dmat3(1.0), Vec3d(0.0)}, {"", i - 1, glm::dmat3(1.0), Vec3d(1.0)}}});
  }
  const Status many = Validate(scene);
  REQUIRE(!many.ok());
  CHECK(many.error().message == "instances: more than 67108864 through all levels");
}

}  // namespace
}  // namespace sheaf
