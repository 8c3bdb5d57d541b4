#include "src/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

namespace sheaf {
namespace {

enum class Kind { kAbsent, kRegular, kStream };

// What a path leads to, and how to write there.
struct Destination {
  Kind kind;
  std::string path;    // symbolic links followed, so that a link is kept and its file replaced
  std::string folder;  // ends in '/'
  mode_t mode;         // of the regular file that is there
};

Error InputOutput(const std::string& path, const char* what, int code) {
  return {ErrorKind::kInputOutput, path + ": " + what + ": " + std::strerror(code)};
}

// /dev/stdout may lead to a regular file that a shell holds open: renaming over it would leave the
// shell's own output behind.
bool NamesDevice(const std::string& path) {
  return path.starts_with("/dev/") || path.starts_with("/proc/");
}

Result<Destination> Resolve(const std::string& path) {
  if (path.empty()) return Error{ErrorKind::kInputOutput, "the output path is empty"};
  struct stat status;
  const bool exists = stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) return InputOutput(path, "cannot be written", errno);
  if (exists && S_ISDIR(status.st_mode)) {
    return Error{ErrorKind::kInputOutput, path + ": is a folder"};
  }
  Destination destination{Kind::kAbsent, path, "", 0};
  if (exists) {
    destination.kind =
        S_ISREG(status.st_mode) && !NamesDevice(path) ? Kind::kRegular : Kind::kStream;
    destination.mode = status.st_mode & 07777;
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                           &std::free);
    // A pipe behind /proc/self/fd has no real path; it is opened by the one it has.
    if (real && destination.kind == Kind::kRegular) destination.path = real.get();
  }
  destination.folder = destination.path.substr(0, destination.path.rfind('/') + 1);
  if (destination.folder.empty()) destination.folder = "./";
  return destination;
}

// Short whatever the file is called, because a name near the system's limit leaves no room to add.
std::string TemporaryName(const std::string& folder) {
  static std::atomic<unsigned> counter{0};
  return folder + ".sheaf-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
}

}  // namespace

Status CheckWritable(const std::string& path) {
  const Result<Destination> resolved = Resolve(path);
  if (!resolved) return resolved.error();
  const Destination& destination = resolved.value();
  if (destination.kind != Kind::kAbsent && access(destination.path.c_str(), W_OK) != 0) {
    return InputOutput(path, "cannot be written", errno);
  }
  if (destination.kind == Kind::kStream) return Done{};
  struct stat status;
  if (stat(destination.folder.c_str(), &status) != 0) {
    return InputOutput(path, "its folder", errno);
  }
  if (access(destination.folder.c_str(), W_OK | X_OK) != 0) {
    return InputOutput(path, "its folder cannot be written", errno);
  }
  return Done{};
}

AtomicFile::AtomicFile(int descriptor, std::string path, std::string destination,
                       std::string temporary)
    : descriptor_(descriptor),
      path_(std::move(path)),
      destination_(std::move(destination)),
      temporary_(std::move(temporary)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      path_(std::move(other.path_)),
      destination_(std::move(other.destination_)),
      temporary_(std::move(other.temporary_)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::Create(const std::string& path) {
  const Status writable = CheckWritable(path);
  if (!writable) return writable.error();
  const Result<Destination> resolved = Resolve(path);
  if (!resolved) return resolved.error();
  const Destination& destination = resolved.value();

  if (destination.kind == Kind::kStream) {
    // Append: where /dev/stdout leads to a file, what is in it already stays.
    const int descriptor =
        open(destination.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0) return InputOutput(path, "cannot be opened", errno);
    return AtomicFile(descriptor, path, destination.path, "");
  }

  // O_EXCL with 0666 lets the user's umask decide, which mkstemp would not. A name that a killed
  // process of the same id left behind is passed over.
  int descriptor = -1;
  std::string temporary;
  for (int attempt = 0; attempt < 100 && descriptor < 0; ++attempt) {
    temporary = TemporaryName(destination.folder);
    descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno != EEXIST) break;
  }
  if (descriptor < 0) return InputOutput(path, "cannot be created", errno);
  AtomicFile file(descriptor, path, destination.path, temporary);
  if (destination.kind == Kind::kRegular && fchmod(descriptor, destination.mode) != 0) {
    return InputOutput(path, "cannot keep its permissions", errno);
  }
  return file;
}

// `write_some(done, left)` writes some of the `left` bytes after the first `done`, as write(2)
// does.
template <typename WriteSome>
Status AtomicFile::WriteAll(std::size_t size, const WriteSome& write_some) {
  assert(descriptor_ >= 0);
  for (std::size_t done = 0; done < size;) {
    const ssize_t written = write_some(done, size - done);
    if (written < 0) {
      if (errno == EINTR) continue;
      return InputOutput(path_, "cannot be written", errno);
    }
    done += static_cast<std::size_t>(written);
  }
  return Done{};
}

Status AtomicFile::Write(const void* data, std::size_t size) {
  return WriteAll(size, [&](std::size_t done, std::size_t left) {
    return write(descriptor_, static_cast<const char*>(data) + done, left);
  });
}

Status AtomicFile::WriteAt(std::uint64_t offset, const void* data, std::size_t size) {
  assert(seekable());
  static_assert(sizeof(off_t) >= 8, "large pictures have files of more than 2 GiB");
  return WriteAll(size, [&](std::size_t done, std::size_t left) {
    return pwrite(descriptor_, static_cast<const char*>(data) + done, left,
                  static_cast<off_t>(offset + done));
  });
}

Status AtomicFile::Commit() {
  assert(descriptor_ >= 0);
  // close() may report a late write error (quota, network file system); the file is then not whole.
  int code = close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno;
  if (temporary_.empty()) {
    return code == 0 ? Status(Done{}) : InputOutput(path_, "cannot be written", code);
  }
  if (code == 0 && std::rename(temporary_.c_str(), destination_.c_str()) != 0) code = errno;
  if (code == 0) return Done{};
  unlink(temporary_.c_str());
  return InputOutput(path_, "cannot be written", code);
}

Status WriteFileWhole(const std::string& path, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  const Status written = file.value().Write(bytes.data(), bytes.size());
  if (!written) return written;
  return file.value().Commit();
}

}  // namespace sheaf
