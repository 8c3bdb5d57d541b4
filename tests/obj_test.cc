// OBJ and MTL: what sound files become, and what is said of others.
#include <doctest/doctest.h>

#include <string>

#include "model_files.h"

namespace sheaf {
namespace {

const std::string kObj = R"(mtllib a.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
vt 0 0
vt 1 0
vt 1 1
vn 0 0 1
usemtl red
g square
f 1/1/1 2/2/1 3/3/1 4//1
usemtl glass
f -5 -4 -1
)";
const std::string kMtl =
    "newmtl red\nKd 1 0.5 0.25\nKs 0.5 0.5 0.5\nNs 20\nKe 0 0 0.5\nillum 2\n"
    "newmtl glass\nKd 1 1 1\nd 0.25\nNi 1.5\nillum 7\nKs 0.1 0.1 0.1\n";

TEST_CASE("OBJ and MTL") {
  const Folder folder;
  folder.Write("a.mtl", kMtl);
  const Scene scene = ReadOrFail(folder.Write("a.obj", kObj));
  REQUIRE(scene.materials.size() == 2);
  CHECK(std::get<Colour>(scene.materials[0].base_colour) == Colour(1, 0.5, 0.25));
  CHECK(scene.materials[0].emission == Colour(0, 0, 0.5));
  CHECK(scene.materials[0].shininess == 20);
  CHECK(scene.materials[0].reflect == Colour(0.0));
  CHECK(scene.materials[1].transmit.x == 0.75);
  CHECK(scene.materials[1].ior == 1.5);
  CHECK(scene.materials[1].reflect.x == doctest::Approx(0.1));
  REQUIRE(scene.objects.size() == 2);
  const Mesh& square = MeshAt(scene, 0);
  CHECK(square.triangles.size() == 2);
  CHECK(square.positions.size() == 4);  // corners are shared
  CHECK(square.normals.size() == 4);
  REQUIRE(square.uv.size() == 4);
  CHECK(square.uv[1] == glm::vec2(1, 1));  // v runs up in the file
  CHECK(MeshAt(scene, 1).positions[2] == glm::vec3(0, 0, 1));
  CHECK(scene.settings.transfer == Transfer::kSrgb);
  CheckSurvives(folder, "a.obj", kObj);
}

TEST_CASE("OBJ that is wrong") {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    CheckRefused(folder.Write("bad.obj", text), part);
  };
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  refused(triangle, "no face");
  refused(triangle + "f 1 2 4\n", ":4: vertex 4 of 3");
  refused(triangle + "f 1 2 0\n", ":4: expected the number of a vertex");
  refused(triangle + "f -1 -2 -4\n", ":4: vertex -4 of 3");
  refused(triangle + "f 1/1 2/1 3/1\n", ":4: texture coordinate 1 of 0");
  refused(triangle + "f 1//2 2//2 3//2\n", ":4: normal 2 of 0");
  refused(triangle + "f 1 2\n", ":4: a face of 2 corners");
  refused(triangle + "f 1 2 99999999999\n", ":4: expected the number");
  refused("v 0 nan 0\n", ":1: \"nan\" is not finite");
  refused("v 0 1e99 0\n", ":1: \"1e99\" is not finite");
  refused("v 0 0\n", ":1: 2 numbers of 3");
  refused("v 0 foo 0\n", ":1: expected a number, found \"foo\"");
  refused("mtllib ../secret.mtl\n" + triangle + "f 1 2 3\n", "outside the scene's folder");
  const auto missing = ReadScene(folder.Write("m.obj", "mtllib no.mtl\n" + triangle + "f 1 2 3\n"));
  REQUIRE(missing.ok());
  REQUIRE(missing.value().warnings.size() == 1);
  CHECK(missing.value().warnings[0].find("no.mtl") != std::string::npos);
  folder.Write("a.mtl", "newmtl a\nKd 1 x 1\n");
  const auto bad = ReadScene(folder.Write("b.obj", "mtllib a.mtl\n" + triangle + "f 1 2 3\n"));
  REQUIRE_FALSE(bad.ok());
  CHECK(bad.error().message ==
        (folder / "a.mtl") + ":2: Kd: expected a number in [-1e6, 1e9], found \"x\"");
}

TEST_CASE("OBJ: a line goes on after a backslash, and lines keep their numbers") {
  const Folder folder;
  const std::string vertices = "# C:\\\nv 0 0 0\nv 1 \\\n0 0\nv 0 \\\r\n1 \\\r\n0\n";
  const Scene scene = ReadOrFail(folder.Write("a.obj", vertices + "f 1 2 \\\n3\n"));
  CHECK(MeshAt(scene, 0).triangles.size() == 1);
  CHECK(MeshAt(scene, 0).positions.at(2) == glm::vec3(0, 1, 0));
  CheckRefused(folder.Write("b.obj", vertices + "f 1 2 9\n"), "b.obj:8: vertex 9 of 3");
}

TEST_CASE("OBJ: a material that the library lacks is a warning") {
  const Folder folder;
  folder.Write("a.mtl", "newmtl brick\nKd 1 0 0\n");
  const std::string path = folder.Write(
      "a.obj",
      "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl brik\nf 1 2 3\nusemtl brick\nf 1 2 3\n");
  const Result<ReadSceneResult> read = ReadScene(path);
  REQUIRE(read.ok());
  REQUIRE(read.value().warnings.size() == 1);
  CHECK(read.value().warnings[0] ==
        path + ":5: usemtl: no material \"brik\", so grey; did you mean \"brick\"?");
}

}  // namespace
}  // namespace sheaf
