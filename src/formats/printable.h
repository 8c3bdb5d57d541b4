// Makes text from a file safe to show in a one-line message.
#ifndef SHEAF_FORMATS_PRINTABLE_H_
#define SHEAF_FORMATS_PRINTABLE_H_

#include <cstddef>
#include <string>
#include <string_view>

namespace sheaf {

// Control characters become \u00XX and bytes that are not UTF-8 become \xXX, so that no file can
// break the line or reach the terminal. What is longer than `max_bytes` is cut and ends in "...".
std::string Printable(std::string_view text, std::size_t max_bytes = 200);

// The same for the path of a file, which is never cut.
std::string PrintablePath(std::string_view path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PRINTABLE_H_
