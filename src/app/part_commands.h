// One picture, or one sequence of pictures, as commands that any number of machines can run.
#ifndef SHEAF_APP_PART_COMMANDS_H_
#define SHEAF_APP_PART_COMMANDS_H_

#include <optional>
#include <string>
#include <vector>

#include "src/app/render_request.h"

namespace sheaf {

// A picture that parts are joined into.
struct WholePicturePath {
  std::string path;
  std::optional<Layer> layer;  // beside the picture of `of`
  std::string of;
};

struct PartPlan {
  std::string program;             // the path of this command
  std::vector<std::string> words;  // of the scene and of the options that all parts have
  std::string trailer;             // shell text behind them
  int parts = 1;
  std::string output, format, statistics;
  // Where there are several frames each part has some of them, and nothing is joined.
  std::optional<FrameRange> frames;
  std::vector<WholePicturePath> wholes;
};

// The part that a command renders, as texts for a shell.
struct PartIndex {
  std::string number;       // from 1
  std::string first, last;  // of its frames, where it has any
};

// Part `part`, from 1, of the plan: plain numbers.
PartIndex IndexOf(const PartPlan& plan, int part);

// The part whose number is in the shell's variable `name`.
PartIndex IndexIn(const PartPlan& plan, const std::string& name);

// The command that renders a part, as a line of shell without its end.
std::string PartCommand(const PartPlan& plan, const PartIndex& index);

// For each whole picture a line of shell that joins its parts, and then removes them.
std::vector<std::string> MergeCommands(const PartPlan& plan);

}  // namespace sheaf

#endif  // SHEAF_APP_PART_COMMANDS_H_
