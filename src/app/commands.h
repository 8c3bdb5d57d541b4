// The table of subcommands.
#ifndef SHEAF_APP_COMMANDS_H_
#define SHEAF_APP_COMMANDS_H_

#include <span>

#include "src/app/command.h"

namespace sheaf {

struct CommandEntry {
  const char* name;
  const char* help;      // one line
  const char* examples;  // lines of the help, each with its newline; may be empty
  Command (*make)();
};

// In the order of the help.
std::span<const CommandEntry> Commands();

}  // namespace sheaf

#endif  // SHEAF_APP_COMMANDS_H_
