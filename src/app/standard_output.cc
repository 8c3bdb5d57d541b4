#include "src/app/standard_output.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

#include "src/formats/printable.h"

namespace sheaf {

Status WriteStandardOutput(std::string_view text) {
  std::string shown;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    shown += PrintablePath(text.substr(begin, end - begin));
    if (end < text.size()) shown += '\n';
    begin = end + 1;
  }
  const std::size_t written = std::fwrite(shown.data(), 1, shown.size(), stdout);
  if (written == shown.size() && std::fflush(stdout) == 0) return Done{};
  return Error{ErrorKind::kInputOutput, std::string("standard output: ") + std::strerror(errno)};
}

}  // namespace sheaf
