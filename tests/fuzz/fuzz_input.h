// Takes a fuzzer's bytes apart.
#ifndef SHEAF_TESTS_FUZZ_FUZZ_INPUT_H_
#define SHEAF_TESTS_FUZZ_FUZZ_INPUT_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace sheaf::fuzz {

// Ends the run: libFuzzer keeps the input.
[[noreturn]] inline void Fail(const std::string& what) {
  std::fprintf(stderr, "found: %s\n", what.c_str());
  std::abort();
}

// Bytes from the front; zeros once they have run out.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size)
      : left_(reinterpret_cast<const char*>(data), size) {}

  template <typename T>
  T Take() {
    T value = {};
    const std::size_t count = std::min(sizeof value, left_.size());
    std::memcpy(&value, left_.data(), count);
    left_.remove_prefix(count);
    return value;
  }
  bool is_empty() const { return left_.empty(); }
  std::string_view rest() const { return left_; }

 private:
  std::string_view left_;
};

}  // namespace sheaf::fuzz

#endif  // SHEAF_TESTS_FUZZ_FUZZ_INPUT_H_
