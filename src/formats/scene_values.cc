#include "src/formats/scene_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/formats/printable.h"
#include "src/formats/suggest_name.h"
#include "src/scene/direction.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

bool ReadTriple(const JsonCursor& value, const NumberRange& range, std::string_view expected,
                glm::dvec3* out) {
  const auto elements = value.ReadTuple<3>(expected);
  if (!elements) return false;
  glm::dvec3 triple{0.0};
  bool is_right = true;
  for (int i = 0; i < 3; ++i) is_right &= (*elements)[i].Read(range, &triple[i]);
  if (is_right) *out = triple;
  return is_right;
}

}  // namespace

bool ReadVector(const JsonCursor& value, Vec3d* out) {
  return ReadTriple(value, kCoordinate, "[x, y, z]", out);
}

bool ReadPair(const JsonCursor& value, const NumberRange& range, std::string_view expected,
              glm::dvec2* out) {
  const auto elements = value.ReadTuple<2>(expected);
  if (!elements) return false;
  glm::dvec2 pair{0.0};
  const bool first = (*elements)[0].Read(range, &pair.x);
  const bool second = (*elements)[1].Read(range, &pair.y);
  if (first && second) *out = pair;
  return first && second;
}

bool ReadColour(const JsonCursor& value, const NumberRange& component, Colour* out,
                std::string_view expected) {
  if (!value.Is(JsonKind::kNumber)) return ReadTriple(value, component, expected, out);
  double grey = 0.0;
  if (!value.Read(component, &grey)) return false;
  *out = Colour(grey);
  return true;
}

bool ReadPictureColour(const JsonCursor& value, Transfer transfer, Colour* out,
                       std::string_view expected) {
  if (!ReadColour(value, kStrength, out, expected)) return false;
  if (transfer == Transfer::kSrgb) {
    for (int i = 0; i < 3; ++i) (*out)[i] = SrgbDecode((*out)[i]);
  }
  return true;
}

bool ReadDirection(const JsonCursor& value, Vec3d* out) {
  Vec3d direction{0.0};
  if (!ReadVector(value, &direction)) return false;
  if (!GivesDirection(direction)) {
    value.Fail("the vector is zero and gives no direction");
    return false;
  }
  *out = direction;
  return true;
}

Json VectorJson(const Vec3d& v) { return {v.x, v.y, v.z}; }

std::optional<std::size_t> ReadWord(const JsonCursor& value,
                                    const std::vector<std::string_view>& words) {
  std::string word;
  if (!value.ReadString(&word)) return std::nullopt;
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  std::string expected;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const char* const joint = i == 0 ? "" : i + 1 < words.size() ? ", " : " or ";
    expected += fmt::format("{}\"{}\"", joint, words[i]);
  }
  value.Fail(fmt::format("expected {}{}", expected, DidYouMean(word, words)));
  return std::nullopt;
}

bool HasControlCharacter(std::string_view name) {
  return std::any_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

bool ReadName(const JsonCursor& value, std::string* out) {
  std::string name;
  if (!value.ReadString(&name)) return false;
  if (HasControlCharacter(name)) {
    value.Fail("a name must not hold control characters");
    return false;
  }
  *out = std::move(name);
  return true;
}

bool ReadNonEmptyName(const JsonCursor& value, std::string* out) {
  std::string name;
  if (!ReadName(value, &name)) return false;
  if (name.empty()) {
    value.Fail("the name is empty");
    return false;
  }
  *out = std::move(name);
  return true;
}

void NameTable::Add(const std::string& name, const JsonCursor& place) {
  const std::uint32_t index = count_++;
  if (name.empty()) return;
  const auto [entry, is_new] = entries_.try_emplace(name, Entry{index, place.line()});
  if (!is_new && place.WouldBeFirst()) {
    place.Fail(fmt::format("the {} \"{}\" exists already, from line {}", kind_, Printable(name),
                           entry->second.line));
  }
}

std::optional<std::uint32_t> NameTable::Find(const JsonCursor& reference) const {
  std::string name;
  if (!reference.ReadString(&name)) return std::nullopt;
  const auto entry = entries_.find(name);
  if (entry != entries_.end()) return entry->second.index;
  if (reference.WouldBeFirst()) {
    std::vector<std::string_view> known;
    for (const auto& [key, value] : entries_) known.push_back(key);
    std::sort(known.begin(), known.end());  // the map's order is the library's business
    reference.Fail(fmt::format("no {} \"{}\"{}", kind_, Printable(name), DidYouMean(name, known)));
  }
  return std::nullopt;
}

}  // namespace sheaf
