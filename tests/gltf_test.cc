// glTF: what sound files become, and what is said of others.
#include <doctest/doctest.h>

#include <cstring>
#include <functional>
#include <string>

#include "model_files.h"
#include "same_bits.h"

namespace sheaf {
namespace {

// The same as .glb.
std::string Glb(json gltf) {
  std::string binary = GltfBuffer();
  gltf["buffers"][0].erase("uri");
  std::string text = gltf.dump();
  while (text.size() % 4) text += ' ';
  while (binary.size() % 4) binary += '\0';
  std::string bytes = "glTF";
  Put(bytes, std::uint32_t{2}, false);
  Put(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()), false);
  Put(bytes, static_cast<std::uint32_t>(text.size()), false);
  bytes += "JSON" + text;
  Put(bytes, static_cast<std::uint32_t>(binary.size()), false);
  bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

TEST_CASE("glTF, as text and as .glb") {
  const Folder folder;
  const std::string text = folder.Write("a.gltf", SquareGltf().dump());
  for (const std::string& path : {text, folder.Write("a.glb", Glb(SquareGltf()))}) {
    const Scene scene = ReadOrFail(path);
    REQUIRE(scene.objects.size() == 4);
    CHECK(scene.objects[0].name == "square");
    CHECK(MeshAt(scene, 0).triangles ==
          std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
    CHECK(MeshAt(scene, 0).positions[3] == glm::vec3(10, 3, 2));  // scaled, then moved
    CHECK(MeshAt(scene, 1).triangles ==
          std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {1, 3, 2}});
    CHECK(MeshAt(scene, 1).positions[3] == glm::vec3(10, 2, 0));  // the sparse one
    CHECK(MeshAt(scene, 2).triangles ==
          std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}});
    CHECK(MeshAt(scene, 2).positions[1] == glm::vec3(15, 7, 7));  // (1, 0, 0) turned to y
    CHECK(MeshAt(scene, 3).positions == std::vector<glm::vec3>{{10, 0, 0}, {11, 0, 0}, {10, 1, 0}});
    CHECK(std::get<Colour>(scene.materials[0].base_colour) == Colour(1, 0.5, 0.25));

    REQUIRE(scene.cameras.size() == 2);
    CHECK(scene.cameras[0].name == "front");
    CHECK(scene.cameras[0].look_at == Vec3d(0, 0, 7));
    CHECK(std::get<Perspective>(scene.cameras[0].projection).fov_y == doctest::Approx(57.29578));
    CHECK(scene.cameras[1].look_at.x == doctest::Approx(19));
    CHECK(std::get<Orthographic>(scene.cameras[1].projection).height == 3);
    REQUIRE(scene.lights.size() == 3);
    CHECK(std::get<PointLight>(scene.lights[0].source).position == Vec3d(1, 2, 3));
    CHECK(scene.lights[0].intensity == doctest::Approx(30 / 3.14159265358979));  // candela
    CHECK(std::get<DirectionalLight>(scene.lights[1].source).direction == Vec3d(0, 0, -1));
    const auto cone = std::get<PointLight>(scene.lights[2].source).cone;
    REQUIRE(cone.has_value());
    CHECK(cone->outer == doctest::Approx(28.6479));
    RenderOptions options;
    options.width = 64, options.height = 48;
    for (const Camera& camera : scene.cameras) CheckSameBits(scene, camera, options);
  }
  CheckSurvives(folder, "a.glb", Glb(SquareGltf()));
  CheckSurvives(folder, "a.gltf", SquareGltf().dump());
}

TEST_CASE("glTF that is wrong") {
  const Folder folder;
  const auto refused = [&](const std::function<void(json&)>& change, const std::string& part) {
    json gltf = SquareGltf();
    change(gltf);
    CheckRefused(folder.Write("bad.gltf", gltf.dump()), part);
  };
  refused([](json& g) { g["extensionsRequired"] = {"EXT_nobody_knows"}; }, "EXT_nobody_knows");
  refused([](json& g) { g["accessors"][1]["count"] = 60; }, "/accessors/1");
  refused([](json& g) { g["accessors"][0]["count"] = 2147483648u; }, "/accessors/0");
  refused([](json& g) { g["accessors"][0]["bufferView"] = 77; }, "/accessors/0");
  refused([](json& g) { g["bufferViews"][0]["buffer"] = 5; }, "/bufferViews/0");
  refused([](json& g) { g["bufferViews"][0]["byteLength"] = 9999; }, "/accessors/0");
  refused([](json& g) { g["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 44; },
          "/accessors/44");
  refused([](json& g) { g["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 1; },
          "/accessors/1: its type");
  refused([](json& g) { g["meshes"][0]["primitives"][0]["material"] = 3; },
          "/meshes/0/primitives/0: material 3 of 1");
  refused([](json& g) { g["nodes"][2]["children"] = {0}; }, "cycles");
  refused([](json& g) { g["nodes"][0]["children"] = {1, 1}; }, "/nodes/1");
  refused([](json& g) { g["nodes"][0]["children"] = {99}; }, "/nodes/99");
  refused([](json& g) { g["nodes"][1]["mesh"] = 9; }, "mesh 9 of 4");
  refused([](json& g) { g["nodes"][5]["camera"] = 9; }, "camera 9 of 2");
  refused([](json& g) { g["cameras"][0]["perspective"]["yfov"] = 4.0; }, "/cameras/0");
  refused([](json& g) { g["accessors"][3]["sparse"]["count"] = 5; }, "/accessors/3");
  refused([](json& g) { g["buffers"][0]["uri"] = "../outside.bin"; }, "outside the scene's folder");
  refused([](json& g) { g["buffers"][0]["uri"] = "missing.bin"; }, "");
  refused([](json& g) { g["scenes"][0]["nodes"] = {5}; }, "no mesh");
  const std::string deep = R"({"asset": {"version": "2.0"}, "extras": )" +
                           std::string(200000, '[') + std::string(200000, ']') + "}";
  CheckRefused(folder.Write("deep.gltf", deep), "nest deeper");
  const auto used = [&] {
    json gltf = SquareGltf();
    gltf["extensionsUsed"].push_back("EXT_nobody_knows");
    return ReadScene(folder.Write("used.gltf", gltf.dump()));
  }();
  REQUIRE(used.ok());
  REQUIRE(used.value().warnings.size() == 1);
  CHECK(used.value().warnings[0].find("EXT_nobody_knows") != std::string::npos);
}

}  // namespace
}  // namespace sheaf
