// What the command says of itself to other programs: man pages and completions for shells, made of
// the table of commands and their options.
#ifndef SHEAF_APP_MANUAL_H_
#define SHEAF_APP_MANUAL_H_

#include <string>
#include <vector>

namespace sheaf {

// What stands for an option's value.
enum class ValueKind { kNone, kChoice, kFile, kOther };

struct OptionEntry {
  std::vector<std::string>
      names;          // with their dashes, short ones first; of an input its word alone
  std::string value;  // "N", "depth|normal", "[=FILE]"; empty: it takes none
  std::string help;   // one line
  ValueKind kind = ValueKind::kNone;
  std::vector<std::string> choices;
  bool is_input = false;  // without a name, like SCENE
  bool is_needed = false;
  bool is_repeated = false;  // an input that may stand more than once
};

struct CommandManual {
  std::string name, help, examples;
  std::vector<OptionEntry> options;  // inputs are the first
};

// Of every command of the table.
std::vector<CommandManual> Manuals();

// The page sheaf(1), or sheaf-NAME(1) of a command, for man.
std::string ManPage(const std::vector<CommandManual>& manuals);
std::string ManPage(const CommandManual& manual);

// Scripts to be sourced, or laid where the shell looks for them.
std::string BashCompletion(const std::vector<CommandManual>& manuals);
std::string ZshCompletion(const std::vector<CommandManual>& manuals);

}  // namespace sheaf

#endif  // SHEAF_APP_MANUAL_H_
