#include "src/formats/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "src/formats/image.h"
#include "src/formats/losses.h"
#include "src/formats/ply_body.h"
#include "src/formats/ply_header.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/scene_mesh.h"
#include "src/formats/split_vertices.h"
#include "src/formats/text_lines.h"
#include "src/formats/triangulate.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

constexpr double kMaxCorners = 1 << 20;

using Slots = double[kPlySlots + 1];

// What corners of one vertex may differ in.
struct CornerKey {
  glm::vec3 colour{0.0f};
  glm::vec2 uv{0.0f};
  bool operator==(const CornerKey&) const = default;
};

// Elements one after another, into one mesh.
class ElementReader {
 public:
  ElementReader(const PlyHeader& header, const std::string& name, SceneFiles& files)
      : header_(header), name_(name), files_(files), losses_(files), body_(header) {
    const auto has_colours = [&](PlyKind kind) {
      return std::any_of(header.elements.begin(), header.elements.end(),
                         [kind](const PlyElement& e) { return e.kind == kind && e.Has(kRed, 3); });
    };
    // Colours of vertices are finer than those of faces.
    has_face_colours_ = has_colours(PlyKind::kFaces) && !has_colours(PlyKind::kVertices);
    for (const PlyElement& element : header.elements) {
      has_corner_uv_ |= element.HasList(PlyList::kCoordinates);
      has_textures_ |= element.has[kTexture] && header.textures.size() > 1;
    }
  }

  // False with an error. Elements behind the last face are nobody's business.
  bool Read() {
    std::size_t end = header_.elements.size();
    while (end > 0 && header_.elements[end - 1].kind == PlyKind::kSkipped) --end;
    for (const PlyElement& element : std::span(header_.elements).first(end)) {
      const bool splits = has_face_colours_ || has_corner_uv_;
      if (splits && !splitter_ && element.HasList(PlyList::kIndices)) {
        splitter_.emplace(vertices_.positions.size());
      }
      for (std::uint64_t i = 0; i < element.count; ++i) {
        if (!ReadElement(element, i)) return false;
      }
    }
    if (triangles_.empty()) {
      error_ = losses_.first() ? *losses_.first() : SceneError(name_, "no face");
    }
    return !error_;
  }

  const Error& error() const { return *error_; }

  Mesh TakeMesh() {
    Mesh mesh = std::move(splitter_ ? split_ : vertices_);
    mesh.triangles = std::move(triangles_);
    return mesh;
  }
  // Of each triangle; empty where all have the first.
  const std::vector<std::uint32_t>& textures() const { return textures_; }

 private:
  std::string Place() const {
    return body_.is_text() ? PlaceOf(name_, body_.line()) : PlaceOf(name_);
  }

  static std::string InElement(const PlyElement& element, std::uint64_t index,
                               std::string_view what) {
    return fmt::format("{} {}: {}", Printable(element.name, 40), index, what);
  }
  bool Fail(const PlyElement& element, std::uint64_t index, std::string_view what) {
    const std::string text = InElement(element, index, what);
    error_ = body_.is_text() ? SceneErrorAt(name_, body_.line(), text) : SceneError(name_, text);
    return false;
  }
  bool FailCut(const PlyElement& element, std::uint64_t index) {
    return Fail(element, index,
                body_.is_text() && !body_.is_at_end()
                    ? "expected a number"
                    : fmt::format("the file ends here, with {} of them promised", element.count));
  }

  // ---- Any element ----

  bool ReadElement(const PlyElement& element, std::uint64_t index) {
    Slots slots = {};
    indices_.clear();
    coordinates_.clear();
    for (const PlyProperty& property : element.properties) {
      double value = 0;
      if (!body_.Read(property.count_type.value_or(property.type), &value)) {
        return FailCut(element, index);
      }
      if (!property.count_type) {
        slots[property.slot] = Scaled(property, value);
        continue;
      }
      if (!(value >= 0)) return Fail(element, index, "a list of negative length");
      if (element.kind == PlyKind::kFaces && property.list == PlyList::kIndices &&
          value > kMaxCorners) {
        return Fail(element, index, fmt::format("{} corners", value));
      }
      if (!ReadList(property, value)) return FailCut(element, index);
    }
    if (element.has[kAlpha] && slots[kAlpha] < 1) {
      files_.Warn(Place(), "alpha is not read: all is opaque");
    }
    if (element.kind == PlyKind::kVertices) AddVertex(element, index, slots);
    if (element.kind == PlyKind::kFaces) AddFace(element, index, slots);
    if (element.kind == PlyKind::kStrips) AddStrips(element, index);
    return true;
  }

  bool ReadList(const PlyProperty& property, double count) {
    std::vector<double>* const to = property.list == PlyList::kIndices       ? &indices_
                                    : property.list == PlyList::kCoordinates ? &coordinates_
                                                                             : nullptr;
    for (double i = 0; i < count; ++i) {
      double value = 0;
      if (!body_.Read(property.type, &value)) return false;
      if (to != nullptr) to->push_back(value);
    }
    return true;
  }

  // Colours of integers span their type.
  static double Scaled(const PlyProperty& property, double value) {
    if (property.slot < kRed || property.slot > kAlpha || property.type >= PlyType::kFloat) {
      return value;
    }
    const double most = property.type == PlyType::kUint16 ? 65535.0 : 255.0;
    const double share = std::clamp(value / most, 0.0, 1.0);
    return property.slot == kAlpha ? share : SrgbDecode(share);
  }

  static bool IsSound(const Slots& slots, PlySlot first, int count) {
    return std::all_of(slots + first, slots + first + count, [](double value) {
      return std::abs(value) <= kMaxCoordinate;  // false for NaN
    });
  }

  static glm::vec3 ColourIn(const Slots& slots) {
    return VertexColour(glm::vec3(slots[kRed], slots[kGreen], slots[kBlue]));
  }

  // ---- Vertices ----

  void AddVertex(const PlyElement& element, std::uint64_t index, const Slots& slots) {
    const auto sound = [&](PlySlot first, int count, std::string_view kind) {
      const bool is_sound = IsSound(slots, first, count);
      if (!is_sound) {
        losses_.LeaveOut(Place(), kind,
                         InElement(element, index, "a number is not finite, or beyond 1e30"));
      }
      return is_sound;
    };
    const bool is_there = sound(kX, 3, "vertex left out");
    vertices_.positions.push_back(is_there ? glm::vec3(slots[kX], slots[kY], slots[kZ])
                                           : glm::vec3(0));
    if (!is_there) {
      unsound_.resize(vertices_.positions.size());
      unsound_.back() = true;
    }
    if (element.Has(kNx, 3)) {
      vertices_.normals.push_back(sound(kNx, 3, "normal left out")
                                      ? glm::vec3(slots[kNx], slots[kNy], slots[kNz])
                                      : glm::vec3(0));
    }
    if (element.Has(kU, 2)) {
      vertices_.uv.push_back(sound(kU, 2, "texture coordinate left out")
                                 ? glm::vec2(slots[kU], 1 - slots[kV])
                                 : glm::vec2(0));
    }
    if (element.Has(kRed, 3)) {
      vertices_.colours.push_back(sound(kRed, 3, "colour left out") ? ColourIn(slots)
                                                                    : glm::vec3(1));
    }
  }

  // ---- Faces ----

  // Whether a face may have this vertex; says why not.
  bool IsVertex(double vertex, const PlyElement& element, std::uint64_t index) {
    const std::size_t count = vertices_.positions.size();
    const bool exists = vertex >= 0 && vertex < static_cast<double>(count);
    if (exists && vertex == std::floor(vertex)) {
      const auto i = static_cast<std::size_t>(vertex);
      if (i >= unsound_.size() || !unsound_[i]) return true;
    }
    LeaveOutFace(element, index,
                 exists ? fmt::format("vertex {} is not sound", vertex)
                        : fmt::format("vertex {} of {}", vertex, count));
    return false;
  }

  void LeaveOutFace(const PlyElement& element, std::uint64_t index, std::string_view why) {
    losses_.LeaveOut(Place(), "face left out", InElement(element, index, why));
  }

  void AddFace(const PlyElement& element, std::uint64_t index, const Slots& slots) {
    polygon_.clear();
    for (const double vertex : indices_) {
      if (!IsVertex(vertex, element, index)) return;
      polygon_.push_back(static_cast<std::uint32_t>(vertex));
    }
    if (polygon_.size() < 3) return LeaveOutFace(element, index, "fewer than 3 corners");
    CornerKey face;
    if (has_face_colours_ && IsSound(slots, kRed, 3)) face.colour = ColourIn(slots);
    bool has_uv = has_corner_uv_ && coordinates_.size() == 2 * polygon_.size();
    if (has_uv) {
      has_uv = std::all_of(coordinates_.begin(), coordinates_.end(),
                           [](double x) { return std::abs(x) <= kMaxCoordinate; });
    }
    if (has_corner_uv_ && !has_uv && !coordinates_.empty()) {
      losses_.LeaveOut(Place(), "texture coordinate left out",
                       InElement(element, index,
                                 fmt::format("{} corners have not two sound numbers each in {}",
                                             polygon_.size(), coordinates_.size())));
    }
    for (std::size_t i = 0; splitter_ && i < polygon_.size(); ++i) {
      CornerKey key = face;
      if (has_uv) {
        key.uv = glm::vec2(coordinates_[2 * i], 1 - coordinates_[2 * i + 1]);
      } else if (!vertices_.uv.empty()) {
        key.uv = vertices_.uv[polygon_[i]];
      }
      polygon_[i] = SplitVertex(polygon_[i], key);
    }
    Triangulate(splitter_ ? split_.positions : vertices_.positions, polygon_, triangles_);
    const bool is_number = slots[kTexture] >= 0 && slots[kTexture] < kMaxCorners;
    SetTexture(is_number ? static_cast<std::uint32_t>(slots[kTexture]) : kNoTexture);
  }

  // Of the triangles since the last call.
  void SetTexture(std::uint32_t number) {
    if (has_textures_) textures_.resize(triangles_.size(), number);
  }

  std::uint32_t SplitVertex(std::uint32_t vertex, const CornerKey& key) {
    const auto [split, is_new] = splitter_->Find(vertex, key);
    if (!is_new) return split;
    const bool has_uv = has_corner_uv_ || !vertices_.uv.empty();
    split_.positions.push_back(vertices_.positions[vertex]);
    if (!vertices_.normals.empty()) split_.normals.push_back(vertices_.normals[vertex]);
    if (has_uv) split_.uv.push_back(key.uv);
    if (has_face_colours_) split_.colours.push_back(key.colour);
    if (!vertices_.colours.empty()) split_.colours.push_back(vertices_.colours[vertex]);
    return split;
  }

  // Strips with -1 between them; every other triangle of a strip is turned. Those that repeat a
  // vertex only lead from one part of a strip to the next.
  void AddStrips(const PlyElement& element, std::uint64_t index) {
    polygon_.clear();
    for (const double vertex : indices_) {
      if (vertex == -1 || !IsVertex(vertex, element, index)) {
        polygon_.clear();
        continue;
      }
      polygon_.push_back(static_cast<std::uint32_t>(vertex));
      const std::size_t n = polygon_.size();
      if (n < 3) continue;
      std::array<std::uint32_t, 3> triangle{polygon_[n - 3], polygon_[n - 2], polygon_[n - 1]};
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        continue;
      }
      if (n % 2 == 0) std::swap(triangle[0], triangle[1]);
      for (std::uint32_t& corner : triangle) {
        if (!splitter_) break;
        const glm::vec2 uv = vertices_.uv.empty() ? glm::vec2(0) : vertices_.uv[corner];
        corner = SplitVertex(corner, {glm::vec3(1), uv});
      }
      triangles_.push_back(triangle);
    }
    SetTexture(0);
  }

  static constexpr std::uint32_t kNoTexture = 0xffffffffu;

  const PlyHeader& header_;
  const std::string& name_;
  SceneFiles& files_;
  Losses losses_;
  PlyBody body_;
  std::optional<Error> error_;
  Mesh vertices_;              // as they are in the file
  std::vector<bool> unsound_;  // of the first vertices; the others are sound
  Mesh split_;                 // those of faces that have colours or coordinates
  std::optional<VertexSplitter<CornerKey>> splitter_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<std::uint32_t> textures_;  // by triangle
  bool has_face_colours_ = false, has_corner_uv_ = false, has_textures_ = false;
  std::vector<double> indices_, coordinates_;  // the lists of the element in work
  std::vector<std::uint32_t> polygon_;
};

// The triangles of `mesh` that are of one texture, and their vertices.
Mesh PartOf(const Mesh& mesh, const std::vector<std::uint32_t>& textures, std::uint32_t texture) {
  Mesh part;
  VertexSplitter<bool> vertices(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (textures[i] != texture) continue;
    std::array<std::uint32_t, 3> triangle = mesh.triangles[i];
    for (std::uint32_t& corner : triangle) {
      const auto [vertex, is_new] = vertices.Find(corner, true);
      if (is_new) {
        part.positions.push_back(mesh.positions[corner]);
        if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[corner]);
        if (!mesh.uv.empty()) part.uv.push_back(mesh.uv[corner]);
        if (!mesh.colours.empty()) part.colours.push_back(mesh.colours[corner]);
      }
      corner = vertex;
    }
    part.triangles.push_back(triangle);
  }
  return part;
}

// The image of a texture; null, with a warning, where there is none to show.
std::shared_ptr<const Image> LoadTexture(const PlyTexture& texture, const Mesh& mesh,
                                         const std::string& name, SceneFiles& files,
                                         ImageCache& images) {
  const auto image = images.Load(name, WithSlashes(texture.file), files);
  if (image && !mesh.uv.empty()) return image.value();
  files.Warn(PlaceOf(name, texture.line), "TextureFile",
             fmt::format("{}; untextured",
                         image ? "there are no texture coordinates" : image.error().message));
  return nullptr;
}

}  // namespace

Result<Scene> ParsePlyScene(std::string_view text, const std::string& name, SceneFiles& files) {
  const Result<PlyHeader> header = ReadPlyHeader(text, name, files);
  if (!header) return header.error();
  ElementReader reader(header.value(), name, files);
  if (!reader.Read()) return reader.error();
  const std::vector<std::uint32_t>& textures = reader.textures();
  Mesh whole = reader.TakeMesh();
  Scene scene;
  ImageCache images;
  const auto add = [&](Mesh mesh, std::size_t texture) {
    const auto index = static_cast<std::uint32_t>(scene.materials.size());
    scene.materials.push_back(PlainMaterial());
    if (!mesh.colours.empty()) scene.materials.back().base_colour = Colour(1.0);
    const bool exists = texture < header.value().textures.size();
    auto image =
        exists ? LoadTexture(header.value().textures[texture], mesh, name, files, images) : nullptr;
    if (image) {
      mesh.colours.clear();  // those of scans are the texture's once more
      Texture base;
      base.image = std::move(image);
      scene.materials.back().base_colour = base;
    }
    scene.objects.push_back({"", std::move(mesh), index});
  };
  if (textures.empty()) {
    add(std::move(whole), 0);
  } else {
    for (const std::uint32_t texture : std::set(textures.begin(), textures.end())) {
      add(PartOf(whole, textures, texture), texture);
    }
  }
  return scene;
}

}  // namespace sheaf
