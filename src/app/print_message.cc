#include "src/app/print_message.h"

#include <cstdio>

#include "src/formats/printable.h"

namespace sheaf {

void PrintMessage(std::string_view line) {
  // Not fmt::print: it throws where stderr is gone, which is no reason to stop.
  const std::string text = PrintablePath(line) + "\n";
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

}  // namespace sheaf
