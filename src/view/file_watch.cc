#include "src/view/file_watch.h"

#include <sys/stat.h>

#include <algorithm>
#include <utility>

namespace sheaf {

FileWatch::Signature FileWatch::SignatureOf(const std::string& path) {
  struct stat status;
  if (stat(path.c_str(), &status) != 0) return {};
  return {status.st_mtim.tv_sec, status.st_mtim.tv_nsec, static_cast<std::uint64_t>(status.st_size),
          status.st_ino};
}

std::vector<FileWatch::Signature> FileWatch::Look() const {
  std::vector<Signature> look;
  for (const std::string& path : paths_) look.push_back(SignatureOf(path));
  return look;
}

void FileWatch::Watch(const std::vector<std::string>& paths) {
  std::vector<Signature> known;
  for (const std::string& path : paths) {
    const auto at = std::find(paths_.begin(), paths_.end(), path);
    known.push_back(at == paths_.end() ? SignatureOf(path) : read_[at - paths_.begin()]);
  }
  paths_ = paths;
  read_ = known;
  last_look_ = std::move(known);
}

bool FileWatch::HasChanged() {
  const std::vector<Signature> look = Look();
  const bool stands_still = look == last_look_;
  last_look_ = look;
  if (look == read_ || !stands_still) return false;
  read_ = look;
  return true;
}

}  // namespace sheaf
