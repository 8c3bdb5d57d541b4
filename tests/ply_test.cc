// PLY and its polygons: what sound files become, and what is said of others.
#include "src/formats/ply.h"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

#include "model_files.h"
#include "src/formats/triangulate.h"

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

TEST_CASE("PLY that is wrong") {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    CheckRefused(folder.Write("bad.ply", text), part);
  };
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  };
  refused("solid\n", ":1: no PLY");
  refused(changed(AsciiPly(), "ascii", "ebcdic"), ":2: unknown format");
  refused(changed(AsciiPly(), "float x", "quad x"), "unknown type");
  refused(changed(AsciiPly(), "end_header\n", ""), "header");
  refused(changed(AsciiPly(), "1 1 0 255", "1 nan 0 255"), "vertex 2: a number is not finite");
  refused(changed(AsciiPly(), "1 1 0 255", "1 x 0 255"), "vertex 2: expected a number");
  refused(changed(AsciiPly(), "4 0 1 2 3", "4 0 1 2 4"), "face 0: vertex 4 of 4");
  refused(changed(AsciiPly(), "4 0 1 2 3", "4 0 1 2 -1"), "face 0: vertex -1 of 4");
  refused(changed(AsciiPly(), "3 0 2 1", "2 0 2"), "face 1: fewer than 3");
  // Many claimed elements in a small file.
  refused(changed(BinaryPly(false), "vertex 4", "vertex 2147483648"), "promised");
  refused(changed(BinaryPly(true), "face 2", "face 4294967295"), "face");
  refused(changed(AsciiPly(), "element face 2", "element face 0"), "no face");
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
