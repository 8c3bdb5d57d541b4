#include "src/formats/suggest_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "src/formats/printable.h"

namespace sheaf {
namespace {

// A misspelling longer than this gets no suggestion: the distance costs the product of the lengths.
constexpr std::size_t kMaxLength = 64;

char Lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

// Optimal string alignment distance: insertions, deletions, replacements and swaps of neighbours.
std::size_t Distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = Lower(a[i - 1]) == Lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0u : 1u)});
      if (i > 1 && j > 1 && Lower(a[i - 1]) == Lower(b[j - 2]) &&
          Lower(a[i - 2]) == Lower(b[j - 1])) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

}  // namespace

std::string_view NearestName(std::string_view wrong, const std::vector<std::string_view>& known) {
  if (wrong.empty() || wrong.size() > kMaxLength) return {};
  // One slip in three letters: "ka" must not suggest "kd".
  const std::size_t limit = wrong.size() / 3;
  std::string_view best;
  std::size_t best_distance = std::numeric_limits<std::size_t>::max();
  const auto consider = [&](std::string_view candidate, std::string_view name) {
    if (candidate.empty() || candidate.size() > wrong.size() + limit) return;
    const std::size_t distance = Distance(wrong, candidate);
    if (distance > limit || distance >= best_distance) return;
    best_distance = distance;
    best = name;
  };
  // Whole names first, so that a part of another name wins only where it is nearer.
  for (std::string_view name : known) consider(name, name);
  for (std::string_view name : known) {
    for (std::string_view rest = name; rest.find('_') != rest.npos;) {
      consider(rest.substr(0, rest.find('_')), name);
      rest.remove_prefix(rest.find('_') + 1);
      consider(rest, name);
    }
  }
  return best;
}

std::string DidYouMean(std::string_view wrong, const std::vector<std::string_view>& known) {
  const std::string_view name = NearestName(wrong, known);
  return name.empty() ? "" : fmt::format("; did you mean \"{}\"?", Printable(name));
}

}  // namespace sheaf
