// A file's bytes where they are: mapped, read-only.
#ifndef SHEAF_CORE_MAPPED_FILE_H_
#define SHEAF_CORE_MAPPED_FILE_H_

#include <cstddef>
#include <string>

#include "sheaf/error.h"

namespace sheaf {

class MappedFile {
 public:
  // Fails with kInputOutput where `path` is no regular file that can be read. The mapping outlives
  // the file's name.
  static Result<MappedFile> Open(const std::string& path);

  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) = delete;
  ~MappedFile();

  // Aligned to pages; null where the file is empty.
  const std::byte* data() const { return data_; }
  std::size_t size() const { return size_; }

 private:
  MappedFile(const std::byte* data, std::size_t size) : data_(data), size_(size) {}

  const std::byte* data_;
  std::size_t size_;
};

}  // namespace sheaf

#endif  // SHEAF_CORE_MAPPED_FILE_H_
