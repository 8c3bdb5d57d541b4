#include "src/formats/json_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/formats/printable.h"
#include "src/formats/suggest_name.h"

namespace sheaf {
namespace {

std::string List(std::span<const std::string_view> keys) {
  std::string list;
  for (std::string_view key : keys) list += fmt::format("{}\"{}\"", list.empty() ? "" : ", ", key);
  return list;
}

}  // namespace

void JsonErrors::AddAt(std::uint32_t node, std::string_view what) {
  Keep(PlaceOf(node), node, "", what);
}

void JsonErrors::AddMissing(std::uint32_t node, std::string_view key, std::string_view what) {
  // Between the node's last descendant and whatever follows.
  Keep(2 * std::uint64_t{tree_.nodes[node].end}, node, key, what);
}

void JsonErrors::Keep(std::uint64_t place, std::uint32_t node, std::string_view key,
                      std::string_view what) {
  if (place >= place_) return;
  place_ = place;
  std::string path = tree_.PathOf(node);
  if (!key.empty()) {
    if (path == "/") path.clear();
    AppendPathStep(key, &path);
  }
  first_ = Error{ErrorKind::kScene, fmt::format("{}:{}: {}: {}", PrintablePath(file_),
                                                tree_.nodes[node].line, path, what)};
}

void JsonCursor::FailKind(std::string_view expected) const {
  if (WouldBeFirst())
    Fail(fmt::format("expected {}, found {}", expected, DescribeKind(node().kind)));
}

bool JsonCursor::Read(const NumberRange& range, double* out) const {
  if (!present()) return false;
  if (node().kind != JsonKind::kNumber) {
    FailKind(range.text);
    return false;
  }
  const double number = node().number;
  if (!(number >= range.low && number <= range.high)) {
    if (WouldBeFirst()) Fail(fmt::format("expected {}, found {}", range.text, number));
    return false;
  }
  *out = number;
  return true;
}

bool JsonCursor::ReadInteger(const NumberRange& range, int* out) const {
  double number = 0.0;
  if (!Read(range, &number)) return false;
  // 640.0 and 64e1 are integers, as they are to JSON Schema.
  if (number != std::floor(number)) {
    if (WouldBeFirst()) Fail(fmt::format("expected {}, found {}", range.text, number));
    return false;
  }
  *out = static_cast<int>(number);
  return true;
}

bool JsonCursor::ReadBoolean(bool* out) const {
  if (!present()) return false;
  if (node().kind != JsonKind::kBoolean) {
    FailKind("true or false");
    return false;
  }
  *out = node().number != 0.0;
  return true;
}

bool JsonCursor::ReadString(std::string* out) const {
  if (!Expect(JsonKind::kString)) return false;
  *out = text();
  return true;
}

bool JsonCursor::Expect(JsonKind kind) const {
  if (!present()) return false;
  if (node().kind == kind) return true;
  FailKind(DescribeKind(kind));
  return false;
}

bool JsonCursor::IsArrayOf(std::size_t count, std::string_view expected) const {
  if (!present()) return false;
  if (node().kind != JsonKind::kArray) {
    FailKind(expected);
    return false;
  }
  if (node().count != count) {
    if (WouldBeFirst()) {
      Fail(fmt::format("expected {}, found an array of length {}", expected, node().count));
    }
    return false;
  }
  return true;
}

JsonObject::JsonObject(const JsonCursor& value) {
  if (value.Expect(JsonKind::kObject)) value_ = value;
}

JsonCursor JsonObject::Find(std::string_view key) const {
  JsonCursor found;
  if (value_.present()) {
    value_.ForEachChild([&](const JsonCursor& member) {
      if (member.key() == key) found = member;
    });
  }
  return found;
}

JsonCursor JsonObject::Optional(std::string_view key) {
  known_.push_back(key);
  return Find(key);
}

JsonCursor JsonObject::Required(std::string_view key) {
  const JsonCursor member = Optional(key);
  if (!member.present()) FailMissing(key, "missing key");
  return member;
}

JsonCursor JsonObject::AtMostOneOf(std::span<const std::string_view> keys) {
  JsonCursor chosen;
  for (std::string_view key : keys) {
    const JsonCursor member = Optional(key);
    if (!member.present()) continue;
    if (!chosen.present()) {
      chosen = member;
      continue;
    }
    // The blame falls on the one that stands later in the file.
    const bool is_later = member.index() > chosen.index();
    const JsonCursor& later = is_later ? member : chosen;
    const JsonCursor& earlier = is_later ? chosen : member;
    if (later.WouldBeFirst()) {
      later.Fail(fmt::format("conflicts with \"{}\"; give one of {}", earlier.key(), List(keys)));
    }
  }
  return chosen;
}

JsonCursor JsonObject::OneOf(std::span<const std::string_view> keys) {
  const JsonCursor member = AtMostOneOf(keys);
  if (!member.present()) FailMissing("", "missing key; give one of " + List(keys));
  return member;
}

void JsonObject::FailMissing(std::string_view key, std::string_view what) const {
  if (value_.present()) value_.errors_->AddMissing(value_.node_, key, what);
}

void JsonObject::Finish() const {
  if (!value_.present()) return;
  value_.ForEachChild([&](const JsonCursor& member) {
    const bool is_known = std::find(known_.begin(), known_.end(), member.key()) != known_.end();
    if (!is_known && member.WouldBeFirst()) {
      member.Fail("unknown key" + DidYouMean(member.key(), known_));
    }
  });
}

}  // namespace sheaf
