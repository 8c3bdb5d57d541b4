// The headers of an OpenEXR file, looked over before the library believes what they claim.
#ifndef SHEAF_FORMATS_EXR_HEADER_H_
#define SHEAF_FORMATS_EXR_HEADER_H_

#include <cstdint>
#include <string>

#include "sheaf/error.h"

namespace sheaf {

// kInputOutput where a header of the file of so many `bytes` claims attributes, tables of offsets,
// lines or tiles that such a file cannot have: OpenEXR makes room for them as it opens the file.
// Also where the data are deep. A header that the library will refuse for another reason passes.
Status CheckExrHeaders(const std::string& path, std::uint64_t bytes);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_EXR_HEADER_H_
