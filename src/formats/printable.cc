#include "src/formats/printable.h"

#include <fmt/format.h>

#include <limits>

namespace sheaf {
namespace {

unsigned ByteAt(std::string_view text, std::size_t index) {
  return index < text.size() ? static_cast<unsigned char>(text[index]) : 0u;
}

// The length of the UTF-8 sequence at `index`, or 0 where there is none. Overlong forms are not
// told apart: they are harmless here.
std::size_t SequenceLength(std::string_view text, std::size_t index) {
  const unsigned lead = ByteAt(text, index);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xc2 && lead < 0xe0 ? 2
                             : lead >= 0xe0 && lead < 0xf0 ? 3
                             : lead >= 0xf0 && lead < 0xf5 ? 4
                                                           : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((ByteAt(text, index + i) & 0xc0u) != 0x80u) return 0;
  }
  return length;
}

}  // namespace

std::string Printable(std::string_view text, std::size_t max_bytes) {
  std::string shown;
  for (std::size_t i = 0; i < text.size();) {
    if (shown.size() >= max_bytes) return shown + "...";
    const std::size_t length = SequenceLength(text, i);
    const unsigned byte = ByteAt(text, i);
    if (length == 0) {
      shown += fmt::format("\\x{:02X}", byte);
    } else if (length == 1 && (byte < 0x20 || byte == 0x7f)) {
      shown += fmt::format("\\u{:04X}", byte);
    } else if (byte == 0xc2 && ByteAt(text, i + 1) < 0xa0) {  // C1 controls, U+0080 to U+009F
      shown += fmt::format("\\u{:04X}", ByteAt(text, i + 1));
    } else {
      shown += text.substr(i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return shown;
}

std::string PrintablePath(std::string_view path) {
  return Printable(path, std::numeric_limits<std::size_t>::max());
}

}  // namespace sheaf
