// Readers of models: what they make of sound files, and what they say of others.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "random_scene.h"
#include "same_bits.h"
#include "simd/shading.h"
#include "src/formats/nff.h"
#include "src/formats/ply.h"
#include "src/formats/png.h"
#include "src/formats/read_scene.h"
#include "src/formats/triangulate.h"
#include "src/lab/pov_ray.h"
#include "src/scalar/spawn.h"

#ifdef SHEAF_HAS_ASSIMP
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#endif

namespace sheaf {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A folder that goes away with the test.
class Folder {
 public:
  Folder() {
    std::string name = (fs::temp_directory_path() / "sheaf-model-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }
  ~Folder() { fs::remove_all(path_); }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string Write(const std::string& name, const std::string& bytes) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return *this / name;
  }

 private:
  fs::path path_;
};

std::string MessageOf(const Result<ReadSceneResult>& result) {
  return result ? "" : result.error().message;
}

// One line, of kScene, that begins with the file.
void CheckRefused(const std::string& path, const std::string& part,
                  const ReadOptions& options = {}) {
  const auto result = ReadScene(path, options);
  CAPTURE(part);
  REQUIRE_FALSE(result.ok());
  CAPTURE(result.error().message);
  CHECK(result.error().kind == ErrorKind::kScene);
  CHECK(result.error().message.starts_with(path));
  CHECK(result.error().message.find(part) != std::string::npos);
  CHECK(result.error().message.find('\n') == std::string::npos);
}

Scene ReadOrFail(const std::string& path) {
  auto result = ReadScene(path);
  CAPTURE(path);
  CAPTURE(MessageOf(result));
  REQUIRE(result.ok());
  return std::move(result.value().scene);
}

const Mesh& MeshAt(const Scene& scene, std::size_t object) {
  return std::get<Mesh>(scene.objects.at(object).shape);
}

// Every prefix, and flips of single bytes: whatever comes, an answer.
void CheckSurvives(const Folder& folder, const std::string& name, const std::string& bytes) {
  const std::size_t step = std::max<std::size_t>(1, bytes.size() / 150);
  for (std::size_t size = 0; size < bytes.size(); size += step) {
    const auto result = ReadScene(folder.Write("cut-" + name, bytes.substr(0, size)));
    if (!result) CHECK(result.error().message.find('\n') == std::string::npos);
  }
  Random random(11);
  for (int round = 0; round < 400; ++round) {
    std::string changed = bytes;
    for (int flips = 0; flips < 1 + round % 4; ++flips) {
      changed[random() % changed.size()] = static_cast<char>(random());
    }
    const auto result = ReadScene(folder.Write("changed-" + name, changed));
    if (!result) CHECK(result.error().message.find('\n') == std::string::npos);
  }
  std::string noise(4096, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  CheckRefused(folder.Write("noise-" + name, noise), "");
  CheckRefused(folder.Write("empty-" + name, ""), "");
}

// ---- NFF ----

const std::string kNff = R"(# a comment
b 0.1 0.2 0.3
v
from 0 0 5
at 0 0 0
up 0 1 0
angle 45
hither 1
resolution 64 48
l 1 2 3
l 4 5 6 0.5 0.25 1
f 1 0.5 0.25 0.8 0.2 10 0 1
s 0 0 0 1
p 4
-1 -1 0
1 -1 0
1 1 0
-1 1 0
f 1 1 1 0.1 0.1 50 0.9 1.5
c 0 0 0 0.5 0 1 0 0.25
f 1 0.5 0.25 0.8 0.2 10 0 1
pp 3
0 0 1 0 0 2
1 0 1 0 0 2
0 1 1 0 1 1
)";

TEST_CASE("NFF") {
  const Folder folder;
  const Scene scene = ReadOrFail(folder.Write("a.nff", kNff));
  CHECK(scene.settings.width == 64);
  CHECK(scene.settings.height == 48);
  CHECK(scene.settings.max_depth == 4);
  CHECK(scene.settings.background == Colour(0.1, 0.2, 0.3));
  CHECK(std::get<Perspective>(scene.cameras.at(0).projection).fov_y == 45);
  CHECK(scene.cameras[0].eye == Vec3d(0, 0, 5));
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].intensity == doctest::Approx(std::sqrt(0.5)));
  CHECK(scene.lights[1].colour == Colour(0.5, 0.25, 1));
  CHECK(scene.lights[1].intensity == 1);
  // Equal fills are one material.
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0].kd == 0.8);
  CHECK(scene.materials[0].reflect == Colour(0.2));
  CHECK(scene.materials[1].transmit == Colour(0.9));
  CHECK(scene.materials[1].ior == 1.5);
  REQUIRE(scene.objects.size() == 4);
  CHECK(std::holds_alternative<Sphere>(scene.objects[0].shape));
  CHECK(MeshAt(scene, 1).triangles.size() == 2);  // the square
  CHECK(MeshAt(scene, 1).normals.empty());
  CHECK(MeshAt(scene, 2).triangles.size() == 1);  // the patch
  CHECK(MeshAt(scene, 2).normals.size() == 3);
  CHECK(MeshAt(scene, 3).triangles.size() == 64);  // the cone
  for (std::size_t i = 0; i < MeshAt(scene, 3).positions.size(); ++i) {
    const glm::vec3 p = MeshAt(scene, 3).positions[i], n = MeshAt(scene, 3).normals[i];
    CHECK(std::hypot(p.x, p.z) == doctest::Approx(0.5 - 0.25 * p.y));
    CHECK(n.y == doctest::Approx(0.25 / std::hypot(1, 0.25)));  // of a slope of 1 to 4
    CHECK(p.x * n.x + p.z * n.z > 0);
  }
  CheckSurvives(folder, "a.nff", kNff);
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

TEST_CASE("NFF: a cone on three lines, as Haines has it, or on one") {
  const Folder folder;
  const std::string sphere = "s 0 0 0 1\n";
  const Scene one = ReadOrFail(folder.Write("one.nff", "c 0 0 0 0.5 0 1 0 0.25\n" + sphere));
  for (const char* text : {"c\n0 0 0 0.5\n0 1 0 0.25\n", "c\n\n# base\n0 0 0 0.5\n0 1 0 0.25\n",
                           "c 0 0 0 0.5\n0 1 0 0.25\n"}) {
    const Scene scene = ReadOrFail(folder.Write("a.nff", text + sphere));
    REQUIRE(scene.objects.size() == 2);
    CHECK(MeshAt(scene, 1).positions == MeshAt(one, 1).positions);
    CHECK(MeshAt(scene, 1).normals == MeshAt(one, 1).normals);
    CHECK(MeshAt(scene, 1).triangles == MeshAt(one, 1).triangles);
  }
}

TEST_CASE("NFF that is wrong") {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    CheckRefused(folder.Write("bad.nff", text), part);
  };
  refused("x 1 2 3\n", ":1: unknown entity \"x\"");
  refused("b 0 0\n", ":1: background: a number is missing");
  refused("b 0 0 nan\n", ":1: background: expected a number");
  refused("\ns 1 2 3 inf\n", ":2: sphere radius");
  refused("p 3\n0 0 0\n1 0 0\n", ":3: the file ends within a polygon");
  refused("p 2\n0 0 0\n1 0 0\n", ":1: number of vertices");
  refused("p 2147483648\n0 0 0\n", ":1: number of vertices");
  refused("v\nfrom 0 0 0\nat 0 0 0\n", "the file ends within the view");
  refused("v\nfrom 0 0 0\nto 0 0 0\n", ":3: expected \"at\"");
  refused("f 1 1 1 1 0 1 0.5 0\n", ":1: fill index");
  refused("c 0 0 0 1 0 0 0 1\n", "one point");
  refused("c\n0 0 0 1\n", ":2: the file ends within a cone");
  refused("c\n0 0 0 1\ns 1 2 3 4\n", ":3: cone apex: expected a number");
}

// ---- PLY ----

std::string PlyHeader(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double y\n"
         "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         "property float quality\nelement face 2\nproperty list uchar int vertex_indices\n"
         "property uchar flags\nelement edge 1\nproperty int vertex1\nend_header\n";
}

template <typename T>
void Put(std::string& bytes, T value, bool is_big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (is_big) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

constexpr double kSquare[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};

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

std::string AsciiPly() {
  return PlyHeader("ascii") +
         "0 0 0 255 0 128 7\n1 0 0 255 0 128 7\n1 1 0 255 0 128 7\n0 1 0.5 255 0 128 7\n"
         "4 0 1 2 3 9\n3 0 2 1 9\n3\n";
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

// ---- OBJ ----

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

// ---- glTF ----

std::string Base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (int k = 0; k < 4; ++k) {
      text +=
          i + static_cast<std::size_t>(k) > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

// Four corners of a square, six indices, quantised positions and one sparse replacement.
std::string GltfBuffer() {
  std::string bytes;
  for (const auto& p : kSquare) {
    for (const double x : p) Put(bytes, static_cast<float>(x), false);
  }  // 48 bytes
  for (const int i : {0, 1, 2, 0, 2, 3}) Put(bytes, static_cast<std::uint16_t>(i), false);  // 12
  for (const int i : {0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0})
    Put(bytes, static_cast<std::int16_t>(i), false);  // 24
  Put(bytes, std::uint16_t{3}, false);                // sparse index
  Put(bytes, std::uint16_t{0}, false);
  for (const float x : {0.0f, 2.0f, 0.0f}) Put(bytes, x, false);  // sparse value
  return bytes;
}

json SquareGltf() {
  const std::string buffer = GltfBuffer();
  json gltf;
  gltf["asset"]["version"] = "2.0";
  gltf["extensionsUsed"] = {"KHR_lights_punctual", "KHR_mesh_quantization"};
  gltf["buffers"] = {{{"byteLength", buffer.size()},
                      {"uri", "data:application/octet-stream;base64," + Base64(buffer)}}};
  gltf["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                         {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}},
                         {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 24}, {"byteStride", 8}},
                         {{"buffer", 0}, {"byteOffset", 84}, {"byteLength", 4}},
                         {{"buffer", 0}, {"byteOffset", 88}, {"byteLength", 12}}};
  const auto accessor = [](int view, int type, int count, const char* shape) {
    return json{{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}};
  };
  json quantised = accessor(2, 5122, 3, "VEC3");
  quantised["normalized"] = true;
  json sparse = accessor(0, 5126, 4, "VEC3");
  sparse["sparse"] = {{"count", 1},
                      {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                      {"values", {{"bufferView", 4}}}};
  gltf["accessors"] = {accessor(0, 5126, 4, "VEC3"), accessor(1, 5123, 6, "SCALAR"), quantised,
                       sparse};
  gltf["materials"] = {
      {{"name", "paint"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"metallicFactor", 0}}}}};
  gltf["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}},
      {{"primitives", {{{"attributes", {{"POSITION", 3}}}, {"mode", 5}}}}},  // a strip
      {{"primitives", {{{"attributes", {{"POSITION", 3}}}, {"mode", 6}}}}},  // a fan
      {{"primitives", {{{"attributes", {{"POSITION", 2}}}}}}}};              // quantised
  gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}},
                     {{"type", "orthographic"},
                      {"orthographic", {{"xmag", 2}, {"ymag", 1.5}, {"znear", 0.1}, {"zfar", 9}}}}};
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 30.0}, {"color", {1, 0.5, 0.5}}},
      {{"type", "directional"}, {"intensity", 2.0}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}};
  const auto light = [](int index) { return json{{"KHR_lights_punctual", {{"light", index}}}}; };
  gltf["nodes"] = {
      {{"name", "root"}, {"translation", {10, 0, 0}}, {"children", {1, 2, 3, 4}}},
      {{"name", "square"}, {"mesh", 0}, {"scale", {2, 3, 4}}},
      {{"name", "strip"}, {"mesh", 1}},
      {{"name", "fan"}, {"mesh", 2}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}},
      {{"name", "small"}, {"mesh", 3}},
      {{"name", "front"}, {"camera", 0}, {"translation", {0, 0, 8}}},
      // A quarter turn about y: its -z axis becomes -x.
      {{"name", "side"},
       {"camera", 1},
       {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
       {"translation", {20, 0, 0}}},
      {{"name", "lamp"}, {"extensions", light(0)}, {"translation", {1, 2, 3}}},
      {{"name", "sun"}, {"extensions", light(1)}},
      {{"name", "spot"}, {"extensions", light(2)}}};
  gltf["scenes"] = {{{"nodes", {0, 5, 6, 7, 8, 9}}}};
  gltf["scene"] = 0;
  return gltf;
}

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
    CHECK(scene.lights[0].intensity == 30);
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

// ---- Textures ----

Picture8 Chequered() {
  Picture8 picture{4, 2, {}};
  for (int i = 0; i < 8; ++i) {
    for (const int c : {40 * (i % 4), 120 * (i / 4), 255 - 30 * i}) {
      picture.rgb.push_back(static_cast<std::uint8_t>(c));
    }
  }
  return picture;
}

TEST_CASE("textures, wraps and filters have the same bits on every target") {
  const Folder folder;
  REQUIRE(WritePng(Chequered(), Transfer::kLinear, folder / "t.png").ok());
  for (const char* wrap : {"\"repeat\"", "\"mirror\"", "[\"clamp\", \"repeat\"]"}) {
    for (const char* filter : {"linear", "nearest"}) {
      const std::string text = std::string(R"({"materials": [{"name": "a", "kd": 0.5, "ambient": 1,
        "base_colour": {"texture": {"image": "t.png", "wrap": )") +
                               wrap + R"(, "filter": ")" + filter +
                               R"(", "factor": [1, 0.5, 1]}}}],
        "settings": {"ambient": 1},
        "objects": [{"material": "a", "mesh": {"positions": [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]],
          "uv": [[-1.3,2.1],[2.2,2.1],[2.2,-1.7],[-1.3,-1.7]], "triangles": [[0,1,2],[0,2,3]]}}],
        "lights": [{"spot": {"position": [0,0,3], "direction": [0,0.1,-1], "outer": 40}, "intensity": 4}],
        "cameras": [{"name": "c", "eye": [0.2,0.1,5], "look_at": [0,0,0]}]})";
      const Scene scene = ReadOrFail(folder.Write("t.json", text));
      RenderOptions options;
      options.width = 70, options.height = 50;
      CheckSameBits(scene, scene.cameras[0], options);
    }
  }
}

TEST_CASE("a texture's texels land where they belong") {
  const Folder folder;
  REQUIRE(WritePng(Chequered(), Transfer::kLinear, folder / "t.png").ok());
  // Straight on, four pixels by two: each shows the middle of one texel.
  const Scene scene =
      ReadOrFail(folder.Write("t.json", R"({"settings": {"ambient": 1, "size": [4, 2]},
    "materials": [{"name": "a", "ambient": 1,
      "base_colour": {"texture": {"image": "t.png", "srgb": false}}}],
    "objects": [{"material": "a", "mesh": {"positions": [[-2,-1,0],[2,-1,0],[2,1,0],[-2,1,0]],
      "uv": [[0,1],[1,1],[1,0],[0,0]], "triangles": [[0,1,2],[0,2,3]]}}],
    "cameras": [{"name": "c", "eye": [0,0,5], "look_at": [0,0,0], "orthographic": {"height": 2}}]})"));
  RenderOptions options;
  options.width = 4, options.height = 2;
  const Film film = RenderOrFail(scene, scene.cameras[0], options);
  const Picture8 picture = Chequered();
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    CHECK(film.rgb[i] == doctest::Approx(picture.rgb[i] / 255.0).epsilon(1e-5));
  }
}

TEST_CASE("images that are none") {
  const Folder folder;
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    folder.Write("t.png", bytes);
    CheckRefused(folder.Write("t.json", R"({"materials": [{"name": "a",
      "base_colour": {"texture": {"image": "t.png"}}}], "cameras": []})"),
                 part);
  };
  refused("", "neither a PNG nor a JPEG");
  refused("\x89PNG\r\n\x1a\n", ":2: /materials/0/base_colour/texture/image");
  refused("\xff\xd8\xff\xe0 no more", "image");
  // A header that claims 65,000 x 65,000.
  REQUIRE(WritePng(Chequered(), Transfer::kLinear, folder / "big.png").ok());
  std::ifstream file(folder / "big.png", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  bytes[18] = bytes[22] = '\xfd', bytes[19] = bytes[23] = '\xe8';
  refused(bytes, "image");
}

// ---- Scene JSON ----

constexpr char kCameras[] = R"("cameras": [{"name": "c", "eye": [0,0,9], "look_at": [0,0,0]}])";

std::string JsonWith(const std::string& objects) {
  return R"({"materials": [{"name": "m", "kd": 1}], "objects": [)" + objects + "], " + kCameras +
         "}";
}

TEST_CASE("meshes, transforms and includes of scene JSON") {
  const Folder folder;
  folder.Write("sub/a.ply", AsciiPly());
  folder.Write("sub/other.json",
               R"({"materials": [{"name": "m", "kd": 0.5}],
                   "objects": [{"sphere": {"center": [1,0,0], "radius": 1}, "material": "m"},
                               {"mesh": "a.ply"}],
                   "lights": [{"name": "l", "point": {"position": [0,0,1]}, "intensity": 1}],
                   "cameras": [{"name": "c", "eye": [0,0,1], "look_at": [0,0,0]},
                               {"name": "d", "eye": [0,0,1], "look_at": [0,0,0]}]})");
  const Scene scene = ReadOrFail(
      folder.Write("a.json", JsonWith(
                                 R"({"mesh": "sub/a.ply", "material": "m", "name": "mine",
          "transform": [{"scale": [2, 2, 2]}, {"rotate": {"axis": [0,0,1], "degrees": 90}},
                        {"translate": [0, 0, 5]}]},
         {"include": "sub/other.json", "transform": {"scale": 3}})")));
  REQUIRE(scene.objects.size() == 3);
  CHECK(scene.objects[0].name == "mine");
  CHECK(scene.objects[0].material == 0);
  CHECK(MeshAt(scene, 0).positions[1] == glm::vec3(0, 2, 5));
  CHECK(std::get<Sphere>(scene.objects[1].shape).center == Vec3d(3, 0, 0));
  CHECK(std::get<Sphere>(scene.objects[1].shape).radius == 3);
  CHECK(scene.materials[scene.objects[1].material].kd == 0.5);
  REQUIRE(scene.lights.size() == 1);
  CHECK(std::get<PointLight>(scene.lights[0].source).position == Vec3d(0, 0, 3));
  REQUIRE(scene.cameras.size() == 2);  // its own first, and no second "c"
  CHECK(scene.cameras[0].eye == Vec3d(0, 0, 9));
  CHECK(scene.cameras[1].name == "d");
}

TEST_CASE("references that are wrong") {
  const Folder folder;
  const auto refused = [&](const std::string& object, const std::string& part,
                           const ReadOptions& options = {}) {
    CheckRefused(folder.Write("in/a.json", JsonWith(object)), part, options);
  };
  folder.Write("b.ply", AsciiPly());
  refused(R"({"mesh": "../b.ply"})", ":1: /objects/0/mesh: ../b.ply: lies outside");
  refused(R"({"mesh": ")" + (folder / "b.ply") + R"("})", "lies outside");
  fs::create_symlink(folder / "b.ply", folder / "in/link.ply");
  refused(R"({"mesh": "link.ply"})", "lies outside");
  CHECK(ReadScene(folder / "in/a.json", {Outside::kAllowed}).ok());
  refused(R"({"mesh": "none.ply"})", "none.ply: cannot open");
  refused(R"({"mesh": "a.txt"})", "must end in");
  refused(R"({"include": "a.json"})", "includes itself");
  folder.Write("in/b.json", JsonWith(R"({"include": "a.json"})"));
  refused(R"({"include": "b.json"})", "includes itself");
  folder.Write("in/sphere.json",
               JsonWith(R"({"sphere": {"center": [0,0,0], "radius": 1}, "material": "m"})"));
  refused(R"({"include": "sphere.json", "transform": {"scale": [1, 2, 1]}})", "a sphere can be");
  refused(R"({"include": "sphere.json", "transform": {"scale": 0}})", "a scale of 0");
  refused(R"({"include": "sphere.json", "transform": {"turn": 0}})", "turn");
  refused(R"({"material": "m", "mesh": {"positions": [[0,0,0]], "triangles": [[0,0,1]]}})",
          "/objects/0/mesh/triangles/0/2");
}

// ---- Layers, by every engine ----

TEST_CASE("layers have the same bits on every target") {
  Random random(5);
  Scene scene = RandomScene(random, 10);
  scene.materials[0].base_colour = Checker{};
  scene.objects.push_back({"mesh", RandomMesh(random, 20), 0});
  const Camera camera{"c", {1, 2, 9}, {0, 0, 0}, {0, 1, 0}, Perspective{50}};
  RenderOptions options;
  options.width = 90, options.height = 70;
  for (const Layer layer : {Layer::kDepth, Layer::kNormal, Layer::kAlbedo, Layer::kId}) {
    options.layers.Add(layer);
  }
  for (const bool is_adaptive : {false, true}) {
    options.samples = is_adaptive ? 4 : 1;
    if (is_adaptive) options.contrast = 0.1;
    options.target = Target::Scalar();
    const Film want = RenderOrFail(scene, camera, options);
    int hits = 0;
    for (std::size_t i = 0; i < want.pixel_count(); ++i) {
      const float depth = want.layers[static_cast<int>(Layer::kDepth)][i];
      const float id = want.layers[static_cast<int>(Layer::kId)][i];
      CHECK(std::isinf(depth) == (id == 0));
      CHECK(id <= static_cast<float>(scene.objects.size()));
      hits += id > 0;
    }
    CHECK(hits > 500);
    options.target = Target();
    ForEachTarget([&](Target target) {
      options.target = target;
      const Film got = RenderOrFail(scene, camera, options);
      for (int i = 0; i < kLayerCount; ++i) {
        REQUIRE(got.layers[i].size() == want.layers[i].size());
        if (want.layers[i].empty()) continue;
        CHECK(std::memcmp(got.layers[i].data(), want.layers[i].data(),
                          want.layers[i].size() * sizeof(float)) == 0);
      }
    });
  }
}

// ---- Shading normals ----

TEST_CASE("a shading normal never lights the back of a face, nor sends rays through it") {
  Random random(8);
  const Mesh mesh = RandomMesh(random, 200);
  Scene scene;
  scene.materials.push_back({});
  scene.objects.push_back({"", mesh, 0});
  const CompiledScene<float> compiled = CompileScene<float>(scene);
  MaterialData<float> glass{};
  for (int c = 0; c < 3; ++c) glass.transmit[c] = glass.reflect[c] = 0.5f;
  glass.ior = 1.5f;
  int turned = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    for (int k = 0; k < 20; ++k) {
      scalar::Ray<float> ray{{0, 0, 0}, RandomUnit(random).To<float>()};
      const float u = static_cast<float>(Uniform(random, 0, 0.5));
      const scalar::Hit<float> hit{1, i, u, 0.5f - u};
      const auto surface = scalar::TriangleSurface(ray, hit, compiled.geometry().triangles, i);
      CHECK(Dot(surface.face, ray.direction) <= 1e-6f);
      CHECK(Dot(surface.face, surface.normal) >= -1e-6f);
      LightData<float> sun{};
      sun.kind = LightKind::kDirectional;
      const auto l = RandomUnit(random).To<float>();
      for (int c = 0; c < 3; ++c) sun.vector[c] = l[c];
      const auto incidence = scalar::IncidenceOf(sun, surface);
      if (Dot(surface.face, l) <= 0) CHECK_FALSE(incidence.reaches);
      turned += incidence.n_dot_l > 0 && !incidence.reaches;
      const float weight[3] = {1, 1, 1};
      const auto spawned = scalar::Spawn(glass, surface, weight);
      CHECK(Dot(spawned.reflected.ray.direction, surface.face) >= -1e-6f);
      if (spawned.refracted.counts()) {
        CHECK(Dot(spawned.refracted.ray.direction, surface.face) <= 1e-6f);
      }
    }
  }
  CHECK(turned > 100);  // or nothing was tested
}

// ---- Files that are not part of the project ----

std::string DataFolder() {
  const char* given = std::getenv("SHEAF_TEST_DATA");
  const std::string folder = given != nullptr ? given : SHEAF_SOURCE_DIR "/../shared/data";
  return fs::exists(folder) ? folder : "";
}

bool IsSkipped(const std::string& path) {
  if (fs::exists(path)) return false;
  MESSAGE("skipped: ", path, " is not there (see SHEAF_TEST_DATA)");
  return true;
}

TEST_CASE("SPD: every file has the same bits on every target") {
  for (const char* name : {"balls", "gears", "jacks", "lattice", "mount", "rings", "shells",
                           "sombrero", "teapot", "tetra", "tree"}) {
    const std::string path = DataFolder() + "/spd/" + name + ".nff";
    if (IsSkipped(path)) continue;
    CAPTURE(name);
    const Scene scene = ReadOrFail(path);
    RenderOptions options;
    options.width = options.height = 64;
    options.max_depth = scene.settings.max_depth;
    CheckSameBits(scene, scene.cameras[0], options);
  }
}

TEST_CASE("SPD: Haines' counts at 513x513") {
  struct Counts {
    const char* name;
    double hits, reflected, shadow;
  };
  const auto is_near = [](double got, double wanted) {
    return std::abs(got - wanted) <= 0.02 * wanted;
  };
  for (const Counts& wanted :
       {Counts{"balls", 263169, 175095, 954368}, Counts{"tetra", 49788, 0, 46112},
        // Glass has no light of its own inside, where Haines asks for it.
        Counts{"mount", 173125, 354769, -1}}) {
    const std::string path = DataFolder() + "/spd/" + wanted.name + ".nff";
    if (IsSkipped(path)) continue;
    CAPTURE(wanted.name);
    const Scene scene = ReadOrFail(path);
    RenderOptions options;
    options.width = options.height = 513;
    options.max_depth = scene.settings.max_depth;
    options.layers.Add(Layer::kId);
    RenderStats stats;
    const Film film = RenderOrFail(scene, scene.cameras[0], options, &stats);
    const auto& ids = film.layers[static_cast<int>(Layer::kId)];
    const auto hits = std::count_if(ids.begin(), ids.end(), [](float id) { return id > 0; });
    CHECK(is_near(static_cast<double>(hits), wanted.hits));
    const auto& rays = stats.rays;
    const bool has_glass = rays.refracted > 0;
    const double traced = static_cast<double>(rays.reflected + rays.refracted - rays.beyond_depth);
    CHECK(is_near(has_glass ? traced / 2 : traced, wanted.reflected));
    if (wanted.shadow > 0) CHECK(is_near(static_cast<double>(rays.shadow), wanted.shadow));
  }
}

// Silhouettes, shadows and reflections: pixels that differ by more than a fifth lie on edges alone.
TEST_CASE("SPD: pictures are POV-Ray's") {
  if (!HasPovRay()) {
    MESSAGE("skipped: povray is not installed");
    return;
  }
  for (const char* name : {"balls", "tetra", "mount"}) {
    const std::string path = DataFolder() + "/spd/" + name + ".nff";
    if (IsSkipped(path)) continue;
    CAPTURE(name);
    const Scene scene = ReadOrFail(path);
    RenderOptions options;
    options.width = options.height = 256;
    options.max_depth = scene.settings.max_depth;
    const Film ours = RenderOrFail(scene, scene.cameras[0], options);
    const auto theirs =
        RenderWithPovRay(scene, scene.cameras[0], 256, 256, "-A", PovPicture::kRead);
    REQUIRE(theirs.ok());
    int differing = 0, silhouettes = 0;
    for (int y = 0; y < 256; ++y) {
      for (int x = 0; x < 256; ++x) {
        const float *a = ours.pixel(x, y), *b = theirs.value().film.pixel(x, y);
        double most = 0;
        bool is_background[2] = {true, true};
        for (int c = 0; c < 3; ++c) {
          const auto shown = [](float v) { return std::min(static_cast<double>(v), 1.0); };
          const double background = scene.settings.background[c];
          most = std::max(most, std::abs(shown(a[c]) - shown(b[c])));
          is_background[0] &= std::abs(shown(a[c]) - background) < 2e-3;
          is_background[1] &= std::abs(shown(b[c]) - background) < 2e-3;
        }
        differing += most > 0.2;
        silhouettes += is_background[0] != is_background[1];
      }
    }
    MESSAGE(name, ": ", differing, " pixels of 65536 differ by more than 0.2, ", silhouettes,
            " show background in one alone");
    CHECK(differing <= 65536 * 0.02);
    CHECK(silhouettes <= 65536 * 0.005);
  }
}

// The same number of triangles, the same box.
void CheckAgainstAssimp([[maybe_unused]] const std::string& path,
                        [[maybe_unused]] const Scene& scene) {
#ifdef SHEAF_HAS_ASSIMP
  Assimp::Importer importer;
  const aiScene* theirs =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices);
  REQUIRE(theirs != nullptr);
  std::size_t triangles = 0, our_triangles = 0;
  Vec3d low(1e30), high(-1e30);
  for (unsigned m = 0; m < theirs->mNumMeshes; ++m) {
    const aiMesh& mesh = *theirs->mMeshes[m];
    triangles += mesh.mNumFaces;
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const Vec3d p(mesh.mVertices[i].x, mesh.mVertices[i].y, mesh.mVertices[i].z);
      for (int k = 0; k < 3; ++k)
        low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    }
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    our_triangles += MeshAt(scene, i).triangles.size();
  }
  CHECK(our_triangles == triangles);
  const auto bounds = BoundsOf(scene);
  REQUIRE(bounds.has_value());
  for (int k = 0; k < 3; ++k) {
    CHECK(bounds->min[k] == doctest::Approx(low[k]).epsilon(1e-6));
    CHECK(bounds->max[k] == doctest::Approx(high[k]).epsilon(1e-6));
  }
#else
  MESSAGE("skipped: built without assimp");
#endif
}

TEST_CASE("glTF with both kinds of camera is what assimp says") {
  const Folder folder;
  const std::string path = folder.Write("a.gltf", SquareGltf().dump());
  CheckAgainstAssimp(path, ReadOrFail(path));
}

TEST_CASE("spot and FlightHelmet are what assimp says") {
  for (const char* name : {"spot.obj", "FlightHelmet/FlightHelmet.gltf"}) {
    const std::string path = DataFolder() + "/models/" + name;
    if (IsSkipped(path)) continue;
    const Scene scene = ReadOrFail(path);
    RenderOptions options;
    options.width = 64, options.height = 48;
    CheckSameBits(scene, scene.cameras[0], options);
    CheckAgainstAssimp(path, scene);
  }
}

}  // namespace
}  // namespace sheaf
