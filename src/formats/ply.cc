#include "src/formats/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/text_scanner.h"
#include "src/formats/triangulate.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

constexpr std::size_t kMaxCorners = 1 << 20;

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };
constexpr std::size_t kTypeBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::pair<std::string_view, Type> kTypeNames[] = {
    {"char", Type::kInt8},      {"uchar", Type::kUint8},   {"short", Type::kInt16},
    {"ushort", Type::kUint16},  {"int", Type::kInt32},     {"uint", Type::kUint32},
    {"float", Type::kFloat},    {"double", Type::kDouble}, {"int8", Type::kInt8},
    {"uint8", Type::kUint8},    {"int16", Type::kInt16},   {"uint16", Type::kUint16},
    {"int32", Type::kInt32},    {"uint32", Type::kUint32}, {"float32", Type::kFloat},
    {"float64", Type::kDouble},
};

std::optional<Type> TypeOf(std::string_view word) {
  for (const auto& [name, type] : kTypeNames) {
    if (name == word) return type;
  }
  return std::nullopt;
}

// Where a vertex's number goes.
enum Slot { kX, kY, kZ, kNx, kNy, kNz, kU, kV, kRed, kGreen, kBlue, kSlots, kNoSlot = kSlots };
constexpr std::pair<std::string_view, Slot> kSlotNames[] = {
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
    {"diffuse_red", kRed},
    {"diffuse_green", kGreen},
    {"diffuse_blue", kBlue},
};

Slot SlotOf(std::string_view name) {
  for (const auto& [known, slot] : kSlotNames) {
    if (known == name) return slot;
  }
  return kNoSlot;
}

struct Property {
  std::string_view name;
  Type type = Type::kFloat;
  std::optional<Type> count_type;  // of a list
  Slot slot = kNoSlot;
  bool is_indices = false;
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { kAscii, kLittle, kBig };

// Numbers of the body, one after another.
class Body {
 public:
  Body(std::string_view text, Encoding encoding, std::size_t line)
      : rest_(text), encoding_(encoding), line_(line) {}

  std::size_t line() const { return line_; }
  std::size_t bytes_left() const { return rest_.size(); }

  // False where the body ends or holds no number of this type.
  bool Read(Type type, double* out) {
    if (encoding_ == Encoding::kAscii) return ReadWord(out);
    const std::size_t size = kTypeBytes[static_cast<int>(type)];
    if (rest_.size() < size) return false;
    unsigned char bytes[8];
    std::memcpy(bytes, rest_.data(), size);
    rest_.remove_prefix(size);
    if ((encoding_ == Encoding::kLittle) != (std::endian::native == std::endian::little)) {
      std::reverse(bytes, bytes + size);
    }
    *out = Decode(type, bytes);
    return true;
  }

 private:
  static double Decode(Type type, const unsigned char* bytes) {
    const auto as = [bytes](auto value) {
      std::memcpy(&value, bytes, sizeof(value));
      return static_cast<double>(value);
    };
    switch (type) {
      case Type::kInt8:
        return as(std::int8_t{});
      case Type::kUint8:
        return as(std::uint8_t{});
      case Type::kInt16:
        return as(std::int16_t{});
      case Type::kUint16:
        return as(std::uint16_t{});
      case Type::kInt32:
        return as(std::int32_t{});
      case Type::kUint32:
        return as(std::uint32_t{});
      case Type::kFloat:
        return as(float{});
      case Type::kDouble:
        break;
    }
    return as(double{});
  }

  bool ReadWord(double* out) {
    std::size_t i = 0;
    for (; i < rest_.size() && (IsBlank(rest_[i]) || rest_[i] == '\n'); ++i) {
      line_ += rest_[i] == '\n';
    }
    std::size_t end = i;
    while (end < rest_.size() && !IsBlank(rest_[end]) && rest_[end] != '\n') ++end;
    const auto number = ParseWord<double>(rest_.substr(i, end - i));
    rest_.remove_prefix(end);
    if (number) *out = *number;
    return number.has_value();
  }

  std::string_view rest_;
  Encoding encoding_;
  std::size_t line_;
};

class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& name) : scanner_(text), name_(name) {}

  Result<Mesh> Read() {
    if (!ReadHeader()) return *error_;
    Body body(scanner_.rest(), encoding_, scanner_.line() + 1);
    for (const Element& element : elements_) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        if (!ReadElement(element, i, body)) return *error_;
      }
    }
    if (mesh_.triangles.empty()) return SceneError(name_, "no face");
    return std::move(mesh_);
  }

 private:
  bool Fail(std::string_view what) {
    if (!error_) error_ = SceneErrorAt(name_, scanner_.line(), what);
    return false;
  }
  bool FailAt(const Element& element, std::uint64_t index, const Body& body,
              std::string_view what) {
    const std::string place = fmt::format("{} {}: {}", Printable(element.name, 40), index, what);
    error_ = encoding_ == Encoding::kAscii ? SceneErrorAt(name_, body.line(), place)
                                           : SceneError(name_, place);
    return false;
  }

  bool ReadHeader() {
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
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        return Fail(fmt::format("unknown word \"{}\" in the header", Printable(word, 40)));
      }
    }
    return Fail("the header has no end_header");
  }

  bool ReadFormat() {
    const std::string_view word = scanner_.Word();
    if (word == "ascii")
      encoding_ = Encoding::kAscii;
    else if (word == "binary_little_endian")
      encoding_ = Encoding::kLittle;
    else if (word == "binary_big_endian")
      encoding_ = Encoding::kBig;
    else
      return Fail(fmt::format("unknown format \"{}\"", Printable(word, 40)));
    return true;
  }

  bool AddElement() {
    const std::string_view name = scanner_.Word();
    const auto count = scanner_.Number<std::uint64_t>();
    if (name.empty() || !count) return Fail("expected \"element NAME COUNT\"");
    for (const Element& element : elements_) {
      if (element.name == name) return Fail("the element exists already");
    }
    elements_.push_back({name, *count, {}});
    return true;
  }

  bool AddProperty() {
    if (elements_.empty()) return Fail("a property before any element");
    Property property;
    std::string_view word = scanner_.Word();
    if (word == "list") {
      property.count_type = TypeOf(scanner_.Word());
      if (!property.count_type || *property.count_type >= Type::kFloat) {
        return Fail("expected \"property list COUNT_TYPE TYPE NAME\" with integer counts");
      }
      word = scanner_.Word();
    }
    const auto type = TypeOf(word);
    property.name = scanner_.Word();
    if (!type || property.name.empty()) {
      return Fail(fmt::format("unknown type \"{}\" of a property", Printable(word, 40)));
    }
    property.type = *type;
    Element& element = elements_.back();
    if (element.name == "vertex" && !property.count_type) property.slot = SlotOf(property.name);
    property.is_indices = element.name == "face" && property.count_type &&
                          (property.name == "vertex_indices" || property.name == "vertex_index");
    element.properties.push_back(property);
    return true;
  }

  // What vertices have, and that they have enough.
  bool CheckElements() {
    const Element* faces = nullptr;
    bool has_vertices = false;
    for (const Element& element : elements_) {
      if (element.name == "face") faces = &element;
      if (element.name != "vertex") continue;
      if (faces != nullptr) return Fail("the faces come before the vertices");
      has_vertices = true;
      for (const Property& property : element.properties) {
        if (property.slot != kNoSlot) has_[property.slot] = true;
      }
    }
    if (!has_vertices || !has_[kX] || !has_[kY] || !has_[kZ]) {
      return Fail("no element \"vertex\" with x, y and z");
    }
    if (faces == nullptr ||
        std::none_of(faces->properties.begin(), faces->properties.end(),
                     [](const Property& property) { return property.is_indices; })) {
      return Fail("no element \"face\" with a list \"vertex_indices\"");
    }
    return true;
  }

  bool ReadElement(const Element& element, std::uint64_t index, Body& body) {
    double slots[kSlots + 1] = {};
    for (const Property& property : element.properties) {
      double value = 0;
      if (!property.count_type) {
        if (!body.Read(property.type, &value)) return FailCut(element, index, body);
        if (property.slot == kNoSlot) continue;
        slots[property.slot] = value;
        // Colours of integers span their type.
        if (property.slot >= kRed && property.type < Type::kFloat) {
          const double most = property.type == Type::kUint16 ? 65535.0 : 255.0;
          slots[property.slot] = SrgbDecode(std::clamp(value / most, 0.0, 1.0));
        }
        continue;
      }
      if (!body.Read(*property.count_type, &value)) return FailCut(element, index, body);
      if (!(value >= 0)) return FailAt(element, index, body, "a list of negative length");
      if (property.is_indices) {
        if (!ReadFace(element, index, property, value, body)) return false;
        continue;
      }
      for (double i = 0; i < value; ++i) {
        double skipped = 0;
        if (!body.Read(property.type, &skipped)) return FailCut(element, index, body);
      }
    }
    return element.name != "vertex" || AddVertex(element, index, body, slots);
  }

  bool FailCut(const Element& element, std::uint64_t index, const Body& body) {
    const bool is_text = encoding_ == Encoding::kAscii && body.bytes_left() > 0;
    return FailAt(element, index, body,
                  is_text
                      ? "expected a number"
                      : fmt::format("the file ends here, with {} of them promised", element.count));
  }

  bool AddVertex(const Element& element, std::uint64_t index, const Body& body,
                 const double (&slots)[kSlots + 1]) {
    for (int i = 0; i < kSlots; ++i) {
      if (!(std::abs(slots[i]) <= kMaxCoordinate)) {  // NaN too
        return FailAt(element, index, body, "a number is not finite, or beyond 1e30");
      }
    }
    mesh_.positions.emplace_back(slots[kX], slots[kY], slots[kZ]);
    if (has_[kNx] && has_[kNy] && has_[kNz]) {
      mesh_.normals.emplace_back(slots[kNx], slots[kNy], slots[kNz]);
    }
    if (has_[kU] && has_[kV]) mesh_.uv.emplace_back(slots[kU], 1 - slots[kV]);
    if (has_[kRed] && has_[kGreen] && has_[kBlue]) {
      mesh_.colours.emplace_back(std::max(slots[kRed], 0.0), std::max(slots[kGreen], 0.0),
                                 std::max(slots[kBlue], 0.0));
    }
    return true;
  }

  bool ReadFace(const Element& element, std::uint64_t index, const Property& property, double count,
                Body& body) {
    if (count > static_cast<double>(kMaxCorners)) {
      return FailAt(element, index, body, fmt::format("{} corners", count));
    }
    polygon_.clear();
    for (double i = 0; i < count; ++i) {
      double vertex = 0;
      if (!body.Read(property.type, &vertex)) return FailCut(element, index, body);
      if (!(vertex >= 0 && vertex < static_cast<double>(mesh_.positions.size())) ||
          vertex != std::floor(vertex)) {
        return FailAt(element, index, body,
                      fmt::format("vertex {} of {}", vertex, mesh_.positions.size()));
      }
      polygon_.push_back(static_cast<std::uint32_t>(vertex));
    }
    if (polygon_.size() < 3) return FailAt(element, index, body, "fewer than 3 corners");
    Triangulate(mesh_.positions, polygon_, mesh_.triangles);
    return true;
  }

  TextScanner scanner_;
  const std::string& name_;
  std::optional<Error> error_;
  Encoding encoding_ = Encoding::kAscii;
  std::vector<Element> elements_;
  bool has_[kSlots + 1] = {};
  Mesh mesh_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

Result<Mesh> ParsePly(std::string_view text, const std::string& name) {
  return PlyReader(text, name).Read();
}

Result<Scene> ParsePlyScene(std::string_view text, const std::string& name, SceneFiles&) {
  Result<Mesh> mesh = ParsePly(text, name);
  if (!mesh) return mesh.error();
  Scene scene;
  scene.materials.push_back(PlainMaterial());
  if (!mesh.value().colours.empty()) scene.materials[0].base_colour = Colour(1.0);
  scene.objects.push_back({"", std::move(mesh).value(), 0});
  return scene;
}

}  // namespace sheaf
