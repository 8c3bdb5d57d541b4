#include "src/formats/scene_shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <variant>

#include "src/core/match.h"
#include "src/formats/scene_mesh.h"
#include "src/formats/scene_values.h"

namespace sheaf {
namespace {

// With `cells` up to 65536 a cell number, and the sum of two, fits 32 bits.
constexpr NumberRange kSurfaceCoordinate{-8192.0, 8192.0, "a number in [-8192, 8192]"};

// An empty string where the corners form a quad, else what is wrong.
std::string_view CheckQuad(const std::array<Vec3d, 4>& corners) {
  // Relative to the first corner and scaled to [-1, 1], so that tolerances are relative.
  std::array<Vec3d, 4> p;
  double size = 0.0;
  for (int i = 0; i < 4; ++i) {
    p[i] = corners[i] - corners[0];
    size = std::max({size, std::abs(p[i].x), std::abs(p[i].y), std::abs(p[i].z)});
  }
  if (!(size > 0.0)) return "the quad has no area: its corners coincide";
  for (Vec3d& point : p) point /= size;

  constexpr double kNoArea = 1e-12;
  constexpr double kFlatness = 1e-6;
  const Vec3d first = glm::cross(p[1], p[2]);
  const Vec3d second = glm::cross(p[2], p[3]);
  if (glm::length(first) <= kNoArea) return "the quad has no area between its corners 0, 1 and 2";
  if (glm::length(second) <= kNoArea) return "the quad has no area between its corners 0, 2 and 3";
  const Vec3d normal = first / glm::length(first);
  if (std::abs(glm::dot(normal, p[3])) > kFlatness) return "the four corners are not in one plane";

  // Each corner turns the same way; a corner on the line between its neighbours is allowed.
  const bool is_convex = glm::dot(normal, second) > 0.0 &&
                         glm::dot(normal, glm::cross(p[2] - p[1], p[3] - p[1])) >= -kNoArea &&
                         glm::dot(normal, glm::cross(p[3] - p[1], p[0] - p[1])) >= -kNoArea;
  return is_convex ? "" : "the corners, in this order, do not form a convex quad";
}

template <std::size_t count>
bool ReadPoints(const JsonCursor& value, std::string_view expected,
                std::array<Vec3d, count>* points) {
  const auto elements = value.ReadTuple<count>(expected);
  if (!elements) return false;
  bool is_right = true;
  for (std::size_t i = 0; i < count; ++i) is_right &= ReadVector((*elements)[i], &(*points)[i]);
  return is_right;
}

Json PointsJson(const auto& points) {
  Json json = Json::array();
  for (const Vec3d& point : points) json.push_back(VectorJson(point));
  return json;
}

Shape ReadSphere(const JsonCursor& value) {
  Sphere sphere;
  JsonObject object(value);
  ReadVector(object.Required("center"), &sphere.center);
  object.Required("radius").Read(kRadius, &sphere.radius);
  object.Finish();
  return sphere;
}

Shape ReadDisk(const JsonCursor& value) {
  Disk disk;
  JsonObject object(value);
  ReadVector(object.Required("center"), &disk.center);
  object.Required("radius").Read(kRadius, &disk.radius);
  if (const JsonCursor normal = object.Optional("normal"); normal.present()) {
    ReadDirection(normal, &disk.normal);
  }
  object.Finish();
  return disk;
}

// A quad that is degenerate, bent (by more than 1e-6 of its size) or not convex is an error.
Shape ReadQuad(const JsonCursor& value) {
  Quad quad{};
  JsonObject object(value);
  const JsonCursor corners = object.Required("corners");
  if (ReadPoints(corners, "4 points [x, y, z]", &quad.corners)) {
    const std::string_view fault = CheckQuad(quad.corners);
    if (!fault.empty()) corners.Fail(fault);
  }
  object.Finish();
  return quad;
}

// A triangle without area is valid: it is never hit.
Shape ReadTriangle(const JsonCursor& value) {
  Triangle triangle{};
  JsonObject object(value);
  ReadPoints(object.Required("vertices"), "3 points [x, y, z]", &triangle.vertices);
  if (const auto uv = object.Optional("uv").ReadTuple<3>("3 pairs [u, v]")) {
    for (std::size_t i = 0; i < 3; ++i) {
      ReadPair((*uv)[i], kSurfaceCoordinate, "[u, v]", &triangle.uv[i]);
    }
  }
  object.Finish();
  return triangle;
}

Json TriangleJson(const Triangle& triangle) {
  Json json = {{"vertices", PointsJson(triangle.vertices)}};
  if (triangle.uv == Triangle{}.uv) return json;
  Json uv = Json::array();
  for (const glm::dvec2& p : triangle.uv) uv.push_back(Json{p.x, p.y});
  json["uv"] = uv;
  return json;
}

// A mesh's file is the reader's business whose scene this is.
constexpr KeyedReader<Shape> kShapes[] = {
    {"sphere", &ReadSphere},
    {"disk", &ReadDisk},
    {"quad", &ReadQuad},
    {"triangle", &ReadTriangle},
    {"mesh", [](const JsonCursor& value) -> Shape { return ReadMesh(value); }}};

}  // namespace

std::vector<std::string_view> ShapeKeys() {
  const auto keys = KeysOf(kShapes);
  return {keys.begin(), keys.end()};
}

Shape ReadShape(const JsonCursor& value) { return ReadByKey(value, kShapes); }

Json ShapeJson(const Shape& shape) {
  return Match(
      shape,
      [](const Sphere& sphere) -> Json {
        return {{"sphere", {{"center", VectorJson(sphere.center)}, {"radius", sphere.radius}}}};
      },
      [](const Disk& disk) -> Json {
        return {{"disk",
                 {{"center", VectorJson(disk.center)},
                  {"radius", disk.radius},
                  {"normal", VectorJson(disk.normal)}}}};
      },
      [](const Quad& quad) -> Json {
        return {{"quad", {{"corners", PointsJson(quad.corners)}}}};
      },
      [](const Triangle& triangle) -> Json {
        return {{"triangle", TriangleJson(triangle)}};
      },
      [](const Mesh& mesh) -> Json {
        return {{"mesh", MeshJson(mesh)}};
      });
}

}  // namespace sheaf
