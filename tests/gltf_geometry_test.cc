// Skins, morphs, primitives and files of glTF that are odd, and what is said of them.
#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "model_files.h"

namespace sheaf {
namespace {

// Of the square alone.
json OneSquare() {
  json gltf = SquareGltf();
  gltf["nodes"] = {{{"mesh", 0}}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  return gltf;
}

json& Primitive(json& gltf) { return gltf["meshes"][0]["primitives"][0]; }

Result<ReadSceneResult> Read(const json& gltf) {
  const Folder folder;
  return ReadScene(folder.Write("a.gltf", gltf.dump()));
}

Scene ReadQuietly(const json& gltf) {
  auto result = Read(gltf);
  CAPTURE(MessageOf(result));
  REQUIRE(result.ok());
  CHECK(result.value().warnings.empty());
  return std::move(result.value().scene);
}

// The one warning has this in it.
Scene ReadWarned(const json& gltf, const std::string& part) {
  auto result = Read(gltf);
  CAPTURE(part);
  CAPTURE(MessageOf(result));
  REQUIRE(result.ok());
  REQUIRE(result.value().warnings.size() == 1);
  CHECK(result.value().warnings[0].find(part) != std::string::npos);
  return std::move(result.value().scene);
}

TEST_CASE("a glTF skin stands where its joints do") {
  json gltf = OneSquare();
  Primitive(gltf)["attributes"]["JOINTS_0"] = AddFloats(gltf, std::vector<float>(16, 0), "VEC4", 4);
  std::vector<float> weights;
  for (int i = 0; i < 4; ++i) weights.insert(weights.end(), {0.5f, 0, 0, 0});
  Primitive(gltf)["attributes"]["WEIGHTS_0"] = AddFloats(gltf, weights, "VEC4", 4);
  // The joint stood at x = 1 when it was bound.
  const int bind = AddFloats(gltf, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, "MAT4", 1);
  gltf["skins"] = {{{"joints", {2}}, {"inverseBindMatrices", bind}}};
  gltf["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {50, 0, 0}}, {"scale", {9, 9, 9}}},
                   {{"translation", {0, 7, 0}}, {"children", {2}}},
                   {{"translation", {3, 0, 0}}, {"scale", {2, 2, 2}}}};
  gltf["scenes"] = {{{"nodes", {0, 1}}}};
  const Scene scene = ReadQuietly(gltf);
  CHECK(MeshAt(scene, 0).positions[0] == glm::vec3(1, 7, 0));  // 2 (0 - 1) + 3
  CHECK(MeshAt(scene, 0).positions[2] == glm::vec3(3, 9, 0));
  gltf["skins"][0]["joints"] = {9};
  CHECK_FALSE(Read(gltf).ok());
  gltf["skins"][0]["joints"] = {1, 2};
  CHECK_FALSE(Read(gltf).ok());  // one matrix for two joints
}

// So many triangles that copies of them are dearer than instances.
json ManyTriangles() {
  json gltf = OneSquare();
  std::vector<float> positions;
  for (int i = 0; i < 3 * 7000; ++i) {
    positions.insert(positions.end(), {i % 3 == 1 ? 1.0f : 0.0f, i % 3 == 2 ? 1.0f : 0.0f, 0.0f});
  }
  Primitive(gltf) = {{"attributes", {{"POSITION", AddFloats(gltf, positions, "VEC3", 3 * 7000)}}}};
  gltf["meshes"][0]["name"] = "many";
  return gltf;
}

TEST_CASE("glTF nodes share a mesh that is large") {
  json gltf = ManyTriangles();
  gltf["nodes"] = {{{"mesh", 0}, {"name", "a"}, {"translation", {5, 0, 0}}},
                   {{"mesh", 0}, {"scale", {2, 3, 4}}},
                   {{"mesh", 0}, {"rotation", {0, 0, 1, 0}}}};
  gltf["scenes"] = {{{"nodes", {0, 1, 2}}}};
  const Scene scene = ReadQuietly(gltf);
  CHECK(scene.objects.empty());
  REQUIRE(scene.groups.size() == 1);
  CHECK(scene.groups[0].name == "many");
  CHECK(std::get<Mesh>(scene.groups[0].objects.at(0).shape).triangles.size() == 7000);
  REQUIRE(scene.instances.size() == 3);
  CHECK(scene.instances[0].name == "a");
  CHECK(scene.instances[0].translation == Vec3d(5, 0, 0));
  CHECK(scene.instances[1].linear[2] == Vec3d(0, 0, 4));
  CHECK(scene.instances[2].linear[0] == Vec3d(-1, 0, 0));
  // Two of them are few enough for copies, and what flattens is always one.
  gltf["scenes"][0]["nodes"] = {0, 1};
  CHECK(ReadQuietly(gltf).instances.empty());
  gltf["scenes"][0]["nodes"] = {0, 1, 2};
  gltf["nodes"][1]["scale"] = {1, 1, 0};
  CHECK(ReadQuietly(gltf).instances.size() == 2);
}

TEST_CASE("glTF instances of a node stand where their attributes say") {
  json gltf = OneSquare();
  const json attributes = {{"TRANSLATION", AddFloats(gltf, {1, 2, 3, 4, 5, 6}, "VEC3", 2)},
                           {"ROTATION", AddFloats(gltf, {0, 0, 0, 1, 0, 0, 1, 0}, "VEC4", 2)},
                           {"SCALE", AddFloats(gltf, {1, 1, 1, 2, 2, 2}, "VEC3", 2)}};
  gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  gltf["nodes"][0]["translation"] = {10, 0, 0};
  gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = attributes;
  const Scene scene = ReadQuietly(gltf);
  CHECK(MeshAt(scene, 0).positions[2] == glm::vec3(12, 3, 3));
  CHECK(MeshAt(scene, 1).positions[2] == glm::vec3(12, 3, 6));  // half a turn, twice as large
  json& given = gltf["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  given["SCALE"] = AddFloats(gltf, {1, 1, 1}, "VEC3", 1);
  CHECK(MessageOf(Read(gltf)).find("SCALE has 1 elements, another 2") != std::string::npos);
  given = json::object();
  CHECK(MessageOf(Read(gltf)).find("has no attributes") != std::string::npos);
}

TEST_CASE("glTF morph targets move by their default weights") {
  json gltf = OneSquare();
  std::vector<float> steps(12, 0);
  steps[6] = 1, steps[7] = 2;
  Primitive(gltf)["targets"] = {{{"POSITION", AddFloats(gltf, steps, "VEC3", 4)}}};
  CHECK(MeshAt(ReadQuietly(gltf), 0).positions[2] == glm::vec3(1, 1, 0));
  gltf["meshes"][0]["weights"] = {1.0};
  CHECK(MeshAt(ReadQuietly(gltf), 0).positions[2] == glm::vec3(2, 3, 0));
  gltf["nodes"][0]["weights"] = {0.5};  // a node's own come first
  CHECK(MeshAt(ReadQuietly(gltf), 0).positions[2] == glm::vec3(1.5, 2, 0));
}

TEST_CASE("glTF files that another reader is for are named") {
  const Folder folder;
  CheckRefused(folder.Write("1.gltf", R"({"asset": {"version": "1.0"}, "meshes": {"m": {}}})"),
               "glTF 1.0");
  CheckRefused(folder.Write("old.gltf", R"({"meshes": {"m": {"primitives": []}}})"), "glTF 1.0");
  std::string binary = "glTF";
  for (const std::uint32_t number : {1u, 24u, 2u, 0u}) Put(binary, number, false);
  CheckRefused(folder.Write("1.glb", binary + "{}  "), "glTF 1.0");

  json draco = OneSquare();
  Primitive(draco)["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  draco["extensionsUsed"] = draco["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  CHECK(ReadQuietly(draco).objects.size() == 1);  // with the data beside it
  for (json& accessor : draco["accessors"]) accessor.erase("bufferView");
  CheckRefused(folder.Write("draco.gltf", draco.dump()), "KHR_draco_mesh_compression");

  json meshopt = OneSquare();
  meshopt["buffers"].push_back({{"byteLength", 48}});
  meshopt["bufferViews"][0] = {{"buffer", 1},
                               {"byteLength", 48},
                               {"extensions", {{"EXT_meshopt_compression", {{"buffer", 0}}}}}};
  CheckRefused(folder.Write("meshopt.gltf", meshopt.dump()), "EXT_meshopt_compression");
  meshopt["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 2}}}}}}});
  meshopt["nodes"].push_back({{"mesh", 4}});
  meshopt["scenes"][0]["nodes"] = {0, 1};
  CHECK(ReadWarned(meshopt, "EXT_meshopt_compression").objects.size() == 1);
}

TEST_CASE("glTF primitives that are not drawn") {
  json gltf = SquareGltf();
  gltf["meshes"][1]["primitives"][0]["mode"] = 1;
  gltf["meshes"][2]["primitives"][0]["mode"] = 0;
  CHECK(ReadWarned(gltf, "points and lines are not drawn (2 in all)").objects.size() == 2);
  json lines = OneSquare();
  Primitive(lines)["mode"] = 3;
  const Folder folder;
  CheckRefused(folder.Write("lines.gltf", lines.dump()), "points and lines are not drawn");

  json five = OneSquare();
  five["accessors"][1]["count"] = 5;
  CHECK(MeshAt(ReadWarned(five, "corners are left over"), 0).triangles.size() == 1);

  json wrong = OneSquare();
  Primitive(wrong)["attributes"]["POSITION"] =
      AddFloats(wrong, {0, 0, 0, 1, 0, 0, 1, 1, 0}, "VEC3", 3);  // index 3 is beyond them
  CHECK(MeshAt(ReadWarned(wrong, "corner that is no vertex"), 0).triangles.size() == 1);

  json infinite = OneSquare();
  const float far = std::numeric_limits<float>::infinity();
  Primitive(infinite)["attributes"]["POSITION"] =
      AddFloats(infinite, {0, 0, 0, far, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3", 4);
  const auto read = Read(infinite);
  REQUIRE(read.ok());
  CHECK(read.value().warnings.size() == 2);
  CHECK(MeshAt(read.value().scene, 0).triangles.size() == 1);
}

TEST_CASE("glTF vertices have an alpha where their material has one") {
  json gltf = OneSquare();
  std::vector<float> colours(16, 1);
  colours[7] = 0.5f, colours[11] = -1, colours[15] = 3;
  Primitive(gltf)["attributes"]["COLOR_0"] = AddFloats(gltf, colours, "VEC4", 4);
  const Scene opaque = ReadQuietly(gltf);
  CHECK(MeshAt(opaque, 0).colours.size() == 4);
  CHECK(MeshAt(opaque, 0).alphas.empty());
  for (const char* mode : {"BLEND", "MASK"}) {
    gltf["materials"][0]["alphaMode"] = mode;
    const Scene scene = ReadQuietly(gltf);
    const Alpha& alpha = scene.materials.at(0).alpha;
    CHECK(alpha.mode == (mode == std::string("MASK") ? AlphaMode::kMask : AlphaMode::kBlend));
    CHECK(alpha.factor == 1);
    CHECK(MeshAt(scene, 0).alphas == std::vector<float>{1, 0.5f, 0, 1});
  }
  colours = std::vector<float>(16, 1);
  Primitive(gltf)["attributes"]["COLOR_0"] = AddFloats(gltf, colours, "VEC4", 4);
  const Scene solid = ReadQuietly(gltf);
  CHECK(solid.materials.at(0).alpha.mode == AlphaMode::kOpaque);
  CHECK(MeshAt(solid, 0).alphas.empty());
}

TEST_CASE("the colours of unlit glTF vertices are said to be lost, their alpha is kept") {
  json gltf = OneSquare();
  const std::vector<float> colours(16, 0.5f);
  Primitive(gltf)["attributes"]["COLOR_0"] = AddFloats(gltf, colours, "VEC4", 4);
  gltf["materials"][0] = {{"alphaMode", "BLEND"},
                          {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  const Scene scene = ReadWarned(gltf, "colours of vertices");
  CHECK(MeshAt(scene, 0).colours.empty());
  CHECK(MeshAt(scene, 0).alphas == std::vector<float>(4, 0.5f));
}

TEST_CASE("glTF URIs are those of RFC 3986") {
  const Folder folder;
  json gltf = OneSquare();
  for (const auto& [uri, file] : {std::pair{"a+b.bin", "a+b.bin"},
                                  {"10%.bin", "10%.bin"},
                                  {"50%zz.bin", "50%zz.bin"},
                                  {"a%20b%2e.bin", "a b..bin"}}) {
    CAPTURE(uri);
    folder.Write(file, GltfBuffer());
    gltf["buffers"][0]["uri"] = uri;
    CHECK(ReadOrFail(folder.Write("a.gltf", gltf.dump())).objects.size() == 1);
  }
  gltf["buffers"][0]["uri"] = "%2e%2e/outside.bin";
  CheckRefused(folder.Write("a.gltf", gltf.dump()), "outside the scene's folder");
  gltf["buffers"][0]["uri"] = "data:;base64," + std::string(5000, '*');
  const auto broken = ReadScene(folder.Write("a.gltf", gltf.dump()));
  REQUIRE_FALSE(broken.ok());
  CHECK(broken.error().message.size() < 200);
  CHECK(broken.error().message.find("a data URI of 5013 characters") != std::string::npos);
}

}  // namespace
}  // namespace sheaf
