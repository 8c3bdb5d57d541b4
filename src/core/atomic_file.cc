#include "src/core/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "src/core/checksum.h"
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

// Whoever writes a file holds it, so that a name which nobody holds is one that a killed process
// has left: on other machines, too, and whatever ids processes have there. -1 as it is given.
int Hold(int descriptor) {
  if (descriptor >= 0) flock(descriptor, LOCK_EX);
  return descriptor;
}

// A file that no folder lists; -1 where the system has none, or no way to name it later.
int OpenNameless(const std::string& folder) {
#ifdef O_TMPFILE
  if (access("/proc/self/fd", X_OK) != 0) return -1;
  return Hold(open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
#else
  return -1;
#endif
}

// The n-th hidden name beside `path`. Short whatever the file is called, because a name near the
// system's limit leaves no room to add; of the path alone, so that a later run finds it.
std::string TemporaryName(const std::string& path, int n) {
  const std::string folder = FolderOf(path);
  const std::string name = path.substr(path.rfind('/') + 1);
  Checksum checksum;
  checksum.Add(name.data(), name.size());
  char digits[17];
  std::snprintf(digits, sizeof(digits), "%016llx",
                static_cast<unsigned long long>(checksum.value()));
  return folder + ".sheaf-" + digits + "-" + std::to_string(n) + ".tmp";
}

bool IsSameFile(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

// Unlinks a temporary that nobody holds.
void RemoveLeftover(const std::string& name) {
  struct stat status, held;
  if (lstat(name.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  const int descriptor = open(name.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (descriptor < 0) return;
  // Once it is held here, nobody else renames or unlinks it. Before, its writer may have done so,
  // and the name be another's.
  if (flock(descriptor, LOCK_EX | LOCK_NB) == 0 && fstat(descriptor, &held) == 0 &&
      lstat(name.c_str(), &status) == 0 && IsSameFile(status, held)) {
    unlink(name.c_str());
  }
  close(descriptor);
}

// More runs than these do not write one file at a time and are killed in the same moment.
constexpr int kLeftoverNames = 8;

void RemoveLeftovers(const std::string& path) {
  for (int n = 0; n < kLeftoverNames; ++n) RemoveLeftover(TemporaryName(path, n));
}

// Calls `create`, which is negative where it fails, with hidden names beside `path` in `name` until
// one is free: other runs may write the same file. An errno, or 0.
template <typename CreateFile>
int TryNames(const std::string& path, std::string& name, const CreateFile& create) {
  for (int n = 0; n < 100; ++n) {
    name = TemporaryName(path, n);
    if (create() >= 0) return 0;
    if (errno != EEXIST) return errno;
  }
  return EEXIST;
}

// A new file of this name, held; negative with errno where that fails.
int OpenNamed(const std::string& name) {
  const int descriptor = Hold(open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  struct stat status;
  if (descriptor < 0 || fstat(descriptor, &status) != 0 || status.st_nlink > 0) return descriptor;
  // Another run took it for a leftover before it was held. The next name, then.
  close(descriptor);
  errno = EEXIST;
  return -1;
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
  if (kind_ == Kind::kNamed) unlink(temporary_.c_str());
  close(descriptor_);
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

  RemoveLeftovers(destination.path);
  // 0666 lets the user's umask decide, which mkstemp would not.
  Kind kind = Kind::kNameless;
  std::string temporary;
  int descriptor = OpenNameless(destination.folder);
  if (descriptor < 0) {
    kind = Kind::kNamed;
    const int code =
        TryNames(destination.path, temporary, [&] { return descriptor = OpenNamed(temporary); });
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
  const int code = TryNames(destination_, name, [&] { return LinkTo(name); });
  if (code == 0) temporary_ = std::move(name);  // which cannot fail
  return code;
}

Status AtomicFile::Commit() {
  assert(descriptor_ >= 0);
  // What close() reports late (quota, network file system) is asked for before: the file is held
  // until its hidden name is gone.
  int code = kind_ == Kind::kNameless ? Link() : Flush();
  if (!temporary_.empty()) {
    if (code == 0 && std::rename(temporary_.c_str(), destination_.c_str()) != 0) code = errno;
    if (code != 0) unlink(temporary_.c_str());
  }
  close(std::exchange(descriptor_, -1));
  if (code != 0) return InputOutput(path_, "cannot be written", code);
  return Done{};
}

Status WriteFileWhole(const std::string& path, std::string_view bytes) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  const Status written = file.value().Write(bytes.data(), bytes.size());
  if (!written) return written;
  return file.value().Commit();
}

}  // namespace sheaf
