// Whether files changed on disk since they were read.
#ifndef SHEAF_VIEW_FILE_WATCH_H_
#define SHEAF_VIEW_FILE_WATCH_H_

#include <cstdint>
#include <string>
#include <vector>

namespace sheaf {

// Looks at times, sizes and inodes, so that a file that another one replaced counts too, on every
// file system. A file that is written in pieces counts once it has stood still from one look to the
// next.
class FileWatch {
 public:
  // What is there now is what was read. Of a path that is watched already it is what the last
  // change left, so that one that came while the files were read is not lost.
  void Watch(const std::vector<std::string>& paths);

  // True once after each change. Meant to be called a few times a second.
  bool HasChanged();

 private:
  struct Signature {
    std::int64_t seconds = 0, nanoseconds = 0;
    std::uint64_t size = 0, inode = 0;  // all 0: there is none
    bool operator==(const Signature&) const = default;
  };
  static Signature SignatureOf(const std::string& path);
  std::vector<Signature> Look() const;

  std::vector<std::string> paths_;
  std::vector<Signature> read_, last_look_;
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_FILE_WATCH_H_
