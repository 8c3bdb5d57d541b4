#include "src/core/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <utility>

#include "src/core/out_of_memory.h"

namespace sheaf {
namespace {

enum class PathKind { kAbsent, kRegular, kStream };

// What a path leads to, and how to write there.
struct Destination {
  PathKind kind;
  std::string path;    // symbolic links followed, so that a link is kept and its file replaced
  std::string folder;  // ends in '/'
  mode_t mode;         // of the regular file that is there
};

Error InputOutput(const std::string& path, const char* what, int code) {
  ThrowIfOutOfMemory(code);
  return {ErrorKind::kInputOutput, path + ": " + what + ": " + std::strerror(code)};
}

// /dev/stdout may lead to a regular file that a shell holds open: renaming over it would leave the
// shell's own output behind.
bool NamesDevice(const std::string& path) {
  return path.starts_with("/dev/") || path.starts_with("/proc/");
}

// Where a link leads to a file that is not there yet, that file. stat has refused circles.
std::string FollowDangling(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  fs::path target = path;
  while (fs::is_symlink(target, ignored)) {
    target = target.parent_path() / fs::read_symlink(target, ignored);
  }
  return target.string();
}

// Ends in '/'.
std::string FolderOf(const std::string& path) {
  const std::string folder = path.substr(0, path.rfind('/') + 1);
  return folder.empty() ? "./" : folder;
}

Result<Destination> Resolve(const std::string& path) {
  if (path.empty()) return Error{ErrorKind::kInputOutput, "the output path is empty"};
  struct stat status;
  const bool exists = stat(path.c_str(), &status) == 0;
  if (!exists && errno != ENOENT) return InputOutput(path, "cannot be written", errno);
  if (exists && S_ISDIR(status.st_mode)) {
    return Error{ErrorKind::kInputOutput, path + ": is a folder"};
  }
  Destination destination{PathKind::kAbsent, path, "", 0};
  if (exists) {
    destination.kind =
        S_ISREG(status.st_mode) && !NamesDevice(path) ? PathKind::kRegular : PathKind::kStream;
    destination.mode = status.st_mode & 07777;
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                           &std::free);
    if (!real) ThrowIfOutOfMemory(errno);
    // A pipe behind /proc/self/fd has no real path; it is opened by the one it has.
    if (real && destination.kind == PathKind::kRegular) destination.path = real.get();
  }
  if (!exists) destination.path = FollowDangling(path);
  destination.folder = FolderOf(destination.path);
  return destination;
}

// A file that no folder lists; -1 where the system has none, or no way to name it later.
int OpenNameless(const std::string& folder) {
#ifdef O_TMPFILE
  if (access("/proc/self/fd", X_OK) != 0) return -1;
  return open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
#else
  return -1;
#endif
}

// Short whatever the file is called, because a name near the system's limit leaves no room to add.
std::string TemporaryName(const std::string& folder) {
  static std::atomic<unsigned> counter{0};
  return folder + ".sheaf-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".tmp";
}

// Calls `create`, which is negative where it fails, with new names in `name` until one is free: a
// killed process of the same id may have left some behind. An errno, or 0.
template <typename CreateFile>
int TryNames(const std::string& folder, std::string& name, const CreateFile& create) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    name = TemporaryName(folder);
    if (create() >= 0) return 0;
    if (errno != EEXIST) return errno;
  }
  return EEXIST;
}

}  // namespace

Status CheckWritable(const std::string& path) {
  const Result<Destination> resolved = Resolve(path);
  if (!resolved) return resolved.error();
  const Destination& destination = resolved.value();
  if (destination.kind != PathKind::kAbsent && access(destination.path.c_str(), W_OK) != 0) {
    return InputOutput(path, "cannot be written", errno);
  }
  if (destination.kind == PathKind::kStream) return Done{};
  struct stat status;
  if (stat(destination.folder.c_str(), &status) != 0) {
    return InputOutput(path, "its folder", errno);
  }
  if (access(destination.folder.c_str(), W_OK | X_OK) != 0) {
    return InputOutput(path, "its folder cannot be written", errno);
  }
  return Done{};
}

AtomicFile::AtomicFile(int descriptor, Kind kind, std::string path, std::string destination,
                       std::string temporary)
    : descriptor_(descriptor),
      kind_(kind),
      path_(std::move(path)),
      destination_(std::move(destination)),
      temporary_(std::move(temporary)) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      kind_(other.kind_),
      path_(std::move(other.path_)),
      destination_(std::move(other.destination_)),
      temporary_(std::move(other.temporary_)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  if (kind_ == Kind::kNamed) unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::Create(const std::string& path) {
  const Status writable = CheckWritable(path);
  if (!writable) return writable.error();
  const Result<Destination> resolved = Resolve(path);
  if (!resolved) return resolved.error();
  const Destination& destination = resolved.value();

  if (destination.kind == PathKind::kStream) {
    // Append: where /dev/stdout leads to a file, what is in it already stays.
    const int descriptor =
        open(destination.path.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC | O_NOCTTY);
    if (descriptor < 0) return InputOutput(path, "cannot be opened", errno);
    return AtomicFile(descriptor, Kind::kStream, path, destination.path, "");
  }

  // 0666 lets the user's umask decide, which mkstemp would not.
  Kind kind = Kind::kNameless;
  std::string temporary;
  int descriptor = OpenNameless(destination.folder);
  if (descriptor < 0) {
    kind = Kind::kNamed;
    const int code = TryNames(destination.folder, temporary, [&] {
      descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      return descriptor;
    });
    if (code != 0) return InputOutput(path, "cannot be created", code);
  }
  AtomicFile file(descriptor, kind, path, destination.path, temporary);
  if (destination.kind == PathKind::kRegular && fchmod(descriptor, destination.mode) != 0) {
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

int AtomicFile::LinkTo(const std::string& name) const {
  const std::string descriptor = "/proc/self/fd/" + std::to_string(descriptor_);
  return linkat(AT_FDCWD, descriptor.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW);
}

int AtomicFile::Flush() const {
  const int copy = fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
  return copy >= 0 && close(copy) == 0 ? 0 : errno;
}

int AtomicFile::Link() {
  if (const int code = Flush(); code != 0) return code;
  if (LinkTo(destination_) == 0) return 0;
  if (errno != EEXIST) return errno;
  std::string name;
  const int code = TryNames(FolderOf(destination_), name, [&] { return LinkTo(name); });
  if (code == 0) temporary_ = std::move(name);  // which cannot fail
  return code;
}

Status AtomicFile::Commit() {
  assert(descriptor_ >= 0);
  // close() may report a late write error (quota, network file system); the file is then not whole.
  int code = kind_ == Kind::kNameless ? Link() : 0;
  if (close(std::exchange(descriptor_, -1)) != 0 && kind_ != Kind::kNameless) code = errno;
  if (code == 0 && !temporary_.empty() &&
      std::rename(temporary_.c_str(), destination_.c_str()) != 0) {
    code = errno;
  }
  if (code == 0) return Done{};
  if (!temporary_.empty()) unlink(temporary_.c_str());
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
