#include "src/formats/warnings.h"

#include <fmt/format.h>

#include "src/formats/printable.h"

namespace sheaf {

std::string PlaceOf(std::string_view path) { return PrintablePath(path); }

std::string PlaceOf(std::string_view path, std::size_t line) {
  return fmt::format("{}:{}", PrintablePath(path), line);
}

void Warnings::Add(std::string_view place, std::string_view kind, std::string_view detail) {
  if (const auto known = index_.find(kind); known != index_.end()) {
    ++firsts_[known->second].count;
    return;
  }
  index_.emplace(kind, firsts_.size());
  firsts_.push_back({fmt::format("{}: {}{}{}", place, kind, detail.empty() ? "" : ": ", detail)});
}

std::vector<std::string> Warnings::Lines() const {
  std::vector<std::string> lines;
  for (const First& first : firsts_) {
    lines.push_back(first.count == 1 ? first.text
                                     : fmt::format("{} ({} in all)", first.text, first.count));
  }
  return lines;
}

}  // namespace sheaf
