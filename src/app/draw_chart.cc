#include "src/app/draw_chart.h"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

namespace sheaf {

// In double quotes, with C's escapes.
std::string GnuplotString(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "\"";
}

Status DrawChart(const std::string& setup, const std::string& plot, const std::string& stem) {
  std::string script = setup;
  for (const auto& [terminal, ending] : {std::pair("svg size 900,600 background \"white\"", "svg"),
                                         std::pair("pngcairo size 900,600", "png")}) {
    fmt::format_to(std::back_inserter(script), "set terminal {}\nset output {}\n{}", terminal,
                   GnuplotString(stem + ".part." + ending), plot);
  }
  const Error failed{ErrorKind::kInputOutput, stem + ".svg: gnuplot could not draw it"};
  std::FILE* gnuplot = popen("gnuplot >/dev/null 2>&1", "w");
  if (gnuplot == nullptr) return failed;
  const bool fed = std::fwrite(script.data(), 1, script.size(), gnuplot) == script.size();
  const bool drawn = pclose(gnuplot) == 0 && fed;
  bool moved = drawn;
  for (const char* ending : {".svg", ".png"}) {
    std::error_code error;
    const std::string part = stem + ".part" + ending;
    if (drawn) std::filesystem::rename(part, stem + ending, error);
    moved = moved && !error;
    std::filesystem::remove(part, error);
  }
  if (!moved) return failed;
  return Done{};
}

}  // namespace sheaf
