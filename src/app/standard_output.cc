#include "src/app/standard_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace sheaf {

Status WriteStandardOutput(std::string_view text) {
  const std::size_t written = std::fwrite(text.data(), 1, text.size(), stdout);
  if (written == text.size() && std::fflush(stdout) == 0) return Done{};
  return Error{ErrorKind::kInputOutput, std::string("standard output: ") + std::strerror(errno)};
}

}  // namespace sheaf
