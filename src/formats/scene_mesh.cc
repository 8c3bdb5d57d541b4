#include "src/formats/scene_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace sheaf {
namespace {

template <typename Vector>
void ReadVectors(const JsonCursor& list, const NumberRange& range, std::string_view expected,
                 std::vector<Vector>* out) {
  list.ForEachElement([&](const JsonCursor& element) {
    Vector vector(0);
    if (const auto numbers = element.ReadTuple<Vector::length()>(expected)) {
      for (int i = 0; i < Vector::length(); ++i) {
        double number = 0;
        (*numbers)[static_cast<std::size_t>(i)].Read(range, &number);
        vector[i] = static_cast<float>(number);
      }
    }
    out->push_back(vector);
  });
}

template <typename Vector>
Json VectorsJson(const std::vector<Vector>& vectors) {
  Json json = Json::array();
  for (const Vector& vector : vectors) {
    Json numbers = Json::array();
    // 1e30 as a float lies above 1e30, and is what the reader makes of 1e30 again.
    for (int i = 0; i < Vector::length(); ++i) {
      numbers.push_back(
          std::clamp(static_cast<double>(vector[i]), -kMaxCoordinate, kMaxCoordinate));
    }
    json.push_back(std::move(numbers));
  }
  return json;
}

void ReadNumbers(const JsonCursor& list, const NumberRange& range, std::vector<float>* out) {
  list.ForEachElement([&](const JsonCursor& element) {
    double number = 0;
    element.Read(range, &number);
    out->push_back(static_cast<float>(number));
  });
}

}  // namespace

Mesh ReadMesh(const JsonCursor& value) {
  Mesh mesh;
  JsonObject object(value);
  ReadVectors(object.Required("positions"), kCoordinate, "[x, y, z]", &mesh.positions);
  const auto check_count = [&](const JsonCursor& list, std::size_t count) {
    if (!list.present() || count == mesh.positions.size()) return;
    list.Fail(fmt::format("{} elements for {} positions", count, mesh.positions.size()));
  };
  const auto of_vertices = [&](const char* key, const NumberRange& range, std::string_view expected,
                               auto* out) {
    const JsonCursor list = object.Optional(key);
    ReadVectors(list, range, expected, out);
    check_count(list, out->size());
  };
  of_vertices("normals", kCoordinate, "[x, y, z]", &mesh.normals);
  of_vertices("uv", kCoordinate, "[u, v]", &mesh.uv);
  of_vertices("uv2", kCoordinate, "[u, v]", &mesh.uv2);
  of_vertices("colours", kStrength, "[r, g, b]", &mesh.colours);
  const JsonCursor alphas = object.Optional("alphas");
  ReadNumbers(alphas, kFraction, &mesh.alphas);
  check_count(alphas, mesh.alphas.size());
  const double last = static_cast<double>(mesh.positions.size()) - 1;
  const std::string text = fmt::format("an integer in [0, {}]", last);
  object.Required("triangles").ForEachElement([&](const JsonCursor& element) {
    std::array<std::uint32_t, 3> triangle{};
    if (const auto corners = element.ReadTuple<3>("3 positions by number")) {
      for (std::size_t i = 0; i < 3; ++i) {
        int corner = 0;
        (*corners)[i].ReadInteger({0, last, text}, &corner);
        triangle[i] = static_cast<std::uint32_t>(corner);
      }
    }
    mesh.triangles.push_back(triangle);
  });
  object.Finish();
  return mesh;
}

Json MeshJson(const Mesh& mesh) {
  Json json = {{"positions", VectorsJson(mesh.positions)}};
  if (!mesh.normals.empty()) json["normals"] = VectorsJson(mesh.normals);
  if (!mesh.uv.empty()) json["uv"] = VectorsJson(mesh.uv);
  if (!mesh.uv2.empty()) json["uv2"] = VectorsJson(mesh.uv2);
  if (!mesh.colours.empty()) json["colours"] = VectorsJson(mesh.colours);
  if (!mesh.alphas.empty()) json["alphas"] = mesh.alphas;
  json["triangles"] = mesh.triangles;
  return json;
}

}  // namespace sheaf
