// The small values that all parts of scene JSON share, read and written: vectors, colours, names.
#ifndef SHEAF_FORMATS_SCENE_VALUES_H_
#define SHEAF_FORMATS_SCENE_VALUES_H_

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sheaf/scene.h"
#include "src/formats/json_cursor.h"

namespace sheaf {

inline constexpr NumberRange kCoordinate{-kMaxCoordinate, kMaxCoordinate,
                                         "a number in [-1e30, 1e30]"};
inline constexpr NumberRange kRadius{0.0, kMaxCoordinate, "a number in [0, 1e30]"};
inline constexpr NumberRange kFraction{0.0, 1.0, "a number in [0, 1]"};
inline constexpr NumberRange kStrength{0.0, 1e6, "a number in [0, 1e6]"};
inline constexpr NumberRange kShininess{0.0, 1e9, "a number in [0, 1e9]"};
inline constexpr NumberRange kIor{1e-6, 1e6, "a number in [1e-6, 1e6]"};
inline constexpr double kSmallestPositive = 4.9406564584124654e-324;

inline constexpr std::string_view kColourText = "a colour ([r, g, b] or one number)";

// Each leaves *out alone unless the whole value is right, and returns whether it is.
bool ReadVector(const JsonCursor& value, Vec3d* out);
bool ReadPair(const JsonCursor& value, const NumberRange& range, std::string_view expected,
              glm::dvec2* out);
bool ReadColour(const JsonCursor& value, const NumberRange& component, Colour* out,
                std::string_view expected = kColourText);

// The same, then decodes what stands for a colour of a picture where the scene says sRGB.
bool ReadPictureColour(const JsonCursor& value, Transfer transfer, Colour* out,
                       std::string_view expected = kColourText);

// A vector that gives a direction: its largest component is at least 1e-30 in size.
bool ReadDirection(const JsonCursor& value, Vec3d* out);

using Json = nlohmann::ordered_json;
Json VectorJson(const Vec3d& v);

// A word of the file and what it stands for.
template <typename Choice>
using NamedChoice = std::pair<std::string_view, Choice>;

// Which of the words stands there; nothing where none does, which is an error unless the value is
// absent.
std::optional<std::size_t> ReadWord(const JsonCursor& value,
                                    const std::vector<std::string_view>& words);

template <typename Choice, std::size_t count>
void ReadChoice(const JsonCursor& value, const NamedChoice<Choice> (&choices)[count], Choice* out) {
  std::vector<std::string_view> words;
  for (const auto& [word, choice] : choices) words.push_back(word);
  if (const auto which = ReadWord(value, words)) *out = choices[*which].second;
}

template <typename Choice, std::size_t count>
std::string_view NameOf(Choice value, const NamedChoice<Choice> (&choices)[count]) {
  for (const auto& [word, choice] : choices) {
    if (choice == value) return word;
  }
  return "";
}

// Names end up in messages and file names: no control characters.
bool HasControlCharacter(std::string_view name);
bool ReadName(const JsonCursor& value, std::string* out);
bool ReadNonEmptyName(const JsonCursor& value, std::string* out);

// The names of one kind of thing, each taken once.
class NameTable {
 public:
  explicit NameTable(std::string_view kind) : kind_(kind) {}

  // Gives the next index to `name`, read from `place`; a name taken before is an error. An empty
  // name takes an index and can be neither a duplicate nor found.
  void Add(const std::string& name, const JsonCursor& place);

  // The index of the name that `reference` holds; an unknown one is an error with a suggestion.
  std::optional<std::uint32_t> Find(const JsonCursor& reference) const;

 private:
  struct Entry {
    std::uint32_t index, line;
  };
  std::string_view kind_;
  std::uint32_t count_ = 0;
  std::unordered_map<std::string, Entry> entries_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_VALUES_H_
