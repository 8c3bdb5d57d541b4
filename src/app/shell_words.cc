#include "src/app/shell_words.h"

namespace sheaf {
namespace {

bool IsPlain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         std::string_view("_-./,:=+@%^").find(c) != std::string_view::npos;
}

}  // namespace

std::string ShellPiece(std::string_view text) {
  std::string quoted = "'";
  bool is_plain = true;
  for (const char c : text) {
    is_plain = is_plain && IsPlain(c);
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return is_plain ? std::string(text) : quoted + "'";
}

std::string ShellWord(std::string_view text) { return text.empty() ? "''" : ShellPiece(text); }

}  // namespace sheaf
