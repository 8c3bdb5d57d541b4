// What tells the work of one run from all other work.
#ifndef SHEAF_APP_RUN_IDENTITY_H_
#define SHEAF_APP_RUN_IDENTITY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/error.h"

namespace sheaf {

// Of all bytes of a file. kInputOutput where it cannot be read.
Result<std::uint64_t> FileChecksum(const std::string& path);

// Of this version of Sheaf, the text of the options and the bytes of the files that a scene is read
// from. One that cannot be read, such as a texture that is left out, differs from any that can.
std::uint64_t RunIdentity(const std::string& options, const std::vector<std::string>& files);

}  // namespace sheaf

#endif  // SHEAF_APP_RUN_IDENTITY_H_
