// Animations of glTF files, and cameras on paths.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model_files.h"
#include "same_bits.h"
#include "src/formats/decoded_images.h"
#include "src/formats/png.h"
#include "src/formats/read_scene.h"

namespace sheaf {
namespace {

// The square on a node that one channel moves by these keys.
json Animated(const char* property, const std::string& interpolation,
              const std::vector<float>& times, const std::vector<float>& outputs,
              const char* shape) {
  json gltf = SquareGltf();
  gltf["nodes"] = {{{"mesh", 0}}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  const int input = AddFloats(gltf, times, "SCALAR", static_cast<int>(times.size()));
  gltf["accessors"][static_cast<std::size_t>(input)]["min"] = {times.front()};
  gltf["accessors"][static_cast<std::size_t>(input)]["max"] = {times.back()};
  const int width = std::string(shape) == "SCALAR" ? 1 : shape[3] - '0';
  const int output = AddFloats(gltf, outputs, shape, static_cast<int>(outputs.size()) / width);
  gltf["animations"] = {
      {{"name", "move"},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", property}}}}}}}};
  return gltf;
}

Result<ReadSceneResult> ReadAt(const json& gltf, std::optional<double> time,
                               const std::string& animation = "") {
  const Folder folder;
  ReadOptions options;
  options.time = time;
  options.animation = animation;
  return ReadScene(folder.Write("a.gltf", gltf.dump()), options);
}

// Where the square's corner number `corner` is.
Vec3d CornerAt(const json& gltf, std::optional<double> time, std::size_t corner) {
  const auto read = ReadAt(gltf, time);
  CAPTURE(MessageOf(read));
  REQUIRE(read.ok());
  CHECK(read.value().warnings.empty());
  return Vec3d(MeshAt(read.value().scene, 0).positions[corner]);
}

void CheckNear(const Vec3d& a, const Vec3d& b) {
  CAPTURE(a.x);
  CAPTURE(a.y);
  CAPTURE(a.z);
  CHECK(glm::length(a - b) < 1e-6);
}

TEST_CASE("glTF translations: steps, lines and cubics, and none before and after") {
  const std::vector<float> times = {1, 2, 4}, places = {0, 0, 0, 2, 0, 0, 2, 8, 0};
  json gltf = Animated("translation", "LINEAR", times, places, "VEC3");
  CHECK(ReadAt(gltf, std::nullopt).value().duration == 4);
  CheckNear(CornerAt(gltf, std::nullopt, 0), {0, 0, 0});
  CheckNear(CornerAt(gltf, -3, 0), {0, 0, 0});
  CheckNear(CornerAt(gltf, 1.5, 0), {1, 0, 0});
  CheckNear(CornerAt(gltf, 2, 0), {2, 0, 0});
  CheckNear(CornerAt(gltf, 2.5, 0), {2, 2, 0});
  CheckNear(CornerAt(gltf, 99, 0), {2, 8, 0});
  gltf = Animated("translation", "STEP", times, places, "VEC3");
  CheckNear(CornerAt(gltf, 1.99, 0), {0, 0, 0});
  CheckNear(CornerAt(gltf, 2, 0), {2, 0, 0});
  // The tangents are of one second; this span has two.
  gltf = Animated("translation", "CUBICSPLINE", {0, 2},
                  {9, 9, 9, 0, 0, 0, 3, 0, 0, 0, -3, 0, 4, 0, 0, 9, 9, 9}, "VEC3");
  CheckNear(CornerAt(gltf, 0, 0), {0, 0, 0});
  CheckNear(CornerAt(gltf, 1, 0), {2 + 0.125 * 2 * 3, 0.125 * 2 * 3, 0});
  CheckNear(CornerAt(gltf, 2, 0), {4, 0, 0});
}

TEST_CASE("glTF rotations go the shorter way on the sphere, scales are lines") {
  const float h = std::sqrt(0.5f);
  json gltf = Animated("rotation", "LINEAR", {0, 3}, {0, 0, 0, 1, 0, 0, -h, -h}, "VEC4");
  // The second is a quarter turn about z, with its sign turned: the shorter way all the same.
  for (const double time : {0.0, 0.3, 1.0, 2.9, 3.0}) {
    const double angle = time / 3 * std::acos(0.0);
    CheckNear(CornerAt(gltf, time, 1), {std::cos(angle), std::sin(angle), 0});
  }
  gltf = Animated("rotation", "CUBICSPLINE", {0, 1},
                  {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, h, h, 0, 0, 0, 0}, "VEC4");
  CheckNear(CornerAt(gltf, 0.5, 1),
            {std::cos(std::acos(0.0) / 2), std::sin(std::acos(0.0) / 2), 0});
  gltf = Animated("scale", "LINEAR", {0, 1}, {1, 1, 1, 3, 1, 1}, "VEC3");
  CheckNear(CornerAt(gltf, 0.25, 1), {1.5, 0, 0});
}

TEST_CASE("glTF weights of morph targets, two a key") {
  json gltf = Animated("weights", "LINEAR", {0, 1}, {0, 0, 1, 0.5}, "SCALAR");
  const auto target = [&](float x, float z) {
    std::vector<float> steps;
    for (int i = 0; i < 4; ++i) steps.insert(steps.end(), {x, 0, z});
    return json{{"POSITION", AddFloats(gltf, steps, "VEC3", 4)}};
  };
  const json targets = {target(4, 0), target(0, 8)};
  gltf["meshes"][0]["primitives"][0]["targets"] = targets;
  CheckNear(CornerAt(gltf, 0, 0), {0, 0, 0});
  CheckNear(CornerAt(gltf, 0.5, 0), {2, 0, 2});
  CheckNear(CornerAt(gltf, 1, 0), {4, 0, 4});
}

TEST_CASE("glTF animations by name, several at once, and bad ones") {
  json gltf = Animated("translation", "LINEAR", {0, 1}, {0, 0, 0, 4, 0, 0}, "VEC3");
  json other = gltf["animations"][0];
  other["name"] = "grow";
  other["channels"][0]["target"]["path"] = "scale";
  gltf["animations"].push_back(other);
  const auto corner = [](const Result<ReadSceneResult>& read) {
    CAPTURE(MessageOf(read));
    REQUIRE(read.ok());
    return Vec3d(MeshAt(read.value().scene, 0).positions[1]);
  };
  CheckNear(corner(ReadAt(gltf, 0.5)), {2 + 2, 0, 0});  // both: 2 + 2 * 1
  CheckNear(corner(ReadAt(gltf, 0.5, "grow")), {2, 0, 0});
  const auto unknown = ReadAt(gltf, std::nullopt, "mov");
  REQUIRE_FALSE(unknown.ok());
  CHECK(unknown.error().message.find("no animation \"mov\"; did you mean \"move\"?") !=
        std::string::npos);
  // Of two that move one thing the first counts.
  gltf["animations"][1]["channels"][0]["target"]["path"] = "translation";
  const auto twice = ReadAt(gltf, 0.5);
  CheckNear(corner(twice), {3, 0, 0});
  REQUIRE(twice.value().warnings.size() == 1);
  CHECK(twice.value().warnings[0].find("what another one moves") != std::string::npos);

  const auto refused = [&](const std::vector<float>& times, const std::vector<float>& outputs,
                           const std::string& part) {
    const json bad = Animated("translation", "LINEAR", times, outputs, "VEC3");
    const auto read = ReadAt(bad, 0.5);
    REQUIRE_FALSE(read.ok());
    CAPTURE(read.error().message);
    CHECK(read.error().message.find("/animations/0: " + part) != std::string::npos);
    CHECK(ReadAt(bad, std::nullopt).ok());  // nothing is read of it at rest
  };
  refused({0, 1}, {0, 0, 0}, "a sampler of 2 keys has 3 numbers of translation");
  refused({1, 1}, {0, 0, 0, 4, 0, 0}, "its times do not ascend");
  refused({0, 1}, {0, 0, 0, std::nanf(""), 0, 0}, "a number is not finite");
  const json far = Animated("translation", "LINEAR", {0, 1}, {0, 0, 0, 4, 0, 0}, "VEC3");
  const Folder folder;
  ReadOptions options;
  options.time = 0.5;
  for (std::size_t size = 0; size < far.dump().size(); size += 41) {
    json changed = far;
    std::string text = far.dump();
    text[size] = static_cast<char>('0' + size % 10);
    const auto read = ReadScene(folder.Write("changed.gltf", text), options);
    if (!read) CHECK(read.error().message.find('\n') == std::string::npos);
  }
}

TEST_CASE("images are decoded once for all moments, and again where a file changed") {
  const Folder folder;
  json gltf = Animated("translation", "LINEAR", {0, 1}, {0, 0, 0, 4, 0, 0}, "VEC3");
  gltf["images"] = {{{"uri", "red.png"}}};
  gltf["textures"] = {{{"source", 0}}};
  gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  json& primitive = gltf["meshes"][0]["primitives"][0];
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_0"] = AddFloats(gltf, std::vector<float>(8), "VEC2", 4);
  folder.Write("red.png", kRedPng);
  const std::string path = folder.Write("a.gltf", gltf.dump());
  DecodedImages images;
  const auto read_at = [&](double time) {
    ReadOptions options;
    options.time = time;
    auto read = ReadScene(path, options, images);
    REQUIRE(read.ok());
    CHECK(read.value().warnings.empty());
    return std::move(read.value().scene);
  };
  const auto image_in = [](const Scene& scene) {
    return std::get<Texture>(scene.materials.at(0).base_colour).image;
  };
  const std::shared_ptr<const Image> first = image_in(read_at(0));
  const Scene later = read_at(0.5);
  CheckNear(Vec3d(MeshAt(later, 0).positions[0]), {2, 0, 0});
  CHECK(image_in(later) == first);
  CHECK(first->name == "red.png");
  REQUIRE(WritePng({1, 1, {0, 0, 255}}, Transfer::kLinear, folder / "red.png").ok());
  CHECK(image_in(read_at(0.5))->texels[0] == 0xffff0000u);
  folder.Write("red.png", "no image");
  ReadOptions rest;
  const auto broken = ReadScene(path, rest, images);
  REQUIRE(broken.ok());
  CHECK(broken.value().warnings.size() == 1);
}

TEST_CASE("a camera passes through its keys, smoothly, and rests where they do") {
  Camera camera{"c", {0, 0, 9}, {0, 0, 0}, {0, 1, 0}, Perspective{40}};
  CHECK(CameraAt(camera, 5).eye == camera.eye);
  camera.path = {{0, {0, 0, 9}, {0, 0, 0}, 40},
                 {10, {9, 0, 0}, {0, 0, 0}, 20},
                 {30, {0, 3, -9}, {0, 0, 0}, 20},
                 {40, {0, 3, -9}, {0, 5, 0}, 20}};
  for (const CameraKey& key : camera.path) {
    const Camera at = CameraAt(camera, key.frame);
    CHECK(at.eye == key.eye);
    CHECK(at.look_at == key.look_at);
    CHECK(std::get<Perspective>(at.projection).fov_y == key.lens);
    CHECK(at.path.empty());
  }
  CHECK(CameraAt(camera, -7).eye == camera.path.front().eye);
  CHECK(CameraAt(camera, 99).eye == camera.path.back().eye);
  CHECK(std::get<Perspective>(CameraAt(camera, 2.5).projection).fov_y == 35);
  CHECK(CameraAt(camera, 33).eye == camera.path[3].eye);
  CHECK(CameraAt(camera, 20).look_at == Vec3d(0, 0, 0));
  // Speed is the same on both sides of a key: it goes as straight as a line there.
  const double step = 1e-4;
  const Vec3d before = (CameraAt(camera, 10).eye - CameraAt(camera, 10 - step).eye) / step;
  const Vec3d after = (CameraAt(camera, 10 + step).eye - CameraAt(camera, 10).eye) / step;
  CHECK(glm::length(before) > 0.3);
  CHECK(glm::length(after - before) < 1e-3);
  // A line between two keys alone.
  camera.path.resize(2);
  CHECK(glm::length(CameraAt(camera, 2.5).eye - Vec3d(2.25, 0, 6.75)) < 1e-12);
}

TEST_CASE("a camera whose path is out of order is refused") {
  Camera camera{"c", {0, 0, 9}, {0, 0, 0}, {0, 1, 0}, Perspective{40}};
  camera.path = {{3, {0, 0, 9}, {0, 0, 0}, 40}, {3, {0, 0, 9}, {0, 0, 0}, 40}};
  CHECK(Validate(camera).error().message == "camera 0 \"c\": path is not in order");
  camera.path[1].frame = 4;
  CHECK(Validate(camera).ok());
  camera.path[1].lens = 180;
  CHECK(Validate(camera).error().message.find("path.lens") != std::string::npos);
}

}  // namespace
}  // namespace sheaf
