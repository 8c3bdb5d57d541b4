// Match calls the function of the alternative, and does not compile where one is missing.
#include "src/core/match.h"

#include <doctest/doctest.h>

#include <string>
#include <variant>

namespace sheaf {
namespace {

using Value = std::variant<int, std::string>;

constexpr auto kOfInt = [](const int&) { return "int"; };
constexpr auto kOfString = [](const std::string&) { return "string"; };

template <typename Variant, typename... Functions>
concept Matches = requires(Variant variant, Functions... functions) {
  Match(variant, functions...);
};

static_assert(Matches<Value, decltype(kOfInt), decltype(kOfString)>);
static_assert(!Matches<Value, decltype(kOfInt)>, "a string has no function");
static_assert(!Matches<Value, decltype(kOfString)>, "an int has no function");

TEST_CASE("Match calls the function of the alternative that a variant holds") {
  const Value number = 7, word = std::string("seven");
  CHECK(Match(number, kOfInt, kOfString) == std::string("int"));
  CHECK(Match(word, kOfInt, kOfString) == std::string("string"));
}

TEST_CASE("Match passes the alternative itself: it may be changed, and its reference returned") {
  Value value = 7;
  Match(
      value, [](int& i) { i = 8; }, [](std::string& s) { s.clear(); });
  CHECK(std::get<int>(value) == 8);
  const auto size = [](const Value& v) {
    return Match(
        v, [](int i) { return i; },
        [](const std::string& s) { return static_cast<int>(s.size()); });
  };
  CHECK(size(value) == 8);
  CHECK(size(std::string("ab")) == 2);
}

}  // namespace
}  // namespace sheaf
