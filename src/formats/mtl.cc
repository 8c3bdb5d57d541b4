#include "src/formats/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/scene_values.h"
#include "src/formats/text_lines.h"

namespace sheaf {
namespace {

constexpr std::pair<std::string_view, std::optional<Colour> MtlMaterial::*> kColours[] = {
    {"Kd", &MtlMaterial::kd}, {"Ks", &MtlMaterial::ks}, {"Ke", &MtlMaterial::ke}};

// Up to what scene JSON takes, so that what is read here can be written there. Exporters write
// colours below 0, which are taken for black.
constexpr NumberRange kWithin{-1e6, kStrength.high, "a number in [-1e6, 1e6]"};
constexpr NumberRange kExponent{-1e6, kShininess.high, "a number in [-1e6, 1e9]"};

struct MtlNumber {
  std::string_view name;
  std::optional<double> MtlMaterial::*member;
  const NumberRange& range;
};
constexpr MtlNumber kNumbers[] = {
    {"Ns", &MtlMaterial::ns, kExponent},     {"Ni", &MtlMaterial::ni, kWithin},
    {"d", &MtlMaterial::d, kWithin},         {"Tr", &MtlMaterial::tr, kWithin},
    {"illum", &MtlMaterial::illum, kWithin},
};

constexpr std::string_view kMaps[] = {
    "map_Kd", "map_Ka", "map_Ks",   "map_Ke",   "map_Ns", "map_d", "map_Pr", "map_Pm",
    "map_Ps", "bump",   "map_bump", "map_Bump", "norm",   "disp",  "decal",  "refl"};

// What follows an option of a texture: so many numbers at most, or one word.
struct MapOption {
  std::string_view name;
  int numbers;
  bool changes_colour = false;  // or place, in a way that is not read
};
constexpr MapOption kMapOptions[] = {
    {"-s", 3},        {"-o", 3},      {"-t", 3, true},       {"-mm", 2, true}, {"-bm", 1},
    {"-boost", 1},    {"-texres", 1}, {"-clamp", 0},         {"-blendu", 0},   {"-blendv", 0},
    {"-cc", 0, true}, {"-type", 0},   {"-imfchan", 0, true},
};
constexpr double kMostPlacing = 4e5;  // so that scene JSON can say the sum of two and 1

}  // namespace

void MtlLibraries::Read(std::string_view names, std::size_t line) {
  const std::string_view named = WithoutComment(names);
  std::string failure;
  if (named != names && ReadFile(names, &failure)) return;
  if (ReadFile(named, &failure)) return;
  // Several files in a line are what the specification says, and rare.
  std::vector<std::string> failures;
  TextScanner words(named);
  std::size_t count = 0;
  if (words.NextLine()) {
    for (std::string_view word = words.Word(); !word.empty(); word = words.Word(), ++count) {
      std::string of_word;
      if (!ReadFile(word, &of_word)) failures.push_back(of_word);
    }
  }
  if (failures.size() >= count) failures = {failure};
  for (const std::string& text : failures) files_.Warn(PlaceOf(obj_, line), "mtllib", text);
}

bool MtlLibraries::ReadFile(std::string_view reference, std::string* failure) {
  const Result<std::string> path = files_.Resolve(obj_, WithSlashes(reference));
  if (!path) {
    *failure = fmt::format("{}: {}", Printable(reference), path.error().message);
    return false;
  }
  // Some writers name the library before every object.
  if (std::find(paths_.begin(), paths_.end(), path.value()) != paths_.end()) return true;
  const Result<std::string> bytes = files_.Read(path.value(), kMaxTextBytes);
  if (!bytes) {
    *failure = bytes.error().message;
    return false;
  }
  paths_.push_back(path.value());
  const std::string decoded = DecodeUtf16(bytes.value());
  TextScanner scanner(decoded.empty() ? bytes.value() : decoded);
  const std::size_t first = materials_.size();
  while (scanner.NextLine()) {
    // Statements before the first newmtl are about nothing.
    TextScanner line = scanner;
    if (line.Word() == "newmtl") {
      materials_.push_back({});
      materials_.back().name = line.Remainder();
      materials_.back().library = path.value();
      materials_.back().line = line.line();
      index_.emplace(materials_.back().name, materials_.size() - 1);
    } else if (materials_.size() > first) {
      ReadStatement(scanner, path.value());
    }
  }
  return true;
}

void MtlLibraries::ReadStatement(TextScanner& scanner, const std::string& path) {
  MtlMaterial& material = materials_.back();
  const std::string_view key = scanner.Word();
  for (const auto& [name, member] : kColours) {
    if (key != name) continue;
    if (const auto colour = ReadColour(scanner, key, path)) material.*member = colour;
    return;
  }
  for (const auto& [name, member, range] : kNumbers) {
    if (key != name) continue;
    std::string_view word = scanner.Word();
    if (key == "d" && word == "-halo") word = scanner.Word();
    if (const auto number = ReadNumber({word, scanner.line()}, range, key, path)) {
      material.*member = number;
    }
    return;
  }
  if (std::find(std::begin(kMaps), std::end(kMaps), key) != std::end(kMaps)) {
    material.maps.insert_or_assign(std::string(key), ReadMap(scanner, path));
  }
}

std::optional<Colour> MtlLibraries::ReadColour(TextScanner& scanner, std::string_view key,
                                               const std::string& path) {
  Colour colour(0.0);
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = scanner.Word();
    if (i == 1 && (word.empty() || word.starts_with('#'))) return Colour(colour.x);  // for all
    const auto number = ReadNumber({word, scanner.line()}, kWithin, key, path);
    if (!number) return std::nullopt;
    colour[i] = *number;
  }
  return colour;
}

std::optional<double> MtlLibraries::ReadNumber(const PlacedWord& word, const NumberRange& range,
                                               std::string_view key, const std::string& path) {
  const auto number = ParseWord<double>(word.text);
  if (number && *number >= range.low && *number <= range.high) return number;
  files_.Warn(PlaceOf(path, word.line), key,
              fmt::format("expected {}, found \"{}\"", range.text, Printable(word.text, 40)));
  return std::nullopt;
}

MtlMap MtlLibraries::ReadMap(TextScanner& scanner, const std::string& path) {
  MtlMap map;
  map.line = scanner.line();
  for (;;) {
    TextScanner ahead = scanner;
    const std::string_view word = ahead.Word();
    const auto* const option =
        std::find_if(std::begin(kMapOptions), std::end(kMapOptions),
                     [&](const MapOption& known) { return known.name == word; });
    if (option == std::end(kMapOptions)) break;
    double numbers[3] = {};
    int count = 0;
    if (option->numbers == 0) map.is_clamped |= ahead.Word() == "on" && word == "-clamp";
    scanner = ahead;
    for (; count < option->numbers; ++count) {
      const auto number = ahead.Number<double>();
      if (!number || !(std::abs(*number) <= kMostPlacing)) break;
      numbers[count] = *number;
      scanner = ahead;
    }
    glm::dvec2* const to = word == "-s" ? &map.scale : word == "-o" ? &map.offset : nullptr;
    for (int i = 0; i < std::min(count, 2) && to != nullptr; ++i) {
      (*to)[i] = numbers[i];
    }
    if (word == "-bm" && count == 1) map.bump = numbers[0];
    if (option->changes_colour) {
      files_.Warn(PlaceOf(path, map.line), "an option of a texture is not read", word);
    }
  }
  map.file = scanner.Remainder();
  return map;
}

std::optional<std::size_t> MtlLibraries::Find(std::string_view name) const {
  if (const auto same = index_.find(name); same != index_.end()) return same->second;
  for (std::size_t i = 0; i < materials_.size(); ++i) {
    if (WithoutComment(materials_[i].name) == WithoutComment(name)) return i;
  }
  return std::nullopt;
}

}  // namespace sheaf
