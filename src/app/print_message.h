// Messages for a person, on stderr.
#ifndef SHEAF_APP_PRINT_MESSAGE_H_
#define SHEAF_APP_PRINT_MESSAGE_H_

#include <string_view>

namespace sheaf {

// Prints one line, in one write, so that lines of several processes do not mix. Control characters,
// which a file's name or content may hold, are shown as \u00XX.
void PrintMessage(std::string_view line);

}  // namespace sheaf

#endif  // SHEAF_APP_PRINT_MESSAGE_H_
