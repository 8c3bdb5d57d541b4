#include "src/app/memory_limit.h"

#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>

#include "src/app/add_options.h"

namespace sheaf {
namespace {

// What is said at the end, written beforehand: then there is no memory for it.
char end_line[96] = "sheaf: not enough memory\n";
ExitCode end_code = ExitCode::kInternal;

bool LimitMemory(std::uint64_t bytes, const std::string& text) {
  // Of data, not of addresses: allocators reserve more of these than they use.
  rlimit limit;
  if (getrlimit(RLIMIT_DATA, &limit) != 0) return false;
  const auto wanted = static_cast<rlim_t>(bytes);
  if (limit.rlim_max != RLIM_INFINITY && wanted > limit.rlim_max) return false;
  limit.rlim_cur = wanted;
  if (setrlimit(RLIMIT_DATA, &limit) != 0) return false;
  std::snprintf(end_line, sizeof end_line, "sheaf: needs more than --memory-limit %.40s\n",
                text.c_str());
  end_code = ExitCode::kScene;
  return true;
}

}  // namespace

std::optional<std::uint64_t> ParseBytes(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || number == 0) return std::nullopt;
  const std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  constexpr std::string_view kUnits = "KMGT";
  int shift = 0;
  if (!unit.empty()) {
    const std::size_t power = kUnits.find(unit);
    if (unit.size() != 1 || power == std::string_view::npos) return std::nullopt;
    shift = 10 * (static_cast<int>(power) + 1);
  }
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
  if (number > kMost >> shift) return std::nullopt;
  return number << shift;
}

void AddMemoryLimit(CLI::App& app) {
  AddText(app, "--memory-limit", "SIZE", "a size as 512M or 2G, which this machine can keep to",
          "Exit with 3 rather than allocate more", [](const std::string& text) {
            const std::optional<std::uint64_t> bytes = ParseBytes(text);
            return bytes && LimitMemory(*bytes, text);
          });
}

void EndWhereMemoryEnds() {
  std::set_new_handler([] { _exit(static_cast<int>(ReportMemoryEnd())); });
}

ExitCode ReportMemoryEnd() {
  [[maybe_unused]] const auto written = write(STDERR_FILENO, end_line, std::strlen(end_line));
  return end_code;
}

}  // namespace sheaf
