#include "src/formats/text_lines.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "src/formats/text_scanner.h"

namespace sheaf {
namespace {

void AppendUtf8(std::uint32_t code, std::string& out) {
  const auto put = [&](std::uint32_t byte) { out += static_cast<char>(byte); };
  const auto tail = [&](int shift) { put(0x80u | (code >> shift & 0x3fu)); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xc0u | code >> 6);
  } else if (code < 0x10000) {
    put(0xe0u | code >> 12), tail(6);
  } else {
    put(0xf0u | code >> 18), tail(12), tail(6);
  }
  tail(0);
}

}  // namespace

std::string DecodeUtf16(std::string_view bytes) {
  const bool is_big = bytes.starts_with("\xfe\xff");
  std::string text;
  if (!is_big && !bytes.starts_with("\xff\xfe")) return text;
  const auto unit = [&](std::size_t i) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return is_big ? first * 256u + second : second * 256u + first;
  };
  for (std::size_t i = 2; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xe000) {
      const std::uint32_t low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
      const bool is_pair = low >= 0xdc00 && low < 0xe000;
      code = is_pair ? 0x10000 + ((code - 0xd800) << 10) + (low - 0xdc00) : 0xfffd;
      if (is_pair) i += 2;
    }
    AppendUtf8(code, text);
  }
  return text;
}

std::string JoinLines(std::string_view text) {
  std::string joined;
  joined.reserve(text.size());
  std::size_t owed = 0;
  TextScanner scanner(text);
  while (scanner.NextLine()) {
    std::string_view line = scanner.Remainder();
    const bool is_comment = owed == 0 && line.starts_with('#');
    if (line.ends_with('\\') && !is_comment) {
      line.remove_suffix(1);
      joined.append(line) += ' ';
      ++owed;
    } else {
      joined.append(line).append(owed + 1, '\n');
      owed = 0;
    }
  }
  return joined;
}

std::string_view WithoutComment(std::string_view line) {
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] != '#' || !IsBlank(line[i - 1])) continue;
    std::size_t end = i - 1;
    while (end > 0 && IsBlank(line[end - 1])) --end;
    return line.substr(0, end);
  }
  return line;
}

std::string WithSlashes(std::string_view path) {
  std::string changed(path);
  std::replace(changed.begin(), changed.end(), '\\', '/');
  return changed;
}

}  // namespace sheaf
