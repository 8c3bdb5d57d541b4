// Whole files as bytes, and errors that name them.
#ifndef SHEAF_FORMATS_READ_FILE_H_
#define SHEAF_FORMATS_READ_FILE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "sheaf/error.h"

namespace sheaf {

// `path: what`, of kInputOutput and of kScene.
Error InputError(const std::string& path, std::string_view what);
Error SceneError(const std::string& path, std::string_view what);
// `path:line: what`, of kScene.
Error SceneErrorAt(const std::string& path, std::size_t line, std::string_view what);

inline constexpr std::size_t kMaxTextBytes = std::size_t{1} << 30;
// 16 GiB, or what an address of 32 bits can show.
inline constexpr std::size_t kMaxModelBytes = std::size_t{1} << (sizeof(std::size_t) > 4 ? 34 : 31);

// What reading a file of so many bytes may allocate beside the pictures, meshes and trees that it
// describes: whatever it claims of itself.
constexpr std::size_t MostMemoryFor(std::size_t file_bytes) {
  return 8 * file_bytes + (std::size_t{64} << 20);
}

// The bytes of a file or a pipe; memory grows with what is really there. kInputOutput where it
// cannot be read or is larger than `max_bytes`. Leaves in `code`, unless that is null, the errno
// of what failed, else 0.
Result<std::string> ReadWholeFile(const std::string& path, std::size_t max_bytes = kMaxModelBytes,
                                  int* code = nullptr);

// The bytes that a file has. kInputOutput where it cannot be opened, or is none.
Result<std::uint64_t> FileSize(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_READ_FILE_H_
