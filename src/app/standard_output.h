// stdout carries data only, and data that did not arrive is an error.
#ifndef SHEAF_APP_STANDARD_OUTPUT_H_
#define SHEAF_APP_STANDARD_OUTPUT_H_

#include <string_view>

#include "sheaf/error.h"

namespace sheaf {

// Writes lines and flushes. Control characters between them are shown as \u00XX, which in JSON
// means the same. kInputOutput where the reader is gone or the disk is full.
Status WriteStandardOutput(std::string_view text);

}  // namespace sheaf

#endif  // SHEAF_APP_STANDARD_OUTPUT_H_
