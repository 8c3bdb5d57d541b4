// Words and numbers of a text, line by line.
#ifndef SHEAF_FORMATS_TEXT_SCANNER_H_
#define SHEAF_FORMATS_TEXT_SCANNER_H_

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

namespace sheaf {

// All of `word` as a number; "nan" and "inf" are numbers here. A leading plus is allowed.
template <typename T>
std::optional<T> ParseWord(std::string_view word) {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  T value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

inline bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

// Lines end in LF or CR LF; in CR alone where the first one does. A UTF-8 byte order mark is passed
// over. Holds no copy: the text outlives it.
class TextScanner {
 public:
  explicit TextScanner(std::string_view text) : rest_(text) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
    const std::size_t end = rest_.find_first_of("\r\n");
    const bool is_cr = end != std::string_view::npos && rest_[end] == '\r';
    if (is_cr && rest_.substr(end + 1, 1) != "\n") line_end_ = '\r';
  }

  char line_end() const { return line_end_; }

  // The number of the line in work, from 1; 0 before the first NextLine.
  std::size_t line() const { return line_; }
  std::string_view rest() const { return rest_; }  // after the line in work

  // Goes to the next line; false at the end.
  bool NextLine() {
    if (rest_.empty()) return false;
    const std::size_t end = rest_.find(line_end_);
    current_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
    return true;
  }

  // The next word of the line; empty at its end.
  std::string_view Word() {
    std::size_t i = 0;
    while (i < current_.size() && IsBlank(current_[i])) ++i;
    std::size_t end = i;
    while (end < current_.size() && !IsBlank(current_[end])) ++end;
    const std::string_view word = current_.substr(i, end - i);
    current_.remove_prefix(end);
    return word;
  }
  // What is left of the line, without the blanks around it.
  std::string_view Remainder() {
    while (!current_.empty() && IsBlank(current_.front())) current_.remove_prefix(1);
    while (!current_.empty() && IsBlank(current_.back())) current_.remove_suffix(1);
    return current_;
  }
  template <typename T>
  std::optional<T> Number() {
    return ParseWord<T>(Word());
  }

 private:
  std::string_view rest_, current_;
  char line_end_ = '\n';
  std::size_t line_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_TEXT_SCANNER_H_
