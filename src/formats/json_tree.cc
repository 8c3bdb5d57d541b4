#include "src/formats/json_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "src/formats/printable.h"

namespace sheaf {
namespace {

// Feeds the parser and leaves in *read how far it has got. The parser copies and moves its
// iterators, so the count lives outside.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** read) : at_(at), read_(read) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    *read_ = ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** read_;
};

// Takes the part of nlohmann's message that tells what is wrong:
// "[...] parse error at ...: syntax error while parsing value - REASON; last read: '...'; expected
// X"
std::string SyntaxReason(std::string_view what) {
  const std::size_t dash = what.find(" - ");
  if (dash != what.npos) what.remove_prefix(dash + 3);
  std::string reason(what);
  const std::size_t last_read = reason.find("; last read: '");
  if (last_read != reason.npos) {
    const std::size_t expected = reason.rfind("'; expected ");
    reason.erase(last_read, expected == reason.npos ? reason.npos : expected + 1 - last_read);
  }
  return reason;
}

// Receives the parser's events; false stops the parse, with `error` set.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, const std::string& name)
      : name_(name),
        begin_(text.data()),
        end_(begin_ + text.size()),
        read_(begin_),
        counted_(begin_) {}

  bool Run() {
    return nlohmann::json::sax_parse(CountingIterator(begin_, &read_),
                                     CountingIterator(end_, &read_), this,
                                     nlohmann::json::input_format_t::json, /*strict=*/true,
                                     /*ignore_comments=*/true);
  }

  JsonTree tree;
  Error error{ErrorKind::kScene, ""};

  bool null() override {
    AddNode(JsonKind::kNull).number = 0.0;
    return true;
  }
  bool boolean(bool value) override {
    AddNode(JsonKind::kBoolean).number = value ? 1.0 : 0.0;
    return true;
  }
  bool number_integer(number_integer_t value) override {
    AddNode(JsonKind::kNumber).number = static_cast<double>(value);
    return true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    AddNode(JsonKind::kNumber).number = static_cast<double>(value);
    return true;
  }
  bool number_float(number_float_t value, const string_t&) override {
    AddNode(JsonKind::kNumber).number = value;
    return true;
  }
  bool string(string_t& value) override {
    const std::uint32_t index = Intern(value);
    AddNode(JsonKind::kString).string = index;
    return true;
  }
  bool binary(binary_t&) override { return false; }  // not in JSON text

  bool start_object(std::size_t) override { return Open(JsonKind::kObject); }
  bool end_object() override { return Close(); }
  bool start_array(std::size_t) override { return Open(JsonKind::kArray); }
  bool end_array() override { return Close(); }

  bool key(string_t& value) override {
    pending_key_ = Intern(value);
    pending_line_ = Line();
    if (!open_.back().keys.insert(pending_key_).second) return Fail("duplicate key");
    return true;
  }

  bool parse_error(std::size_t, const std::string& token,
                   const nlohmann::detail::exception& exception) override {
    constexpr int kNumberOverflow = 406;
    if (exception.id == kNumberOverflow) {
      const std::string what = fmt::format("the number {} is too large", Printable(token, 40));
      if (open_.empty() || pending_key_ != kNoKey) return Fail(what);
      return FailAt(Path() + fmt::format("/{}", tree.nodes[open_.back().node].count), what);
    }
    if (tree.nodes.empty() && read_ == end_ && IsBlank()) {
      return Fail("not valid JSON: the file is empty");
    }
    std::string reason = SyntaxReason(exception.what());
    constexpr std::string_view kInvalidLiteral = "invalid literal";
    if (reason.starts_with(kInvalidLiteral)) {
      reason.insert(kInvalidLiteral.size(), fmt::format(" '{}'", Printable(BadWord())));
    }
    return Fail("not valid JSON: " + Printable(reason));
  }

 private:
  struct Container {
    std::uint32_t node;
    std::unordered_set<std::uint32_t> keys;
  };

  // The line of the last byte read. Brackets, strings and literals end with that byte; after a
  // number the parser has read one byte more, and a newline belongs to the line that it ends.
  std::uint32_t Line() {
    const char* last = read_ == begin_ ? begin_ : read_ - 1;
    line_ += static_cast<std::uint32_t>(std::count(counted_, std::max(counted_, last), '\n'));
    counted_ = std::max(counted_, last);
    return line_;
  }

  std::uint32_t Intern(const std::string& value) {
    const auto [entry, is_new] =
        interned_.try_emplace(value, static_cast<std::uint32_t>(tree.strings.size()));
    if (is_new) tree.strings.push_back(value);
    return entry->second;
  }

  JsonNode& AddNode(JsonKind kind) {
    if (!open_.empty()) ++tree.nodes[open_.back().node].count;
    JsonNode node;
    node.number = 0.0;
    node.kind = kind;
    node.line = pending_key_ == kNoKey ? Line() : pending_line_;
    node.end = static_cast<std::uint32_t>(tree.nodes.size() + 1);
    node.key = std::exchange(pending_key_, kNoKey);
    tree.nodes.push_back(node);
    return tree.nodes.back();
  }

  bool Open(JsonKind kind) {
    if (open_.size() == kMaxJsonDepth) {
      return Fail(fmt::format("nested deeper than {} levels", kMaxJsonDepth));
    }
    AddNode(kind).count = 0;
    open_.push_back({static_cast<std::uint32_t>(tree.nodes.size() - 1), {}});
    return true;
  }

  bool Close() {
    tree.nodes[open_.back().node].end = static_cast<std::uint32_t>(tree.nodes.size());
    open_.pop_back();
    return true;
  }

  bool IsBlank() const {
    return std::string_view(begin_, static_cast<std::size_t>(end_ - begin_))
               .find_first_not_of("\xEF\xBB\xBF \t\r\n") == std::string_view::npos;
  }

  // The word around the byte at which the parser stopped, at most 40 bytes to either side.
  std::string_view BadWord() const {
    const auto is_word = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '.' || c == '-' || c == '+' || c == '_' || static_cast<unsigned char>(c) >= 0x80;
    };
    if (read_ == begin_) return {};
    const char* first = read_ - 1;
    const char* last = read_;
    while (first != begin_ && read_ - first < 40 && is_word(first[-1])) --first;
    while (is_word(read_[-1]) && last != end_ && last - read_ < 40 && is_word(*last)) ++last;
    return {first, static_cast<std::size_t>(last - first)};
  }

  // The JSON pointer of the innermost open container, or of the member whose key was read last.
  std::string Path() const {
    std::string path;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const JsonNode& node = tree.nodes[open_[i].node];
      if (node.key != kNoKey) {
        AppendPathStep(tree.strings[node.key], &path);
      } else if (i > 0) {  // an element: the last child so far of the container above
        AppendPathStep(std::to_string(tree.nodes[open_[i - 1].node].count - 1), &path);
      }
    }
    if (pending_key_ != kNoKey) AppendPathStep(tree.strings[pending_key_], &path);
    return path;
  }

  bool FailAt(const std::string& path, const std::string& what) {
    error.message = fmt::format("{}:{}: {}{}{}", PrintablePath(name_), Line(), path,
                                path.empty() ? "" : ": ", what);
    return false;
  }

  bool Fail(const std::string& what) { return FailAt(Path(), what); }

  const std::string& name_;
  const char* const begin_;
  const char* const end_;
  const char* read_;     // one past the last byte that the parser took
  const char* counted_;  // newlines before this are in line_
  std::uint32_t line_ = 1;
  std::uint32_t pending_key_ = kNoKey;  // read, its value not yet
  std::uint32_t pending_line_ = 0;
  std::vector<Container> open_;
  std::unordered_map<std::string, std::uint32_t> interned_;
};

}  // namespace

std::string_view DescribeKind(JsonKind kind) {
  constexpr std::string_view kNames[] = {"null",     "a boolean", "a number",
                                         "a string", "an array",  "an object"};
  return kNames[static_cast<std::size_t>(kind)];
}

void AppendPathStep(std::string_view key, std::string* path) {
  std::string escaped;
  for (char c : key) {
    if (c == '~') {
      escaped += "~0";
    } else if (c == '/') {
      escaped += "~1";
    } else {
      escaped += c;
    }
  }
  *path += '/';
  *path += Printable(escaped);
}

std::string JsonTree::PathOf(std::uint32_t node) const {
  std::string path;
  for (std::uint32_t at = 0; at != node;) {
    std::uint32_t index = 0;
    std::uint32_t child = at + 1;
    for (; nodes[child].end <= node; child = nodes[child].end) ++index;
    AppendPathStep(nodes[child].key == kNoKey ? std::to_string(index) : strings[nodes[child].key],
                   &path);
    at = child;
  }
  return path.empty() ? "/" : path;
}

Result<JsonTree> ParseJsonTree(std::string_view text, const std::string& name) {
  // The parser takes a NUL byte for the end of the text and would accept anything behind it.
  const std::size_t nul = text.find('\0');
  if (nul != text.npos) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(nul), '\n');
    return Error{ErrorKind::kScene,
                 fmt::format("{}:{}: not valid JSON: a NUL byte; the file must be UTF-8 text",
                             PrintablePath(name), line)};
  }
  TreeBuilder builder(text, name);
  if (!builder.Run()) return std::move(builder.error);
  return std::move(builder.tree);
}

}  // namespace sheaf
