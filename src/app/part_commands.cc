#include "src/app/part_commands.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <utility>

#include "src/app/layer_picture.h"
#include "src/app/shell_words.h"

namespace sheaf {
namespace {

// Where the number of a part goes into a path: "out/a.png" becomes "out/a.part-3-of-8.png".
struct PartPath {
  std::string before, after;
};

PartPath PartPathOf(const std::string& path, int parts) {
  const std::size_t name = path.rfind('/') + 1;
  const std::size_t dot = path.rfind('.');
  // A hidden file's name is no ending.
  const std::size_t end = dot == std::string::npos || dot <= name ? path.size() : dot;
  return {path.substr(0, end) + ".part-", fmt::format("-of-{}", parts) + path.substr(end)};
}

std::string WithNumber(const PartPath& path, const std::string& number) {
  return ShellPiece(path.before) + number + ShellPiece(path.after);
}

// The first frame of a part, counted from 0; one more: where the part before it ends.
int FrameAt(const FrameRange& frames, int part, int parts) {
  return frames.first + static_cast<int>(std::int64_t{frames.count()} * part / parts);
}

}  // namespace

PartIndex IndexOf(const PartPlan& plan, int part) {
  PartIndex index{fmt::format("{}", part), "", ""};
  if (plan.frames) {
    index.first = fmt::format("{}", FrameAt(*plan.frames, part - 1, plan.parts));
    index.last = fmt::format("{}", FrameAt(*plan.frames, part, plan.parts) - 1);
  }
  return index;
}

PartIndex IndexIn(const PartPlan& plan, const std::string& name) {
  PartIndex index{fmt::format("\"${}\"", name), "", ""};
  if (plan.frames) {
    const auto [first, count] = std::pair(plan.frames->first, plan.frames->count());
    index.first = fmt::format("$(({} + {} * ({} - 1) / {}))", first, count, name, plan.parts);
    index.last = fmt::format("$(({} + {} * {} / {} - 1))", first, count, name, plan.parts);
  }
  return index;
}

std::string PartCommand(const PartPlan& plan, const PartIndex& index) {
  std::string command = ShellWord(plan.program) + " render";
  for (const std::string& word : plan.words) command += " " + ShellWord(word);
  command += plan.trailer;
  if (plan.frames) {
    command +=
        fmt::format(" --frames={}..{} -o {}", index.first, index.last, ShellWord(plan.output));
  } else {
    command += fmt::format(" --tile={}/{} -o {}", index.number, plan.parts,
                           WithNumber(PartPathOf(plan.output, plan.parts), index.number));
  }
  if (plan.statistics == "-") command += " --json";
  if (!plan.statistics.empty() && plan.statistics != "-") {
    command += " --json=" + WithNumber(PartPathOf(plan.statistics, plan.parts), index.number);
  }
  return command;
}

std::vector<std::string> MergeCommands(const PartPlan& plan) {
  std::vector<std::string> commands;
  if (plan.frames) return commands;
  for (const WholePicturePath& whole : plan.wholes) {
    PartPath part = PartPathOf(whole.layer ? whole.of : whole.path, plan.parts);
    if (whole.layer) part.after = LayerPath(part.after, *whole.layer);
    const std::string format = plan.format.empty() ? "" : " --format=" + ShellWord(plan.format);
    commands.push_back(
        fmt::format("set --; for i in $(seq {}); do set -- \"$@\" {}; done; "
                    "{} merge \"$@\" -o {}{} && rm -f -- \"$@\"",
                    plan.parts, WithNumber(part, "\"$i\""), ShellWord(plan.program),
                    ShellWord(whole.path), format));
  }
  return commands;
}

}  // namespace sheaf
