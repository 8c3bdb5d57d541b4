// OBJ and MTL: what sound files become, and what is said of others.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "model_files.h"
#include "src/formats/write_scene_json.h"

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
  refused(triangle + "f 1 2\n", ":4: a face of 2 corners");
  refused(triangle + "f 1 2 99999999999\n", ":4: expected the number");
  refused("v 0 nan 0\n", ":1: \"nan\" is not finite");
  refused("v 0 1e99 0\n", ":1: \"1e99\" is not finite");
  refused("v 0 0\n", ":1: 2 numbers of 3");
  refused("v 0 foo 0\n", ":1: expected a number, found \"foo\"");
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

// ---- What is lost is said, and the rest is read ----

const std::string kSquareObj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// The only object, and the only warning where there is one.
struct Lossy {
  Mesh mesh;
  std::string warning;
};
Lossy ReadLossy(const Folder& folder, const std::string& text) {
  CAPTURE(text);
  const Result<ReadSceneResult> read = ReadScene(folder.Write("a.obj", text));
  CAPTURE(MessageOf(read));
  REQUIRE(read.ok());
  REQUIRE(read.value().scene.objects.size() == 1);
  const std::vector<std::string>& warnings = read.value().warnings;
  REQUIRE(warnings.size() <= 1);
  const std::string place = folder / "a.obj:";
  if (!warnings.empty()) REQUIRE(warnings[0].starts_with(place));
  return {MeshAt(read.value().scene, 0), warnings.empty() ? "" : warnings[0].substr(place.size())};
}

TEST_CASE("OBJ: what is not sound is left out") {
  const Folder folder;
  const auto left_out = [&](const std::string& text, const std::string& warning) {
    const Lossy read = ReadLossy(folder, kSquareObj + text);
    CHECK(read.warning == warning);
    CHECK(read.mesh.triangles.size() == 2);
    CHECK(read.mesh.positions.size() == 4);
    CHECK(read.mesh.normals.empty());
    CHECK(read.mesh.uv.empty());
  };
  left_out("f 1 2\nf 1 2 3 4\n", "5: face left out: a face of 2 corners");
  left_out("f 1 2 3 4\nf 1 2 9\nf 1 2 8\n", "6: face left out: vertex 9 of 4 (2 in all)");
  left_out("f 1 2 3 4\nf 1 x 3\nf -5 1 2\n",
           "6: face left out: expected the number of a vertex, found \"x\" (2 in all)");
  left_out("f 1//1 2//2 3//3 4//4\n", "5: normal left out: normal 1 of 0 (4 in all)");
  left_out("f 1/1 2/1 3/1 4/1\n",
           "5: texture coordinate left out: texture coordinate 1 of 0 (4 in all)");
  left_out("vn nan 0 1\nf 1//1 2//1 3//1 4//1\n",
           "5: normal left out: \"nan\" is not finite, or beyond 1e30");
  left_out("vt x 0\nf 1/1 2/1 3/1 4/1\n",
           "5: texture coordinate left out: expected a number, found \"x\"");
  left_out("f 1 2 3 4\nl 1 2\np 3\n", "6: points and lines are passed over (2 in all)");
  left_out("f 1 2 3 4\nsurf 0 1 0 1 1 2 3 4\n", "6: curves and surfaces are passed over");
  left_out("s 1\nf 1 2 3 4\n", "5: smoothing groups are not read: faces are flat");
  left_out("s off\nf 1 2 3 4\n", "");
}

TEST_CASE("OBJ: a vertex that is not sound takes its faces along, and keeps its number") {
  const Folder folder;
  const auto read =
      ReadScene(folder.Write("a.obj", "v 0 1e99 0\n" + kSquareObj + "f 2 3 4\nf 1 2 3\nf 2 4 5\n"));
  REQUIRE(read.ok());
  CHECK(MeshAt(read.value().scene, 0).triangles.size() == 2);
  CHECK(MeshAt(read.value().scene, 0).positions.back() == glm::vec3(0, 1, 0));
  REQUIRE(read.value().warnings.size() == 2);
  CHECK(read.value().warnings[0].ends_with(
      ":1: vertex left out: \"1e99\" is not finite, or beyond 1e30"));
  CHECK(read.value().warnings[1].ends_with(":7: face left out: vertex 1 is not sound"));
}

TEST_CASE("OBJ: corners without normals or coordinates among others that have them") {
  const Folder folder;
  const Lossy read =
      ReadLossy(folder, kSquareObj + "vt 0.25 0.5\nvn 0 0 1\nf 1// 2/1/ 3//1\nf 1 3/1/1 4/\n");
  CHECK(read.warning.empty());
  REQUIRE(read.mesh.triangles.size() == 2);
  CHECK(read.mesh.positions.size() == 5);  // the third corner with two kinds of coordinates
  CHECK(read.mesh.uv[1] == glm::vec2(0.25, 0.5));
  CHECK(read.mesh.normals[0] == glm::vec3(0));
  CHECK(read.mesh.normals[2] == glm::vec3(0, 0, 1));
}

TEST_CASE("OBJ: comments, marks and ends of lines as tools write them") {
  const Folder folder;
  const std::string square = kSquareObj + "f 1 2 3 4\n";
  const auto with = [](std::string text, const std::string& end) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += end.size()) {
      text.replace(at, 1, end);
    }
    return text;
  };
  std::string utf16 = "\xfe\xff";
  for (const char c : square) utf16 += std::string{'\0', c};
  std::string utf16_little = "\xff\xfe";
  for (const char c : square) utf16_little += std::string{c, '\0'};
  for (const std::string& text :
       {with(square, " # it # is\n"), with(square, "\t#\r\n"), "\xef\xbb\xbf" + square,
        with(square, "\r"), with(square, "\r\n"), utf16, utf16_little,
        square.substr(0, square.size() - 1), "v 0\\\r 0 0\r" + with(square.substr(8), "\r")}) {
    const Lossy read = ReadLossy(folder, text);
    CHECK(read.warning.empty());
    CHECK(read.mesh.triangles.size() == 2);
    CHECK(read.mesh.positions.size() == 4);
  }
  CheckRefused(folder.Write("cr.obj", with(kSquareObj + "f 1 2 9\n", "\r")), ":5: vertex 9 of 4");
}

TEST_CASE("OBJ: a face may come before its vertices, and groups stay apart") {
  const Folder folder;
  const Scene scene = ReadOrFail(
      folder.Write("a.obj", "g one two\nf 1 2 3\n" + kSquareObj + "g b\no c\nf -4 -2 -1\ng d\n"));
  REQUIRE(scene.objects.size() == 2);
  CHECK(scene.objects[0].name == "one two");
  CHECK(scene.objects[1].name == "c");
}

TEST_CASE("OBJ: colours of vertices, white for those without") {
  const Folder folder;
  const Lossy read = ReadLossy(folder, "v 0 0 0\nv 1 0 0 1 0.5 0\nv 1 1 0 1\nf 1 2 3\n");
  REQUIRE(read.mesh.colours.size() == 3);
  CHECK(read.mesh.colours[0] == glm::vec3(1));
  CHECK(read.mesh.colours[1] == glm::vec3(1, 0.5, 0));
  CHECK(ReadLossy(folder, kSquareObj + "f 1 2 3\n").mesh.colours.empty());
  const Lossy odd = ReadLossy(folder, "v 0 0 0 1 nan 1\nv 1 0 0 1 0 0\nv 1 1 0\nf 1 2 3\n");
  CHECK(odd.mesh.colours[0] == glm::vec3(1));
  CHECK(odd.warning == "1: rest of the line left out: \"nan\" is not finite, or beyond 1e30");
}

TEST_CASE("OBJ: concave polygons keep their area, in any position") {
  const Folder folder;
  // A C of 18 corners: an outer arc and an inner one.
  for (int turn = 0; turn < 72; ++turn) {
    CAPTURE(turn);
    std::string text, face = "f";
    double twice = 0;
    std::vector<glm::dvec2> outline;
    for (int i = 0; i < 18; ++i) {
      const double angle = (i < 9 ? i : 17 - i) * 0.7 + turn, radius = i < 9 ? 3 : 2;
      outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 p = outline[i], q = outline[(i + 1) % outline.size()];
      twice += p.x * q.y - p.y * q.x;
      text += "v " + std::to_string(p.x) + (turn % 2 ? " 0 " : " ") + std::to_string(p.y) +
              (turn % 2 ? "\n" : " 0\n");
      face += " " + std::to_string((i + static_cast<std::size_t>(turn)) % 18 + 1);
    }
    const Mesh mesh = ReadLossy(folder, text + face + "\n").mesh;
    CHECK(mesh.triangles.size() == 16);
    double sum = 0;
    for (const auto& [a, b, c] : mesh.triangles) {
      const glm::dvec3 p(mesh.positions[a]), q(mesh.positions[b]), r(mesh.positions[c]);
      sum += glm::length(glm::cross(q - p, r - p));
    }
    CHECK(sum == doctest::Approx(twice).epsilon(1e-4));
  }
}

TEST_CASE("colours of vertices can be written as scene JSON, whatever a model says") {
  const Folder folder;
  const std::string colours[] = {"2e9 0 0", "-1 0 0", "1e6 1 1"};
  for (const std::string& colour : colours) {
    CAPTURE(colour);
    const std::string v = " " + colour + "\n";
    const std::string paths[] = {
        folder.Write("a.obj", "v 0 0 0" + v + "v 1 0 0" + v + "v 0 1 0" + v + "f 1 2 3\n"),
        folder.Write("a.ply",
                     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                     "property float z\nproperty float red\nproperty float green\n"
                     "property float blue\nelement face 1\nproperty list uchar int vertex_indices\n"
                     "end_header\n0 0 0" +
                         v + "1 0 0" + v + "0 1 0" + v + "3 0 1 2\n")};
    for (const std::string& path : paths) {
      CAPTURE(path);
      const auto read = ReadScene(path);
      REQUIRE(read.ok());
      const Result<Scene> again = ParseSceneJson(SceneJsonText(read.value().scene), "again.json");
      CAPTURE((again ? "" : again.error().message));
      CHECK(again.ok());
    }
  }
}

}  // namespace
}  // namespace sheaf
