#include "src/formats/obj.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <istream>
#include <map>
#include <optional>
#include <streambuf>
#include <utility>

#include "src/formats/image.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/suggest_name.h"
#include "src/formats/text_scanner.h"

namespace sheaf {
namespace {

// ---- Whether the text is sound ----

class ObjChecker {
 public:
  ObjChecker(std::string_view text, const std::string& name) : scanner_(text), name_(name) {}

  Status Check() {
    while (!error_ && scanner_.NextLine()) {
      const std::string_view word = scanner_.Word();
      if (word == "v")
        CheckNumbers(3, &vertices_);
      else if (word == "vn")
        CheckNumbers(3, &normals_);
      else if (word == "vt")
        CheckNumbers(1, &coordinates_);
      else if (word == "f")
        CheckFace();
      else if (word == "usemtl")
        materials_.try_emplace(std::string(scanner_.Word()), scanner_.line());
    }
    // Faces may refer to what comes after them.
    for (const auto& [used, given, what] :
         {std::tuple(&most_vertex_, vertices_, "vertex"),
          std::tuple(&most_coordinate_, coordinates_, "texture coordinate"),
          std::tuple(&most_normal_, normals_, "normal")}) {
      if (!error_ && used->index > given) {
        error_ =
            SceneErrorAt(name_, used->line, fmt::format("{} {} of {}", what, used->index, given));
      }
    }
    if (!error_ && faces_ == 0) error_ = SceneError(name_, "no face");
    return error_ ? Status(*error_) : Status(Done{});
  }

  // The names that faces use, with the line of the first use.
  const std::map<std::string, std::size_t>& materials() const { return materials_; }

 private:
  struct Highest {
    std::uint64_t index = 0;
    std::size_t line = 0;
  };

  void Fail(std::string_view what) {
    if (!error_) error_ = SceneErrorAt(name_, scanner_.line(), what);
  }

  void CheckNumbers(int at_least, std::uint64_t* count) {
    int numbers = 0;
    for (std::string_view word = scanner_.Word(); !word.empty() && word.front() != '#';
         word = scanner_.Word()) {
      const auto number = ParseWord<double>(word);
      if (!number) return Fail(fmt::format("expected a number, found \"{}\"", Printable(word, 40)));
      if (!(std::abs(*number) <= kMaxCoordinate)) {
        return Fail(fmt::format("\"{}\" is not finite, or beyond 1e30", Printable(word, 40)));
      }
      ++numbers;
    }
    if (numbers < at_least) return Fail(fmt::format("{} numbers of {}", numbers, at_least));
    ++*count;
  }

  void CheckFace() {
    int corners = 0;
    for (std::string_view word = scanner_.Word(); !word.empty() && word.front() != '#';
         word = scanner_.Word()) {
      ++corners;
      const std::size_t slash = std::min(word.find('/'), word.size());
      std::string_view rest = word.substr(slash);
      if (!CheckIndex(word.substr(0, slash), vertices_, "vertex", &most_vertex_)) return;
      if (rest.empty()) continue;
      rest.remove_prefix(1);
      const std::size_t second = std::min(rest.find('/'), rest.size());
      if (second > 0 && !CheckIndex(rest.substr(0, second), coordinates_, "texture coordinate",
                                    &most_coordinate_)) {
        return;
      }
      if (second == rest.size()) continue;
      if (!CheckIndex(rest.substr(second + 1), normals_, "normal", &most_normal_)) return;
    }
    if (corners < 3) return Fail(fmt::format("a face of {} corners", corners));
    ++faces_;
  }

  bool CheckIndex(std::string_view word, std::uint64_t given, const char* what, Highest* most) {
    const auto index = ParseWord<std::int64_t>(word);
    if (!index || *index == 0 || *index > 0x7fffffff) {
      Fail(fmt::format("expected the number of a {}, found \"{}\"", what, Printable(word, 40)));
      return false;
    }
    if (*index < 0 && static_cast<std::uint64_t>(-*index) > given) {
      Fail(fmt::format("{} {} of {}", what, *index, given));
      return false;
    }
    if (*index > 0 && static_cast<std::uint64_t>(*index) > most->index) {
      *most = {static_cast<std::uint64_t>(*index), scanner_.line()};
    }
    return true;
  }

  TextScanner scanner_;
  const std::string& name_;
  std::optional<Error> error_;
  std::uint64_t vertices_ = 0, normals_ = 0, coordinates_ = 0, faces_ = 0;
  Highest most_vertex_, most_normal_, most_coordinate_;
  std::map<std::string, std::size_t> materials_;
};

// A line that ends in a backslash goes on in the next. The joined line is followed by as many empty
// ones, so that the others keep their numbers. Comments go on nowhere: paths of Windows are in
// them.
std::string JoinLines(std::string_view text) {
  std::string joined;
  joined.reserve(text.size());
  std::size_t owed = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    TextScanner words(line);
    const bool is_comment = owed == 0 && words.NextLine() && words.Word().starts_with('#');
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.ends_with('\\') && !is_comment) {
      joined.append(line.substr(0, line.size() - 1)) += ' ';
      ++owed;
    } else {
      joined.append(line).append(owed + 1, '\n');
      owed = 0;
    }
  }
  return joined;
}

// Numbers where numbers belong: the library takes anything else for 0.
Status CheckMtl(std::string_view text, const std::string& path) {
  TextScanner scanner(text);
  while (scanner.NextLine()) {
    const std::string_view key = scanner.Word();
    const bool is_colour = key == "Kd" || key == "Ks" || key == "Ke" || key == "Ka";
    const bool is_number = key == "Ns" || key == "Ni" || key == "d" || key == "Tr";
    if (!is_colour && !is_number) continue;
    for (int i = 0; i < (is_colour ? 3 : 1); ++i) {
      const std::string_view word = scanner.Word();
      if (is_colour && (word == "spectral" || word == "xyz")) break;
      if (key == "d" && word == "-halo") continue;
      const auto number = ParseWord<double>(word);
      if (is_colour && i > 0 && word.empty()) break;  // one number for all three
      if (!number || !(*number >= -1e6 && *number <= 1e9)) {
        return SceneErrorAt(path, scanner.line(),
                            fmt::format("{}: expected a number in [-1e6, 1e9], found \"{}\"",
                                        Printable(key, 40), Printable(word, 40)));
      }
    }
  }
  return Done{};
}

// ---- Reading ----

// A stream over bytes that are there already.
class ViewBuffer : public std::streambuf {
 public:
  explicit ViewBuffer(std::string_view text) {
    char* const begin = const_cast<char*>(text.data());
    setg(begin, begin, begin + text.size());
  }
};

class MtlReader : public tinyobj::MaterialReader {
 public:
  MtlReader(const std::string& name, SceneFiles& files) : name_(name), files_(files) {}

  bool operator()(const std::string& reference, std::vector<tinyobj::material_t>* materials,
                  std::map<std::string, int>* by_name, std::string*, std::string*) override {
    const Result<std::string> path = files_.Resolve(name_, reference);
    if (!path) {
      error_ = SceneError(name_,
                          fmt::format("mtllib {}: {}", Printable(reference), path.error().message));
      return false;
    }
    const Result<std::string> text = ReadWholeFile(path.value(), kMaxTextBytes);
    if (!text) {
      files_.Warn(PlaceOf(name_), "mtllib", text.error().message);
      return false;
    }
    if (const Status sound = CheckMtl(text.value(), path.value()); !sound) {
      error_ = sound.error();
      return false;
    }
    has_library_ = true;
    const std::size_t first = materials->size();
    ViewBuffer buffer(text.value());
    std::istream stream(&buffer);
    std::string warning, error;
    tinyobj::LoadMtl(by_name, materials, &stream, &warning, &error);
    library_of_.resize(materials->size());
    std::fill(library_of_.begin() + static_cast<std::ptrdiff_t>(first), library_of_.end(),
              path.value());
    return true;
  }

  const std::optional<Error>& error() const { return error_; }
  bool has_library() const { return has_library_; }
  // The file that a material comes from: its textures lie beside it.
  const std::string& library_of(std::size_t material) const { return library_of_[material]; }

 private:
  const std::string& name_;
  SceneFiles& files_;
  std::optional<Error> error_;
  bool has_library_ = false;
  std::vector<std::string> library_of_;
};

Colour ToColour(const tinyobj::real_t (&c)[3]) {
  return glm::max(Colour(c[0], c[1], c[2]), Colour(0.0));
}

// docs/formats.md, "OBJ and MTL".
Material ToMaterial(const tinyobj::material_t& from) {
  Material material;
  material.name = from.name;
  material.base_colour = ToColour(from.diffuse);
  material.emission = ToColour(from.emission);
  material.ambient = kModelAmbient;
  material.kd = 1;
  const Colour specular = ToColour(from.specular);
  material.ks = std::max({specular.x, specular.y, specular.z});
  material.shininess = std::max(0.0, static_cast<double>(from.shininess));
  const bool reflects = from.illum >= 3 && from.illum <= 9;
  const double opacity = std::clamp(static_cast<double>(from.dissolve), 0.0, 1.0);
  material.transmit = Colour(1 - opacity);
  if (reflects && from.illum != 9) material.reflect = glm::min(specular, Colour(opacity));
  if (opacity < 1) {
    material.kd = opacity;
    material.ior = std::clamp(static_cast<double>(from.ior), 1e-6, 1e6);
  }
  return material;
}

class ObjBuilder {
 public:
  ObjBuilder(SceneFiles& files, const tinyobj::attrib_t& attributes)
      : files_(files), attributes_(attributes) {
    latest_.resize(attributes.vertices.size() / 3, kNone);
  }

  Status AddMaterials(const std::vector<tinyobj::material_t>& materials, const MtlReader& reader) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
      Material material = ToMaterial(materials[i]);
      const std::string& image = materials[i].diffuse_texname;
      if (!image.empty()) {
        const std::string& library = reader.library_of(i);
        const auto loaded = images_.Load(library, image, files_);
        if (!loaded) {
          return SceneError(library,
                            fmt::format("material {}: map_Kd: {}", Printable(materials[i].name),
                                        loaded.error().message));
        }
        Texture texture;
        texture.image = loaded.value();
        texture.factor = std::get<Colour>(material.base_colour);
        // Many exporters leave Kd black beside a map.
        if (texture.factor == Colour(0.0)) texture.factor = Colour(1.0);
        if (materials[i].diffuse_texopt.clamp) texture.wrap_u = texture.wrap_v = Wrap::kClamp;
        material.base_colour = texture;
      }
      scene_.materials.push_back(std::move(material));
    }
    return Done{};
  }

  // The faces of one shape, by material.
  void AddShape(const tinyobj::shape_t& shape) {
    std::map<int, std::vector<std::size_t>> faces_of;
    for (std::size_t face = 0; face < shape.mesh.material_ids.size(); ++face) {
      faces_of[shape.mesh.material_ids[face]].push_back(face);
    }
    for (const auto& [material, faces] : faces_of) {
      Object object;
      object.name = faces_of.size() == 1 ? shape.name : "";
      object.material = MaterialOf(material);
      object.shape = BuildMesh(shape.mesh, faces);
      scene_.objects.push_back(std::move(object));
    }
  }

  Scene TakeScene() { return std::move(scene_); }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::uint32_t MaterialOf(int index) {
    if (index >= 0) return static_cast<std::uint32_t>(index);
    if (plain_ == kNone) {
      plain_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(PlainMaterial());
    }
    return plain_;
  }

  Mesh BuildMesh(const tinyobj::mesh_t& from, const std::vector<std::size_t>& faces) {
    Mesh mesh;
    has_uv_ = has_normals_ = false;
    for (const std::size_t face : faces) {
      for (std::size_t k = 3 * face; k < 3 * face + 3; ++k) {
        has_uv_ |= from.indices[k].texcoord_index >= 0;
        has_normals_ |= from.indices[k].normal_index >= 0;
      }
    }
    corners_.clear();
    mesh.triangles.reserve(faces.size());
    for (const std::size_t face : faces) {
      std::array<std::uint32_t, 3> triangle;
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = VertexOf(from.indices[3 * face + k], mesh);
      }
      mesh.triangles.push_back(triangle);
    }
    // For the next mesh: only what this one touched, since there may be many of a few faces.
    for (const std::size_t face : faces) {
      for (std::size_t k = 3 * face; k < 3 * face + 3; ++k) {
        latest_[static_cast<std::size_t>(from.indices[k].vertex_index)] = kNone;
      }
    }
    const bool is_white = std::all_of(mesh.colours.begin(), mesh.colours.end(),
                                      [](const glm::vec3& c) { return c == glm::vec3(1); });
    if (is_white) mesh.colours.clear();
    return mesh;
  }

  // Corners with the same position, coordinates and normal are one vertex: those of a position form
  // a chain.
  std::uint32_t VertexOf(const tinyobj::index_t& index, Mesh& mesh) {
    const auto position = static_cast<std::size_t>(index.vertex_index);
    for (std::uint32_t i = latest_[position]; i != kNone; i = corners_[i].previous) {
      if (corners_[i].uv == index.texcoord_index && corners_[i].normal == index.normal_index) {
        return i;
      }
    }
    const auto vertex = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back({index.texcoord_index, index.normal_index, latest_[position]});
    latest_[position] = vertex;
    const auto triple = [](const std::vector<tinyobj::real_t>& from, std::size_t i) {
      return glm::vec3(from[3 * i], from[3 * i + 1], from[3 * i + 2]);
    };
    mesh.positions.push_back(triple(attributes_.vertices, position));
    if (has_normals_) {
      mesh.normals.push_back(
          index.normal_index < 0
              ? glm::vec3(0)
              : triple(attributes_.normals, static_cast<std::size_t>(index.normal_index)));
    }
    if (has_uv_) {
      const auto i = static_cast<std::size_t>(std::max(index.texcoord_index, 0));
      const glm::vec2 uv(attributes_.texcoords[2 * i], 1 - attributes_.texcoords[2 * i + 1]);
      mesh.uv.push_back(index.texcoord_index < 0 ? glm::vec2(0) : uv);
    }
    if (!attributes_.colors.empty()) {
      mesh.colours.push_back(glm::max(triple(attributes_.colors, position), glm::vec3(0)));
    }
    return vertex;
  }

  struct Corner {
    int uv, normal;
    std::uint32_t previous;  // vertex of the same position
  };

  SceneFiles& files_;
  const tinyobj::attrib_t& attributes_;
  Scene scene_;
  ImageCache images_;
  std::uint32_t plain_ = kNone;
  bool has_uv_ = false, has_normals_ = false;
  std::vector<std::uint32_t> latest_;  // by position: its newest vertex in this mesh, or kNone
  std::vector<Corner> corners_;        // by vertex
};

void WarnOfMaterials(const std::map<std::string, std::size_t>& used,
                     const std::vector<tinyobj::material_t>& materials, const std::string& name,
                     SceneFiles& files) {
  std::vector<std::string_view> known;
  for (const tinyobj::material_t& material : materials) known.push_back(material.name);
  for (const auto& [material, line] : used) {
    if (std::find(known.begin(), known.end(), material) != known.end()) continue;
    files.Warn(PlaceOf(name, line), "usemtl",
               fmt::format("no material \"{}\", so grey{}", Printable(material),
                           DidYouMean(material, known)));
  }
}

}  // namespace

Result<Scene> ParseObj(std::string_view original, const std::string& name, SceneFiles& files) {
  const bool may_go_on = original.find('\\') != std::string_view::npos;
  const std::string joined = may_go_on ? JoinLines(original) : "";
  const std::string_view text = may_go_on ? std::string_view(joined) : original;
  ObjChecker checker(text, name);
  if (const Status sound = checker.Check(); !sound) return sound.error();
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  MtlReader reader(name, files);
  ViewBuffer buffer(text);
  std::istream stream(&buffer);
  const bool is_read = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream,
                                        &reader, true, false);
  if (reader.error()) return *reader.error();
  if (!is_read) return SceneError(name, Printable(error));
  if (reader.has_library()) WarnOfMaterials(checker.materials(), materials, name, files);
  ObjBuilder builder(files, attributes);
  if (const Status added = builder.AddMaterials(materials, reader); !added) return added.error();
  for (const tinyobj::shape_t& shape : shapes) builder.AddShape(shape);
  Scene scene = builder.TakeScene();
  if (scene.objects.empty()) return SceneError(name, "no face that is a polygon");
  return scene;
}

}  // namespace sheaf
