// The command line as CLI11 parses it.
#ifndef SHEAF_APP_COMMAND_LINE_H_
#define SHEAF_APP_COMMAND_LINE_H_

#include <memory>
#include <utility>
#include <vector>

#include "src/app/command.h"

namespace sheaf {

// What the exit codes mean, a line or two.
inline constexpr char kExitCodes[] =
    "Exit codes: 0 all went well, 1 differences or slower, 2 usage, 3 bad scene, 4 input or "
    "output,\n"
    "5 no verdict, 130 interrupted, 143 terminated.";

// Every command of the table, with its options, its help and its examples.
struct CommandLine {
  std::unique_ptr<CLI::App> app;
  std::vector<std::pair<CLI::App*, Command>> commands;  // in the order of the table

  CommandLine();
  ~CommandLine();
};

}  // namespace sheaf

#endif  // SHEAF_APP_COMMAND_LINE_H_
