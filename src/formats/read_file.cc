#include "src/formats/read_file.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "src/core/out_of_memory.h"
#include "src/formats/held_files.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

Error SystemError(const std::string& path, std::string_view what, int code) {
  ThrowIfOutOfMemory(code);
  return InputError(path, fmt::format("{}: {}", what, std::generic_category().message(code)));
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OpenFile = std::unique_ptr<std::FILE, CloseFile>;

std::string SizeText(std::size_t bytes) { return fmt::format("{} GiB", bytes >> 30); }

}  // namespace

Error InputError(const std::string& path, std::string_view what) {
  return {ErrorKind::kInputOutput, fmt::format("{}: {}", PrintablePath(path), what)};
}

Error SceneError(const std::string& path, std::string_view what) {
  return {ErrorKind::kScene, fmt::format("{}: {}", PrintablePath(path), what)};
}

Error SceneErrorAt(const std::string& path, std::size_t line, std::string_view what) {
  return {ErrorKind::kScene, fmt::format("{}:{}: {}", PrintablePath(path), line, what)};
}

Result<std::string> ReadWholeFile(const std::string& path, std::size_t max_bytes, int* code) {
  const auto fail = [&](std::string_view what, int reason) {
    if (code != nullptr) *code = reason;
    return SystemError(path, what, reason);
  };
  if (code != nullptr) *code = 0;
  if (const std::string* held = FindHeldFile(path)) {
    if (held->size() > max_bytes) return InputError(path, "larger than " + SizeText(max_bytes));
    return *held;
  }
  if (AreAllFilesHeld()) return fail("cannot open", ENOENT);
  const OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) return fail("cannot open", errno);
  // The size is only a hint, since pipes have none; the limit holds while reading.
  struct stat status {};
  std::string text;
  std::size_t expected = 0;
  if (fstat(fileno(file.get()), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
    expected = std::min(static_cast<std::size_t>(status.st_size), max_bytes);
  }
  // One read of all that is expected, and small ones for what a pipe still has.
  std::size_t size = 0;
  int reason = 0;
  for (;;) {
    const std::size_t step = std::max<std::size_t>(expected - std::min(size, expected), 1 << 16);
    text.resize(size + step);
    const std::size_t count = std::fread(text.data() + size, 1, step, file.get());
    if (std::ferror(file.get())) reason = errno;  // before anything else can change it
    size += count;
    text.resize(size);
    if (size > max_bytes) return InputError(path, "larger than " + SizeText(max_bytes));
    if (count == 0) break;
  }
  if (reason != 0) return fail("cannot read", reason);
  HoldFile(path, text);
  return text;
}

Result<std::uint64_t> FileSize(const std::string& path) {
  const OpenFile file(std::fopen(path.c_str(), "rb"));
  if (!file) return SystemError(path, "cannot open", errno);
  struct stat status {};
  if (fstat(fileno(file.get()), &status) != 0) return SystemError(path, "cannot read", errno);
  if (!S_ISREG(status.st_mode)) return InputError(path, "is no seekable file");
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace sheaf
