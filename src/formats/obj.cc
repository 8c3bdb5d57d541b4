#include "src/formats/obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <optional>
#include <utility>

#include "src/formats/mtl.h"
#include "src/formats/mtl_materials.h"
#include "src/formats/obj_statements.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/split_vertices.h"
#include "src/formats/suggest_name.h"
#include "src/formats/text_lines.h"
#include "src/formats/triangulate.h"

namespace sheaf {
namespace {

using Corner = ObjStatements::Corner;

// Meshes of statements: one a group and material, in the order of groups and, in each, of the
// libraries' materials.
class ObjBuilder {
 public:
  ObjBuilder(ObjStatements& from, const std::string& name, SceneFiles& files, Losses& losses,
             const MtlLibraries& libraries)
      : from_(from),
        name_(name),
        files_(files),
        losses_(losses),
        libraries_(libraries),
        splitter_(from.positions.size()) {}

  Scene Build() {
    const std::vector<int> materials = FindMaterials();
    // By group and material: runs.
    std::map<std::pair<std::uint32_t, int>, std::vector<const ObjStatements::Run*>> parts;
    std::vector<std::size_t> parts_of(from_.groups.size());
    for (const ObjStatements::Run& run : from_.runs) {
      auto& part = parts[{run.group, materials[run.name]}];
      parts_of[run.group] += part.empty();
      part.push_back(&run);
    }
    const std::map<int, std::uint32_t> indices = AddMaterials(parts);
    for (const auto& [key, runs] : parts) {
      const auto& [group, material] = key;
      Object object;
      object.name = parts_of[group] == 1 ? from_.groups[group] : "";
      object.material = indices.at(material);
      Mesh mesh = BuildMesh(runs);
      if (mesh.triangles.empty()) continue;
      object.shape = std::move(mesh);
      scene_.objects.push_back(std::move(object));
    }
    return std::move(scene_);
  }

 private:
  static constexpr int kPlain = -1;  // no material of a library

  // By name: which material of the libraries.
  std::vector<int> FindMaterials() {
    std::vector<int> materials;
    std::vector<std::string_view> known;
    for (const MtlMaterial& material : libraries_.materials()) known.push_back(material.name);
    for (const auto& [name, line] : from_.names) {
      const auto found = libraries_.Find(name);
      materials.push_back(found ? static_cast<int>(*found) : kPlain);
      if (found || name.empty() || !libraries_.has_library()) continue;
      files_.Warn(
          PlaceOf(name_, line), "usemtl",
          fmt::format("no material \"{}\", so grey{}", Printable(name), DidYouMean(name, known)));
    }
    return materials;
  }

  // Those in use, in the order of the libraries, and the plain one behind them.
  template <typename Parts>
  std::map<int, std::uint32_t> AddMaterials(const Parts& parts) {
    MtlMaterials made(files_);
    std::map<int, std::uint32_t> indices;
    for (const auto& [key, runs] : parts) indices[key.second] = 0;
    for (auto& [material, index] : indices) {
      if (material == kPlain) continue;
      index = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(
          made.Make(libraries_.materials()[static_cast<std::size_t>(material)]));
    }
    if (const auto plain = indices.find(kPlain); plain != indices.end()) {
      plain->second = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(PlainMaterial());
    }
    return indices;
  }

  std::span<Corner> CornersOf(std::size_t face) {
    const std::size_t first = from_.faces[face].first_corner;
    return std::span(from_.corners).subspan(first, from_.faces[face + 1].first_corner - first);
  }

  Mesh BuildMesh(const std::vector<const ObjStatements::Run*>& runs) {
    faces_.clear();
    has_uv_ = has_normals_ = false;
    for (const ObjStatements::Run* run : runs) {
      for (std::size_t face = run->first_face; face < run->end_face; ++face) {
        if (IsSound(face)) faces_.push_back(face);
      }
    }
    Mesh mesh;
    mesh.triangles.reserve(faces_.size());
    splitter_.Clear();
    for (const std::size_t face : faces_) {
      polygon_.clear();
      for (const Corner& corner : CornersOf(face)) polygon_.push_back(VertexOf(corner, mesh));
      Triangulate(mesh.positions, polygon_, mesh.triangles);
    }
    const bool is_white = std::all_of(mesh.colours.begin(), mesh.colours.end(),
                                      [](const glm::vec3& c) { return c == glm::vec3(1); });
    if (is_white) mesh.colours.clear();
    return mesh;
  }

  // Whether the face has its vertices. Coordinates and normals that are not there are left out.
  bool IsSound(std::size_t face) {
    const auto lose = [&](std::string_view kind, std::string_view why) {
      losses_.LeaveOut(PlaceOf(name_, from_.faces[face].line), kind, why);
      return false;
    };
    // NaN stands for a statement that was left out: then its loss was said there.
    const auto check = [&](std::int32_t& index, const auto& all, std::string_view what) {
      if (index == kObjNone) return;
      const auto i = static_cast<std::size_t>(index);
      if (i >= all.size()) {
        lose(fmt::format("{} left out", what), fmt::format("{} {} of {}", what, i + 1, all.size()));
      }
      if (i >= all.size() || std::isnan(all[i].x)) index = kObjNone;
    };
    for (Corner& corner : CornersOf(face)) {
      const auto i = static_cast<std::size_t>(corner.position);
      if (i >= from_.positions.size()) {
        return lose("face left out", fmt::format("vertex {} of {}", i + 1, from_.positions.size()));
      }
      if (std::isnan(from_.positions[i].x)) {
        return lose("face left out", fmt::format("vertex {} is not sound", i + 1));
      }
      check(corner.uv, from_.uv, "texture coordinate");
      check(corner.normal, from_.normals, "normal");
      has_uv_ |= corner.uv != kObjNone;
      has_normals_ |= corner.normal != kObjNone;
    }
    return true;
  }

  std::uint32_t VertexOf(const Corner& corner, Mesh& mesh) {
    const auto position = static_cast<std::size_t>(corner.position);
    const auto [vertex, is_new] = splitter_.Find(position, corner);
    if (!is_new) return vertex;
    mesh.positions.push_back(from_.positions[position]);
    if (has_normals_) {
      mesh.normals.push_back(corner.normal == kObjNone
                                 ? glm::vec3(0)
                                 : from_.normals[static_cast<std::size_t>(corner.normal)]);
    }
    if (has_uv_) {
      glm::vec2 uv(0);
      if (corner.uv != kObjNone) {
        uv = from_.uv[static_cast<std::size_t>(corner.uv)];
        uv = glm::vec2(uv.x, 1 - uv.y);
      }
      mesh.uv.push_back(uv);
    }
    if (!from_.colours.empty()) {
      mesh.colours.push_back(position < from_.colours.size() ? from_.colours[position]
                                                             : glm::vec3(1));
    }
    return vertex;
  }

  ObjStatements& from_;
  const std::string& name_;
  SceneFiles& files_;
  Losses& losses_;
  const MtlLibraries& libraries_;
  Scene scene_;
  bool has_uv_ = false, has_normals_ = false;  // of the mesh in work
  std::vector<std::size_t> faces_;             // likewise
  std::vector<std::uint32_t> polygon_;
  VertexSplitter<Corner> splitter_;
};

}  // namespace

Result<Scene> ParseObj(std::string_view original, const std::string& name, SceneFiles& files) {
  std::string changed = DecodeUtf16(original);
  std::string_view text = changed.empty() ? original : changed;
  if (text.find('\\') != std::string_view::npos) {
    changed = JoinLines(text);
    text = changed;
  }
  Losses losses(files);
  MtlLibraries libraries(name, files);
  ObjStatements statements = ReadObjStatements(text, name, files, losses, libraries);
  Scene scene = ObjBuilder(statements, name, files, losses, libraries).Build();
  if (!scene.objects.empty()) return scene;
  return losses.first() ? *losses.first() : SceneError(name, "no face");
}

}  // namespace sheaf
