#include "src/formats/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/text_scanner.h"

namespace sheaf {
namespace {

// The value of a name in a table of pairs.
template <typename Value, std::size_t kCount>
std::optional<Value> Named(const std::pair<std::string_view, Value> (&table)[kCount],
                           std::string_view word) {
  for (const auto& [name, value] : table) {
    if (name == word) return value;
  }
  return std::nullopt;
}

constexpr std::pair<std::string_view, PlyType> kTypes[] = {
    {"char", PlyType::kInt8},      {"uchar", PlyType::kUint8},   {"short", PlyType::kInt16},
    {"ushort", PlyType::kUint16},  {"int", PlyType::kInt32},     {"uint", PlyType::kUint32},
    {"float", PlyType::kFloat},    {"double", PlyType::kDouble}, {"int8", PlyType::kInt8},
    {"uint8", PlyType::kUint8},    {"int16", PlyType::kInt16},   {"uint16", PlyType::kUint16},
    {"int32", PlyType::kInt32},    {"uint32", PlyType::kUint32}, {"float32", PlyType::kFloat},
    {"float64", PlyType::kDouble},
};

constexpr std::pair<std::string_view, PlySlot> kSlots[] = {
    {"x", kX},
    {"y", kY},
    {"z", kZ},
    {"nx", kNx},
    {"ny", kNy},
    {"nz", kNz},
    {"u", kU},
    {"v", kV},
    {"s", kU},
    {"t", kV},
    {"texture_u", kU},
    {"texture_v", kV},
    {"red", kRed},
    {"green", kGreen},
    {"blue", kBlue},
    {"r", kRed},
    {"g", kGreen},
    {"b", kBlue},
    {"diffuse_red", kRed},
    {"diffuse_green", kGreen},
    {"diffuse_blue", kBlue},
    {"alpha", kAlpha},
    {"a", kAlpha},
    {"texnumber", kTexture},
};

constexpr std::pair<std::string_view, PlyList> kLists[] = {
    {"vertex_indices", PlyList::kIndices},
    {"vertex_index", PlyList::kIndices},
    {"texcoord", PlyList::kCoordinates},
};

constexpr std::pair<std::string_view, PlyKind> kKinds[] = {
    {"vertex", PlyKind::kVertices}, {"face", PlyKind::kFaces}, {"tristrips", PlyKind::kStrips}};

constexpr std::pair<std::string_view, PlyEncoding> kEncodings[] = {
    {"ascii", PlyEncoding::kAscii},
    {"binary_little_endian", PlyEncoding::kLittle},
    {"binary_big_endian", PlyEncoding::kBig}};

class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name, SceneFiles& files)
      : scanner_(text), name_(name), files_(files) {}

  Result<PlyHeader> Read() {
    if (!ReadLines()) return *error_;
    header_.body = scanner_.rest();
    header_.body_line = scanner_.line() + 1;
    header_.line_end = scanner_.line_end();
    return std::move(header_);
  }

 private:
  bool Fail(std::string_view what) {
    if (!error_) error_ = SceneErrorAt(name_, scanner_.line(), what);
    return false;
  }

  bool ReadLines() {
    if (!scanner_.NextLine() || scanner_.Word() != "ply") {
      return Fail("no PLY: it does not begin with \"ply\"");
    }
    bool has_format = false;
    while (scanner_.NextLine()) {
      const std::string_view word = scanner_.Word();
      if (word == "end_header") {
        if (!has_format) return Fail("the header names no format");
        return CheckElements();
      }
      if (word == "format") {
        has_format = true;
        if (!ReadFormat()) return false;
      } else if (word == "element") {
        if (!AddElement()) return false;
      } else if (word == "property") {
        if (!AddProperty()) return false;
      } else if (word == "comment") {
        // MeshLab's, and by now everybody's.
        if (scanner_.Word() != "TextureFile") continue;
        header_.textures.push_back({scanner_.Remainder(), scanner_.line()});
      } else if (word != "obj_info" && !word.empty()) {
        files_.Warn(PlaceOf(name_, scanner_.line()), "line of the header passed over",
                    fmt::format("unknown word \"{}\"", Printable(word, 40)));
      }
    }
    return Fail("the header has no end_header");
  }

  bool ReadFormat() {
    const std::string_view word = scanner_.Word();
    const auto encoding = Named(kEncodings, word);
    if (!encoding) return Fail(fmt::format("unknown format \"{}\"", Printable(word, 40)));
    header_.encoding = *encoding;
    return true;
  }

  bool AddElement() {
    PlyElement element;
    element.name = scanner_.Word();
    const auto count = scanner_.Number<std::uint64_t>();
    if (element.name.empty() || !count) return Fail("expected \"element NAME COUNT\"");
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) return Fail("the element exists already");
    }
    element.count = *count;
    element.kind = Named(kKinds, element.name).value_or(PlyKind::kSkipped);
    header_.elements.push_back(std::move(element));
    return true;
  }

  bool AddProperty() {
    if (header_.elements.empty()) return Fail("a property before any element");
    PlyElement& element = header_.elements.back();
    PlyProperty property;
    std::string_view word = scanner_.Word();
    if (word == "list") {
      property.count_type = Named(kTypes, scanner_.Word());
      if (!property.count_type || *property.count_type >= PlyType::kFloat) {
        return Fail("expected \"property list COUNT_TYPE TYPE NAME\" with integer counts");
      }
      word = scanner_.Word();
    }
    const auto type = Named(kTypes, word);
    const std::string_view name = scanner_.Word();
    if (!type || name.empty()) {
      return Fail(fmt::format("unknown type \"{}\" of a property", Printable(word, 40)));
    }
    property.type = *type;
    const bool is_read = element.kind != PlyKind::kSkipped;
    if (is_read && !property.count_type) {
      property.slot = Named(kSlots, name).value_or(kNoSlot);
      element.has[property.slot] = true;
    }
    if (is_read && property.count_type && element.kind != PlyKind::kVertices) {
      property.list = Named(kLists, name).value_or(PlyList::kSkipped);
    }
    element.properties.push_back(property);
    return true;
  }

  bool CheckElements() {
    bool has_vertices = false, has_faces = false;
    for (const PlyElement& element : header_.elements) {
      if (element.kind == PlyKind::kVertices) {
        if (has_faces) return Fail("the faces come before the vertices");
        has_vertices = element.Has(kX, 3);
      } else if (element.kind != PlyKind::kSkipped) {
        has_faces |= element.HasList(PlyList::kIndices);
      }
    }
    if (!has_vertices) return Fail("no element \"vertex\" with x, y and z");
    if (!has_faces) {
      return Fail("no element \"face\" or \"tristrips\" with a list \"vertex_indices\"");
    }
    return true;
  }

  TextScanner scanner_;
  const std::string& name_;
  SceneFiles& files_;
  std::optional<Error> error_;
  PlyHeader header_;
};

}  // namespace

bool PlyElement::Has(PlySlot first, int count_of_slots) const {
  return std::all_of(has + first, has + first + count_of_slots, [](bool given) { return given; });
}

bool PlyElement::HasList(PlyList list) const {
  return std::any_of(properties.begin(), properties.end(),
                     [list](const PlyProperty& property) { return property.list == list; });
}

Result<PlyHeader> ReadPlyHeader(std::string_view text, const std::string& name, SceneFiles& files) {
  return HeaderReader(text, name, files).Read();
}

}  // namespace sheaf
