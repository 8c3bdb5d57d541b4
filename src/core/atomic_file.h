// A file that appears whole or not at all: written beside its place, then renamed into it.
#ifndef SHEAF_CORE_ATOMIC_FILE_H_
#define SHEAF_CORE_ATOMIC_FILE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "sheaf/error.h"

namespace sheaf {

// Whether `path` can be written: its folder exists and takes new files, and it is itself absent, a
// writable file or a device. kInputOutput otherwise. Meant for a check before long work.
Status CheckWritable(const std::string& path);

// Bytes go to a temporary in the folder of `path`; Commit() renames it, so that a reader sees the
// old file or the new one. The temporary has no name before that, and vanishes however the process
// ends, but on file systems that know no such files: there it is hidden, and removed without a
// Commit. Where it replaces a file it has a hidden name for the moment before the rename, since
// no system call names a file in another's place; one that a killed process left so is removed by
// the next Create of this path. Pipes and devices (anything under /dev) have no
// whole to protect: bytes go straight there.
class AtomicFile {
 public:
  static Result<AtomicFile> Create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&& other) = delete;
  ~AtomicFile();

  // Whether WriteAt may be called: pipes and devices take bytes in their order alone.
  bool seekable() const { return kind_ != Kind::kStream; }

  // After a failed Write or WriteAt the only call left is the destructor.
  Status Write(const void* data, std::size_t size);
  // At a byte offset from the file's beginning, in any order; what nothing is written to holds
  // zeros. Leaves the place where Write goes on.
  Status WriteAt(std::uint64_t offset, const void* data, std::size_t size);
  Status Commit();

 private:
  enum class Kind { kStream, kNamed, kNameless };

  AtomicFile(int descriptor, Kind kind, std::string path, std::string destination,
             std::string temporary);
  // Gives a nameless file the name `name`; negative with errno where that fails.
  int LinkTo(const std::string& name) const;
  // What closing would report, while the file can still be dropped; an errno, or 0.
  int Flush() const;
  // A nameless file appears at the destination, or as `temporary_` where that is taken; an errno,
  // or 0.
  int Link();
  template <typename WriteSome>
  Status WriteAll(std::size_t size, const WriteSome& write_some);

  int descriptor_;           // -1 once committed or moved from
  Kind kind_;                // of the temporary, or kStream where there is none
  std::string path_;         // as the caller spelled it, for messages
  std::string destination_;  // where the rename goes: `path_` with symbolic links followed
  std::string temporary_;    // its name, empty while it has none
};

// Create, Write and Commit in one.
Status WriteFileWhole(const std::string& path, std::string_view bytes);

}  // namespace sheaf

#endif  // SHEAF_CORE_ATOMIC_FILE_H_
