// Typed reading of a JsonTree that keeps the first error of the file instead of stopping at each.
//
// Every Read leaves its output alone where the value is absent or wrong, so that a reader is a
// plain list of reads and the outputs' initial values are the defaults.
#ifndef SHEAF_FORMATS_JSON_CURSOR_H_
#define SHEAF_FORMATS_JSON_CURSOR_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "src/formats/json_tree.h"

namespace sheaf {

// Holds low <= x <= high; an open end is given as the nearest double inside. `text` completes
// "expected ...".
struct NumberRange {
  double low, high;
  std::string_view text;
};

// The error that stands first in the file, whatever the order in which errors are found.
class JsonErrors {
 public:
  JsonErrors(const JsonTree& tree, const std::string& file) : tree_(tree), file_(file) {}
  JsonErrors(const JsonErrors&) = delete;
  JsonErrors& operator=(const JsonErrors&) = delete;

  const JsonTree& tree() const { return tree_; }
  const std::optional<Error>& first() const { return first_; }

  // Whether an error at this node would replace the one that is kept: ask before costly messages.
  bool IsFirst(std::uint32_t node) const { return PlaceOf(node) < place_; }
  void AddAt(std::uint32_t node, std::string_view what);

  // Something is missing in `node`, which shows only where the node ends: a misspelt key inside
  // comes before the missing one that it causes. `key` may be empty.
  void AddMissing(std::uint32_t node, std::string_view key, std::string_view what);

 private:
  static std::uint64_t PlaceOf(std::uint32_t node) { return 2 * std::uint64_t{node} + 1; }
  void Keep(std::uint64_t place, std::uint32_t node, std::string_view key, std::string_view what);

  const JsonTree& tree_;
  const std::string& file_;
  std::uint64_t place_ = ~std::uint64_t{0};
  std::optional<Error> first_;
};

// One value of the tree, or nothing, for which every call does nothing.
class JsonCursor {
 public:
  JsonCursor() = default;
  JsonCursor(JsonErrors* errors, std::uint32_t node) : errors_(errors), node_(node) {}

  bool present() const { return errors_ != nullptr; }
  bool Is(JsonKind kind) const { return present() && node().kind == kind; }
  std::uint32_t index() const { return node_; }
  std::uint32_t line() const { return node().line; }
  bool IsEmpty() const { return node().count == 0; }                       // of an array or object
  std::string_view key() const { return tree().strings[node().key]; }      // of a member
  std::string_view text() const { return tree().strings[node().string]; }  // of a string

  void Fail(std::string_view what) const {
    if (present()) errors_->AddAt(node_, what);
  }
  bool WouldBeFirst() const { return present() && errors_->IsFirst(node_); }
  // `expected` names what had to stand here; the message adds what does.
  void FailKind(std::string_view expected) const;

  // Each returns whether *out was written.
  bool Read(const NumberRange& range, double* out) const;
  bool ReadInteger(const NumberRange& range, int* out) const;
  bool ReadBoolean(bool* out) const;
  bool ReadString(std::string* out) const;

  // The elements of an array of exactly `count`, else an error that asks for `expected`.
  template <std::size_t count>
  std::optional<std::array<JsonCursor, count>> ReadTuple(std::string_view expected) const {
    if (!IsArrayOf(count, expected)) return std::nullopt;
    std::array<JsonCursor, count> elements;
    std::size_t i = 0;
    ForEachChild([&](const JsonCursor& element) { elements[i++] = element; });
    return elements;
  }

  // Visits elements or members in the order of the file; nothing where the value is absent or of
  // another kind, the latter being an error.
  template <typename Visit>
  void ForEachElement(Visit visit) const {
    if (Expect(JsonKind::kArray)) ForEachChild(visit);
  }
  template <typename Visit>
  void ForEachMember(Visit visit) const {
    if (Expect(JsonKind::kObject)) ForEachChild(visit);
  }

 private:
  friend class JsonObject;

  const JsonTree& tree() const { return errors_->tree(); }
  const JsonNode& node() const { return tree().nodes[node_]; }
  bool Expect(JsonKind kind) const;
  bool IsArrayOf(std::size_t count, std::string_view expected) const;

  template <typename Visit>
  void ForEachChild(Visit visit) const {
    for (std::uint32_t child = node_ + 1; child < node().end; child = tree().nodes[child].end) {
      visit(JsonCursor(errors_, child));
    }
  }

  JsonErrors* errors_ = nullptr;
  std::uint32_t node_ = 0;
};

// The members of one object. A reader asks for every key that it knows and then calls Finish, which
// reports the others: the list of known keys is written nowhere else.
class JsonObject {
 public:
  // Anything but an object is an error, and then no key is present.
  explicit JsonObject(const JsonCursor& value);

  JsonCursor Optional(std::string_view key);
  JsonCursor Required(std::string_view key);

  // The one of these keys that is present; several are an error, and none is one for OneOf. Where
  // several are present the first of `keys` is returned.
  JsonCursor AtMostOneOf(std::span<const std::string_view> keys);
  JsonCursor OneOf(std::span<const std::string_view> keys);
  JsonCursor AtMostOneOf(std::initializer_list<std::string_view> keys) {
    return AtMostOneOf(std::span(keys.begin(), keys.size()));
  }
  JsonCursor OneOf(std::initializer_list<std::string_view> keys) {
    return OneOf(std::span(keys.begin(), keys.size()));
  }

  void FailMissing(std::string_view key, std::string_view what) const;

  void Finish() const;

 private:
  JsonCursor Find(std::string_view key) const;

  JsonCursor value_;  // absent unless an object
  std::vector<std::string_view> known_;
};

// One of the things that an object may hold, by the key under which it stands.
template <typename Thing>
struct KeyedReader {
  std::string_view key;
  Thing (*read)(const JsonCursor& value);
};

template <typename Thing, std::size_t count>
std::array<std::string_view, count> KeysOf(const KeyedReader<Thing> (&readers)[count]) {
  std::array<std::string_view, count> keys;
  for (std::size_t i = 0; i < count; ++i) keys[i] = readers[i].key;
  return keys;
}

// `value` stands under one of the keys.
template <typename Thing, std::size_t count>
Thing ReadByKey(const JsonCursor& value, const KeyedReader<Thing> (&readers)[count]) {
  for (const KeyedReader<Thing>& reader : readers) {
    if (reader.key == value.key()) return reader.read(value);
  }
  return {};
}

}  // namespace sheaf

#endif  // SHEAF_FORMATS_JSON_CURSOR_H_
