// Errors as values: every fallible function returns a Result; nothing throws across a module.
#ifndef SHEAF_SHEAF_ERROR_H_
#define SHEAF_SHEAF_ERROR_H_

#include <cassert>
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

// A value or an Error. Accessing the alternative that is not there is a broken invariant.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT: implicit by design
  Result(Error error) : state_(std::move(error)) {}  // NOLINT: implicit by design

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  T& value() & {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  const T& value() const& {
    assert(ok());
    return *std::get_if<0>(&state_);
  }
  T&& value() && {
    assert(ok());
    return std::move(*std::get_if<0>(&state_));
  }
  const Error& error() const {
    assert(!ok());
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

// The result of an operation that yields nothing but success.
struct Done {};
using Status = Result<Done>;

}  // namespace sheaf

#endif  // SHEAF_SHEAF_ERROR_H_
