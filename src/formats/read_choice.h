// Words of scene JSON that each stand for one of a few values.
#ifndef SHEAF_FORMATS_READ_CHOICE_H_
#define SHEAF_FORMATS_READ_CHOICE_H_

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/formats/json_cursor.h"
#include "src/formats/suggest_name.h"

namespace sheaf {

// Leaves *out alone where no word stands there that is one of the choices' names, which is an error
// unless nothing stands there.
template <typename Choice, std::size_t count>
void ReadChoice(const JsonCursor& value,
                const std::pair<std::string_view, Choice> (&choices)[count], Choice* out) {
  std::string word;
  if (!value.ReadString(&word)) return;
  std::vector<std::string_view> known;
  for (const auto& [name, choice] : choices) {
    known.push_back(name);
    if (name != word) continue;
    *out = choice;
    return;
  }
  value.Fail(fmt::format("expected one of {}{}", fmt::join(known, ", "), DidYouMean(word, known)));
}

template <typename Choice, std::size_t count>
std::string_view NameOf(Choice value, const std::pair<std::string_view, Choice> (&choices)[count]) {
  for (const auto& [name, choice] : choices) {
    if (choice == value) return name;
  }
  return "";
}

}  // namespace sheaf

#endif  // SHEAF_FORMATS_READ_CHOICE_H_
