// MTL, the material library of OBJ.
#ifndef SHEAF_FORMATS_MTL_H_
#define SHEAF_FORMATS_MTL_H_

#include <cstddef>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"
#include "src/formats/scene_files.h"
#include "src/formats/text_scanner.h"

namespace sheaf {

// A statement about a texture.
struct MtlMap {
  std::size_t line = 0;   // 0: there is none
  std::string file;       // the rest of the line, which may hold blanks
  glm::dvec2 scale{1.0};  // of coordinates with v up; the offset comes after it
  glm::dvec2 offset{0.0};
  bool is_clamped = false;
  double bump = 1;  // of bump maps: times their slopes
};

// What a library says of a material.
struct MtlMaterial {
  std::string name, library;  // the path of the library's file
  std::size_t line = 0;
  std::optional<Colour> kd, ks, ke;
  std::optional<double> ns, ni, d, tr, illum;
  std::map<std::string, MtlMap, std::less<>> maps;  // by statement
};

// The libraries of one OBJ. Whatever is wrong with them is a warning.
class MtlLibraries {
 public:
  // `obj` is the file that names them.
  MtlLibraries(const std::string& obj, SceneFiles& files) : obj_(obj), files_(files) {}

  // The statement mtllib: one file whose name may hold blanks, or several.
  void Read(std::string_view names, std::size_t line);

  bool has_library() const { return !paths_.empty(); }
  const std::vector<MtlMaterial>& materials() const { return materials_; }

  // The first material of this name, which may have a comment behind it.
  std::optional<std::size_t> Find(std::string_view name) const;

 private:
  bool ReadFile(std::string_view reference, std::string* failure);
  void ReadStatement(TextScanner& scanner, const std::string& path);
  std::optional<Colour> ReadColour(TextScanner& scanner, std::string_view key,
                                   const std::string& path);
  struct PlacedWord {
    std::string_view text;
    std::size_t line;
  };
  std::optional<double> ReadNumber(const PlacedWord& word, const NumberRange& range,
                                   std::string_view key, const std::string& path);
  MtlMap ReadMap(TextScanner& scanner, const std::string& path);

  const std::string& obj_;
  SceneFiles& files_;
  std::vector<std::string> paths_;
  std::vector<MtlMaterial> materials_;
  std::map<std::string, std::size_t, std::less<>> index_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_MTL_H_
