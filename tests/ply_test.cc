// PLY and its polygons: what sound files become, and what is said of others.
#include "src/formats/ply.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "model_files.h"
#include "src/formats/triangulate.h"
#include "src/scene/bounds.h"

namespace sheaf {
namespace {

std::string BinaryPly(bool is_big) {
  std::string bytes = PlyHeader(is_big ? "binary_big_endian" : "binary_little_endian");
  for (const auto& p : kSquare) {
    Put(bytes, static_cast<float>(p[0]), is_big);
    Put(bytes, p[1], is_big);
    Put(bytes, static_cast<float>(p[2]), is_big);
    for (const int c : {255, 0, 128}) Put(bytes, static_cast<unsigned char>(c), is_big);
    Put(bytes, 7.0f, is_big);
  }
  for (const std::initializer_list<int>& face :
       {std::initializer_list<int>{0, 1, 2, 3}, {0, 2, 1}}) {
    Put(bytes, static_cast<unsigned char>(face.size()), is_big);
    for (const int corner : face) Put(bytes, corner, is_big);
    Put(bytes, static_cast<unsigned char>(9), is_big);
  }
  Put(bytes, 3, is_big);
  return bytes;
}

TEST_CASE("PLY, ascii and both byte orders") {
  const Folder folder;
  for (const std::string& bytes : {AsciiPly(), BinaryPly(false), BinaryPly(true)}) {
    const Scene scene = ReadOrFail(folder.Write("a.ply", bytes));
    const Mesh& mesh = MeshAt(scene, 0);
    REQUIRE(mesh.positions.size() == 4);
    CHECK(mesh.positions[3] == glm::vec3(0, 1, 0.5));
    REQUIRE(mesh.triangles.size() == 3);
    CHECK(mesh.triangles[0] == std::array<std::uint32_t, 3>{0, 1, 2});
    CHECK(mesh.triangles[1] == std::array<std::uint32_t, 3>{0, 2, 3});
    CHECK(mesh.triangles[2] == std::array<std::uint32_t, 3>{0, 2, 1});
    REQUIRE(mesh.colours.size() == 4);
    CHECK(mesh.colours[2].x == 1);
    CHECK(mesh.colours[2].z == doctest::Approx(0.21586).epsilon(1e-4));  // sRGB's 128
    CheckSurvives(folder, "a.ply", bytes);
  }
}

std::string Changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

TEST_CASE("PLY that is wrong") {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    CheckRefused(folder.Write("bad.ply", text), part);
  };
  refused("solid\n", ":1: no PLY");
  refused(Changed(AsciiPly(), "ascii", "ebcdic"), ":2: unknown format");
  refused(Changed(AsciiPly(), "float x", "quad x"), "unknown type");
  refused(Changed(AsciiPly(), "end_header\n", ""), "header");
  refused(Changed(AsciiPly(), "1 1 0 255", "1 nan 0 255"), "vertex 2: a number is not finite");
  refused(Changed(AsciiPly(), "1 1 0 255", "1 x 0 255"), "vertex 2: expected a number");
  // Where no face is left, the first loss is why.
  const std::string one = Changed(Changed(AsciiPly(), "face 2", "face 1"), "3 0 2 1 9\n", "");
  refused(Changed(one, "4 0 1 2 3", "4 0 1 2 4"), ":22: face 0: vertex 4 of 4");
  refused(Changed(one, "4 0 1 2 3", "4 0 1 2 -1"), "face 0: vertex -1 of 4");
  refused(Changed(one, "4 0 1 2 3", "2 0 2"), "face 0: fewer than 3");
  // Many claimed elements in a small file.
  refused(Changed(BinaryPly(false), "vertex 4", "vertex 2147483648"), "promised");
  refused(Changed(BinaryPly(true), "face 2", "face 4294967295"), "face");
  refused(Changed(AsciiPly(), "element face 2", "element face 0"), "no face");
}

// ---- What is lost is said, and the rest is read ----

// Of vertices 0 0 0, 1 0 0, 1 1 0 and 0 1 0, with what follows "x y z" in the header and in each
// line; then elements with their properties, and their lines.
std::string SquarePly(const std::string& properties, const std::vector<std::string>& more,
                      const std::string& elements, const std::string& lines) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\n" +
      properties + elements + "end_header\n";
  const char* const corners[] = {"0 0 0", "1 0 0", "1 1 0", "0 1 0"};
  for (std::size_t i = 0; i < 4; ++i) {
    text += corners[i] + (more.empty() ? "" : " " + more[i]) + "\n";
  }
  return text + lines;
}
const std::string kFaces = "element face 2\nproperty list uchar int vertex_indices\n";
const std::string kOneFace = "element face 1\nproperty list uchar int vertex_indices\n";

struct Read {
  Scene scene;
  std::vector<std::string> warnings;  // without the folder
};
Read ReadPly(const Folder& folder, const std::string& text) {
  auto read = ReadScene(folder.Write("a.ply", text));
  CAPTURE(MessageOf(read));
  REQUIRE(read.ok());
  std::vector<std::string> warnings = read.value().warnings;
  for (std::string& warning : warnings) {
    REQUIRE(warning.starts_with(folder / "a.ply:"));
    warning.erase(0, (folder / "a.ply:").size());
  }
  const Status valid = Validate(read.value().scene);
  CAPTURE((valid ? "" : valid.error().message));
  CHECK(valid.ok());
  return {std::move(read.value().scene), warnings};
}

TEST_CASE("PLY: what is not sound is left out") {
  const Folder folder;
  const auto left_out = [&](const std::string& text, const std::string& warning) {
    const Read read = ReadPly(folder, text);
    CHECK(MeshAt(read.scene, 0).triangles.size() == 2);
    CHECK(read.warnings == std::vector<std::string>{warning});
  };
  left_out(SquarePly("", {}, kFaces, "2 0 1\n4 0 1 2 3\n"),
           "14: face left out: face 0: fewer than 3 corners");
  left_out(SquarePly("", {}, kFaces, "4 0 1 2 3\n3 0 1 4\n"),
           "15: face left out: face 1: vertex 4 of 4");
  left_out(SquarePly("", {}, "element face 3\nproperty list uchar int vertex_index\n",
                     "3 -1 1 4\n4 0 1 2 3\n3 0.5 0 1\n"),
           "14: face left out: face 0: vertex -1 of 4 (2 in all)");
  const std::string normals = "property float nx\nproperty float ny\nproperty float nz\n";
  left_out(SquarePly(normals, {"0 0 1", "0 nan 1", "0 0 1", "0 0 1"}, kOneFace, "4 0 1 2 3\n"),
           "14: normal left out: vertex 1: a number is not finite, or beyond 1e30");
  left_out(SquarePly("property float u\nproperty float v\n", {"0 0", "1 0", "inf 1", "0 1"},
                     kOneFace, "4 0 1 2 3\n"),
           "14: texture coordinate left out: vertex 2: a number is not finite, or beyond 1e30");
  left_out(Changed(SquarePly("", {}, kOneFace, "4 0 1 2 3\n"), "element vertex",
                   "Created by hand\nelement vertex"),
           "3: line of the header passed over: unknown word \"Created\"");
  const Read read = ReadPly(
      folder, Changed(SquarePly("", {}, kFaces, "3 0 1 2\n3 0 2 3\n"), "0 1 0\n", "0 nan 0\n"));
  CHECK(MeshAt(read.scene, 0).triangles.size() == 1);
  CHECK(read.warnings ==
        std::vector<std::string>{
            "13: vertex left out: vertex 3: a number is not finite, or beyond 1e30",
            "15: face left out: face 1: vertex 3 is not sound"});
}

TEST_CASE("PLY: an element behind the faces is not read") {
  const Folder folder;
  const Read read = ReadPly(
      folder, SquarePly("", {}, kOneFace + "element edge 9\nproperty int a\n", "4 0 1 2 3\n1 x\n"));
  CHECK(read.warnings.empty());
}

TEST_CASE("PLY: triangle strips") {
  const Folder folder;
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const Read read = ReadPly(folder, SquarePly("", {}, strips, "9 0 1 3 2 -1 3 1 2 -1\n"));
  CHECK(read.warnings.empty());
  using Triangles = std::vector<std::array<std::uint32_t, 3>>;
  CHECK(MeshAt(read.scene, 0).triangles == Triangles{{0, 1, 3}, {3, 1, 2}, {3, 1, 2}});
  // A repeated vertex gives no triangle, and keeps the turn.
  const Read stitched = ReadPly(folder, SquarePly("", {}, strips, "6 0 1 3 3 3 2\n"));
  CHECK(MeshAt(stitched.scene, 0).triangles == Triangles{{0, 1, 3}});
  const Read bad = ReadPly(folder, SquarePly("", {}, strips, "7 0 1 3 9 0 1 2\n"));
  CHECK(MeshAt(bad.scene, 0).triangles == Triangles{{0, 1, 3}, {0, 1, 2}});
  CHECK(bad.warnings == std::vector<std::string>{"14: face left out: tristrips 0: vertex 9 of 4"});
}

TEST_CASE("PLY: colours of faces, and colours by short names") {
  const Folder folder;
  const std::string rgb = "property uchar r\nproperty uchar g\nproperty uchar b\n";
  const std::vector<std::string> red(4, "255 0 0");
  const std::string lines = "3 0 1 2 255 0 0\n3 0 2 3 0 0 255\n";
  const Read faces = ReadPly(folder, SquarePly("", {}, kFaces + rgb, lines));
  CHECK(std::get<Colour>(faces.scene.materials[0].base_colour) == Colour(1.0));
  const Mesh& mesh = MeshAt(faces.scene, 0);
  REQUIRE(mesh.triangles.size() == 2);
  CHECK(mesh.positions.size() == 6);
  for (std::size_t i = 0; i < 2; ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      CHECK(mesh.colours.at(corner) == (i == 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1)));
    }
  }
  // Faces of one colour share vertices.
  CHECK(
      MeshAt(
          ReadPly(folder, SquarePly("", {}, kFaces + rgb, "3 0 1 2 9 9 9\n3 0 2 3 9 9 9\n")).scene,
          0)
          .positions.size() == 4);
  const Read vertices = ReadPly(folder, SquarePly(rgb, red, kFaces + rgb, lines));
  CHECK(MeshAt(vertices.scene, 0).colours == std::vector<glm::vec3>(4, glm::vec3(1, 0, 0)));
  const Read clear = ReadPly(folder, SquarePly("property uchar alpha\n", {"255", "255", "9", "255"},
                                               kOneFace, "4 0 1 2 3\n"));
  CHECK(clear.warnings == std::vector<std::string>{"13: alpha is not read: all is opaque"});
}

TEST_CASE("PLY: textures by vertices, by corners and by faces") {
  const Folder folder;
  folder.Write("sub/a b.png", kRedPng);
  folder.Write("t.png", kRedPng);
  const auto with = [](const std::string& texture, const std::string& text) {
    return Changed(text, "element vertex", "comment TextureFile " + texture + "\nelement vertex");
  };
  const std::string st = "property float s\nproperty float t\n";
  const std::vector<std::string> corners = {"0 0", "1 0", "1 1", "0 1"};
  const Read vertices =
      ReadPly(folder, with("sub\\a b.png", SquarePly(st, corners, kOneFace, "4 0 1 2 3\n")));
  CHECK(vertices.warnings.empty());
  CHECK(std::get<Texture>(vertices.scene.materials[0].base_colour).factor == Colour(1.0));
  CHECK(MeshAt(vertices.scene, 0).uv[2] == glm::vec2(1, 0));

  const std::string per_corner = kFaces + "property list uchar float texcoord\n";
  const Read split = ReadPly(
      folder, with("t.png", SquarePly("", {}, per_corner,
                                      "3 0 1 2 6 0 0 0.5 0 1 1\n3 0 2 3 6 0 0 0.5 1 0 1\n")));
  CHECK(split.warnings.empty());
  const Mesh& mesh = MeshAt(split.scene, 0);
  CHECK(mesh.positions.size() == 5);  // the corner 2 twice
  CHECK(mesh.uv[mesh.triangles[0][1]] == glm::vec2(0.5, 1));
  CHECK(mesh.uv[mesh.triangles[1][1]] == glm::vec2(0.5, 0));
  CHECK(std::holds_alternative<Texture>(split.scene.materials[0].base_colour));

  const Read several = ReadPly(
      folder,
      with("t.png\ncomment TextureFile gone.png",
           SquarePly(st, corners, kFaces + "property int texnumber\n", "3 0 1 2 1\n3 0 2 3 0\n")));
  REQUIRE(several.scene.objects.size() == 2);
  CHECK(MeshAt(several.scene, 0).triangles.size() == 1);
  CHECK(MeshAt(several.scene, 0).positions[1] == glm::vec3(1, 1, 0));
  CHECK(std::holds_alternative<Texture>(several.scene.materials[0].base_colour));
  CHECK(std::holds_alternative<Colour>(several.scene.materials[1].base_colour));
  CHECK(several.warnings ==
        std::vector<std::string>{"4: TextureFile: " + (folder / "gone.png") +
                                 ": cannot open: No such file or directory; untextured"});

  const Read bare = ReadPly(folder, with("t.png", SquarePly("", {}, kOneFace, "4 0 1 2 3\n")));
  CHECK(bare.warnings ==
        std::vector<std::string>{"3: TextureFile: there are no texture coordinates; untextured"});
  const Read odd = ReadPly(
      folder, with("t.png", SquarePly("", {}, per_corner, "3 0 1 2 3 0 0 0.5\n3 0 2 3 0\n")));
  REQUIRE(odd.warnings.size() == 1);
  CHECK(odd.warnings[0].starts_with("16: texture coordinate left out: face 0: "));
}

TEST_CASE("PLY: lines that end in CR, and a vertex that no face uses") {
  const Folder folder;
  std::string text = SquarePly("", {}, kOneFace, "4 0 1 2 3\n");
  for (char& c : text) c = c == '\n' ? '\r' : c;
  CHECK(MeshAt(ReadPly(folder, text).scene, 0).triangles.size() == 2);
  CheckRefused(folder.Write("b.ply", Changed(text, "4 0 1 2 3", "4 0 1 2 x")),
               ":14: face 0: expected a number");
  // The camera frames what is drawn.
  const Read stray =
      ReadPly(folder, Changed(SquarePly("", {}, kOneFace, "3 0 1 2\n"), "0 1 0\n", "0 100 0\n"));
  const Read plain = ReadPly(folder, SquarePly("", {}, kOneFace, "3 0 1 2\n"));
  CHECK(stray.scene.cameras[0].eye == plain.scene.cameras[0].eye);
  CHECK(BoundsOf(stray.scene)->max == Vec3d(1, 1, 0));
}

// ---- Triangulation ----

TEST_CASE("polygons keep their area and their front") {
  Random random(3);
  std::vector<glm::vec3> points;
  std::vector<std::uint32_t> polygon;
  // Stars about a center: simple outlines, mostly concave.
  for (int round = 0; round < 300; ++round) {
    const int corners = 3 + static_cast<int>(random() % 60);
    points.clear(), polygon.clear();
    double area = 0;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * 3.14159265358979 * i / corners;
      const double radius = Uniform(random, 0.1, 2);
      points.emplace_back(radius * std::cos(angle), 0.3f, radius * std::sin(angle));
      polygon.push_back(static_cast<std::uint32_t>(i));
    }
    const auto twice_area = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      const glm::dvec3 u = glm::dvec3(points[b]) - glm::dvec3(points[a]);
      const glm::dvec3 v = glm::dvec3(points[c]) - glm::dvec3(points[a]);
      return u.z * v.x - u.x * v.z;
    };
    for (std::uint32_t i = 0; i < polygon.size(); ++i) {
      const glm::dvec3 a(points[i]), b(points[(i + 1) % polygon.size()]);
      area += a.z * b.x - a.x * b.z;
    }
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Triangulate(points, polygon, triangles);
    REQUIRE(triangles.size() == polygon.size() - 2);
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
      sum += twice_area(a, b, c);
      CHECK(twice_area(a, b, c) * area >= 0);
    }
    CHECK(sum == doctest::Approx(area));
  }
}

}  // namespace
}  // namespace sheaf
