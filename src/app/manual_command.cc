#include "src/app/manual_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/manual.h"
#include "src/app/standard_output.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

struct ManualRequest {
  std::string word;
};

void AddCompletionOptions(CLI::App& app, ManualRequest& request) {
  AddInput(app, "SHELL", request.word, Presence::kNeeded, "bash or zsh");
}

Status RunCompletion(const ManualRequest& request) {
  if (request.word == "bash") return WriteStandardOutput(BashCompletion(Manuals()));
  if (request.word == "zsh") return WriteStandardOutput(ZshCompletion(Manuals()));
  return Usage(fmt::format("SHELL: \"{}\" is not bash or zsh", Printable(request.word)));
}

void AddManOptions(CLI::App& app, ManualRequest& request) {
  AddInput(app, "COMMAND", request.word, Presence::kOptional,
           "The command whose page it is; the page of all if absent");
}

Status RunMan(const ManualRequest& request) {
  const std::vector<CommandManual> manuals = Manuals();
  if (request.word.empty()) return WriteStandardOutput(ManPage(manuals));
  const auto found = std::find_if(manuals.begin(), manuals.end(), [&](const CommandManual& manual) {
    return manual.name == request.word;
  });
  if (found == manuals.end()) {
    return Usage(fmt::format("COMMAND: there is no command \"{}\"", Printable(request.word)));
  }
  return WriteStandardOutput(ManPage(*found));
}

}  // namespace

Command CompletionCommand() { return MakeCommand(&AddCompletionOptions, &RunCompletion); }
Command ManCommand() { return MakeCommand(&AddManOptions, &RunMan); }

}  // namespace sheaf
