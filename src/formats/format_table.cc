#include "src/formats/format_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/formats/exr.h"
#include "src/formats/gltf.h"
#include "src/formats/nff.h"
#include "src/formats/obj.h"
#include "src/formats/pfm.h"
#include "src/formats/ply.h"
#include "src/formats/png.h"
#include "src/formats/scene_json.h"

namespace sheaf {
namespace {

std::vector<FormatRow> MakeTable() {
  return {
      {.format = {.name = "scene JSON", .endings = {".json"}, .content = FileContent::kScene},
       .parse = &ParseSceneJson,
       .max_bytes = kMaxTextBytes},

      {.format = {.name = "NFF", .endings = {".nff"}, .content = FileContent::kModel},
       .parse = &ParseNffScene,
       .model_transfer = Transfer::kLinear},  // older than displays with a curve
      {.format = {.name = "OBJ", .endings = {".obj"}, .content = FileContent::kModel},
       .parse = &ParseObj},
      {.format = {.name = "PLY", .endings = {".ply"}, .content = FileContent::kModel},
       .parse = &ParsePlyScene},
      {.format = {.name = "glTF 2.0", .endings = {".gltf", ".glb"}, .content = FileContent::kModel},
       .parse = &ParseGltf},

      {.format =
           {.name = "PNG", .endings = {".png"}, .content = FileContent::kPicture, .bits = {8, 16}},
       .read_picture = &ReadPngFilm,
       .create_encoder = &CreatePngEncoder},
      {.format = {.name = "PFM",
                  .endings = {".pfm"},
                  .content = FileContent::kPicture,
                  .bits = {32},
                  .holds_floats = true},
       .read_picture = &ReadPfmPicture,
       .create_encoder = &CreatePfmEncoder},
      {.format = {.name = "OpenEXR",
                  .endings = {".exr"},
                  .content = FileContent::kPicture,
                  .is_built_in = IsExrBuiltIn(),
                  .bits = {16, 32},
                  .holds_floats = true,
                  .holds_layers = true},
       .read_picture = &ReadExr,
       .create_encoder = &CreateExrEncoder},
  };
}

// The last dot and what follows it, in lower case; empty without a dot. Not by std::tolower, which
// follows the locale.
std::string EndingOf(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return {};
  std::string ending(path.substr(dot));
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

// "a, b or c".
std::string Alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace

const std::vector<FormatRow>& FormatTable() {
  static const std::vector<FormatRow> kTable = MakeTable();
  return kTable;
}

const FormatRow* FindFormat(std::string_view path) {
  const std::string ending = EndingOf(path);
  for (const FormatRow& row : FormatTable()) {
    const auto& endings = row.format.endings;
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return &row;
  }
  return nullptr;
}

std::string EndingsText(const std::function<bool(const FileFormat&)>& belongs) {
  std::vector<std::string> endings;
  for (const FileFormat& format : FileFormats()) {
    if (!belongs(format)) continue;
    endings.insert(endings.end(), format.endings.begin(), format.endings.end());
  }
  return Alternatives(endings);
}

std::string SceneEndings() {
  return EndingsText(
      [](const FileFormat& format) { return format.content != FileContent::kPicture; });
}

std::string PictureEndings() {
  return EndingsText(
      [](const FileFormat& format) { return format.content == FileContent::kPicture; });
}

std::string BitsText() {
  std::vector<std::string> formats;
  for (const FileFormat& format : FileFormats()) {
    std::vector<std::string> bits;
    for (const int count : format.bits) bits.push_back(std::to_string(count));
    if (!bits.empty()) formats.push_back(format.endings.front() + " " + Alternatives(bits));
  }
  return fmt::format("{}", fmt::join(formats, ", "));
}

const std::vector<FileFormat>& FileFormats() {
  static const std::vector<FileFormat> kFormats = [] {
    std::vector<FileFormat> formats;
    for (const FormatRow& row : FormatTable()) formats.push_back(row.format);
    return formats;
  }();
  return kFormats;
}

const FileFormat* FormatOf(std::string_view path) {
  const FormatRow* row = FindFormat(path);
  return row == nullptr ? nullptr
                        : &FileFormats()[static_cast<std::size_t>(row - FormatTable().data())];
}

}  // namespace sheaf
