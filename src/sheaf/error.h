// Errors as values: every fallible function returns a Result; nothing throws across a module.
#ifndef SHEAF_SHEAF_ERROR_H_
#define SHEAF_SHEAF_ERROR_H_

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <variant>

namespace sheaf {

// The kinds are what a caller can act on; the command maps each to an exit code.
enum class ErrorKind {
  kUsage,        // the caller asked for something that does not exist or does not fit
  kScene,        // the scene is malformed or not renderable
  kInputOutput,  // a file cannot be read or written
  kInterrupted,  // the caller asked to stop
};

// `message` is one line that names the place, without a trailing period or newline.
struct Error {
  ErrorKind kind;
  std::string message;
};

namespace internal {
[[noreturn]] inline void End(const char* call, const char* message) {
  std::fprintf(stderr, "sheaf: %s: %s\n", call, message);
  std::abort();
}
}  // namespace internal

// A value or an Error. Asking for the alternative that is not there ends the program, in every
// build, with the error's message on standard error: ask ok() first.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: implicit by design
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: implicit by design

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & {
    CheckOk();
    return *std::get_if<0>(&state_);
  }
  const T& value() const& {
    CheckOk();
    return *std::get_if<0>(&state_);
  }
  T&& value() && {
    CheckOk();
    return std::move(*std::get_if<0>(&state_));
  }
  const Error& error() const {
    if (ok()) internal::End("Result::error()", "there is none");
    return *std::get_if<1>(&state_);
  }

 private:
  void CheckOk() const {
    if (!ok()) internal::End("Result::value() of an error", error().message.c_str());
  }

  std::variant<T, Error> state_;
};

// The result of an operation that yields nothing but success.
struct Done {};
using Status = Result<Done>;

}  // namespace sheaf

#endif  // SHEAF_SHEAF_ERROR_H_
