#include "src/app/submit_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <utility>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/part_commands.h"
#include "src/app/plan_frames.h"
#include "src/app/plan_render.h"
#include "src/app/slurm_script.h"
#include "src/app/standard_output.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

struct SubmitRequest {
  RenderRequest render;
  std::vector<std::string> words;  // the options for each part, as --name=value
  std::optional<int> parts;
  std::string list;  // which commands; empty: a script for Slurm
  std::vector<std::string> sbatch;
  bool run = false;
};

void AddSubmitOptions(CLI::App& app, SubmitRequest& request) {
  AddRenderOptions(app, request.render);
  AddInteger(app, "--parts", request.parts, 1, 100000, "How many jobs render (needed)");
  app.get_option("--parts")->required();
  app.add_flag("--list{parts}", request.list,
               "Print the commands, one a line, instead of a script for Slurm")
      ->option_text("[=parts|merge|all]")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
      ->check(CLI::IsMember({"parts", "merge", "all"}));
  AddWords(app, "--sbatch", request.sbatch, "=OPTION",
           "An option for sbatch, like --sbatch=--time=2:00:00; may stand more than once");
  AddFlag(app, "--run", request.run, "Give the jobs to sbatch instead of printing the script");
  app.parse_complete_callback([&app, &request] {
    request.words = GivenWords(app, {"SCENE", "--output", "--tile", "--frames", "--json", "--parts",
                                     "--list", "--sbatch", "--run"});
  });
}

// What the options ask for that parts cannot do.
Status CheckParts(const SubmitRequest& request) {
  const RenderRequest& render = request.render;
  if (render.part) return Usage("--tile: sheaf submit makes the parts, as many as --parts says");
  if (render.budget) {
    return Usage("--budget: parts would differ in their error; --error gives all the same");
  }
  if (render.output == "-" || render.output.starts_with("/dev/")) {
    return Usage(fmt::format("-o {}: parts need a file", Printable(render.output)));
  }
  if (request.run && !request.list.empty()) {
    return Usage("--run, --list: commands are given to Slurm, or printed");
  }
  if (!request.list.empty() && !request.sbatch.empty()) {
    return Usage("--sbatch, --list: a list of commands has no use for options of sbatch");
  }
  return CheckSbatchOptions(request.sbatch);
}

// The same of a picture that is cut into rows.
Status CheckCut(const SubmitRequest& request, const RenderPlan& plan) {
  const int rows = plan.options.height;
  if (*request.parts > rows) {
    return Usage(fmt::format("--parts {}: the picture has {} rows", *request.parts, rows));
  }
  if (request.render.crop) return Usage("--crop: parts are cut from whole pictures");
  if (request.render.denoise == "oidn") {
    return Usage("--denoise=oidn: its parts do not join; sheaf denoise filters the whole");
  }
  for (const auto& [layer, path] : plan.frames.front().beside) {
    if (layer != Layer::kHeat) continue;
    return Usage(
        fmt::format("--aov heat: parts of {} do not join; those of .exr do", PrintablePath(path)));
  }
  return Done{};
}

// Lines are what the lists and scripts are made of.
Status CheckLines(const PartPlan& plan, const std::vector<std::string>& sbatch) {
  std::vector<std::string> texts = plan.words;
  texts.insert(texts.end(), {plan.program, plan.output, plan.statistics});
  texts.insert(texts.end(), sbatch.begin(), sbatch.end());
  for (const WholePicturePath& whole : plan.wholes) texts.push_back(whole.path);
  for (const std::string& text : texts) {
    if (text.find('\n') == std::string::npos) continue;
    return Usage(fmt::format("\"{}\": a line may not end within a word", Printable(text)));
  }
  return Done{};
}

PartPlan PlanParts(const SubmitRequest& request, const RenderPlan& plan) {
  PartPlan parts;
  std::error_code error;
  parts.program = std::filesystem::read_symlink("/proc/self/exe", error).string();
  if (error) parts.program = "sheaf";
  parts.words = {request.render.scene};
  parts.words.insert(parts.words.end(), request.words.begin(), request.words.end());
  parts.parts = *request.parts;
  parts.output = plan.request.output;
  parts.format = request.render.format;
  parts.statistics = request.render.statistics;
  const std::optional<FrameRange> sequence = SequenceOf(request.render);
  if (sequence && sequence->count() > 1) {
    parts.frames = sequence;
    return parts;
  }
  if (sequence && request.render.frames) {
    parts.words.push_back(fmt::format("--frames={}", sequence->first));
  }
  for (const Frame& frame : plan.frames) {
    parts.wholes.push_back({frame.path, std::nullopt, frame.path});
    for (const auto& [layer, path] : frame.beside) {
      parts.wholes.push_back({path, layer, frame.path});
    }
  }
  return parts;
}

std::string ListText(const std::string& which, const PartPlan& plan) {
  std::string text;
  for (int part = 1; part <= plan.parts && which != "merge"; ++part) {
    text += PartCommand(plan, IndexOf(plan, part)) + "\n";
  }
  if (which == "parts") return text;
  for (const std::string& command : MergeCommands(plan)) text += command + "\n";
  return text;
}

// For jobs of Slurm: as many threads as a job has cores, and a requeued job goes on.
void AddSlurmWords(const RenderRequest& render, PartPlan* plan) {
  if (!render.resume) plan->words.push_back("--resume");
  if (!render.threads) plan->trailer = " --threads=\"${SLURM_CPUS_ON_NODE:-0}\"";
}

Status RunSubmit(const SubmitRequest& request) {
  if (const Status sound = CheckParts(request); !sound) return sound;
  const Result<RenderPlan> planned = PlanRender(request.render);
  if (!planned) return planned.error();
  PartPlan plan = PlanParts(request, planned.value());
  if (plan.frames && plan.parts > plan.frames->count()) {
    return Usage(fmt::format("--parts {}: there are {} frames", plan.parts, plan.frames->count()));
  }
  if (!plan.frames) {
    if (const Status sound = CheckCut(request, planned.value()); !sound) return sound;
  }
  if (const Status sound = CheckLines(plan, request.sbatch); !sound) return sound;
  if (!request.list.empty()) return WriteStandardOutput(ListText(request.list, plan));
  AddSlurmWords(request.render, &plan);
  const std::string script = SlurmScript(plan, request.sbatch);
  return request.run ? RunSlurmScript(script) : WriteStandardOutput(script);
}

}  // namespace

Command SubmitCommand() { return MakeCommand(&AddSubmitOptions, &RunSubmit); }

}  // namespace sheaf
