#include "src/app/slurm_script.h"

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string_view>

#include "src/app/choose.h"
#include "src/app/shell_words.h"
#include "src/formats/printable.h"
#include "src/lab/has_program.h"

namespace sheaf {
namespace {

constexpr std::string_view kEndOfJob = "SHEAF";

// A call of sbatch with the lines of its job, whose number the variable `name` gets.
std::string Sbatch(const std::string& name, const std::string& options, const std::string& job) {
  // Of a cluster among several its name follows the number, after a semicolon.
  return fmt::format(
      "{0}=$(sbatch --parsable {1} <<'{2}'\n#!/bin/sh\n{3}{2}\n)\n{0}=${{{0}%%;*}}\n", name,
      options, kEndOfJob, job);
}

}  // namespace

Status CheckSbatchOptions(const std::vector<std::string>& options) {
  for (const std::string& option : options) {
    const std::string name = option.substr(0, option.find('='));
    if (!option.starts_with("-")) {
      return Usage(
          fmt::format("--sbatch={}: no option; --sbatch=--time=2:00:00 is one", Printable(option)));
    }
    for (const char* ours : {"--array", "-a", "--dependency", "-d", "--parsable", "--wrap"}) {
      if (name != ours) continue;
      return Usage(
          fmt::format("--sbatch={}: sheaf submit gives {} itself", Printable(option), name));
    }
  }
  return Done{};
}

std::string SlurmScript(const PartPlan& plan, const std::vector<std::string>& options) {
  const std::string name = plan.output.substr(plan.output.rfind('/') + 1);
  std::string given;
  for (const std::string& option : options) given += ShellWord(option) + " ";
  const auto titled = [&](const char* what) {
    return ShellWord(fmt::format("--job-name=sheaf {} {}", what, name));
  };
  std::string script = "#!/bin/sh\n# Gives the jobs to Slurm: run it where sbatch is.\nset -e\n";
  // What a preempted or failed node had finished is in the journal of --resume.
  script += Sbatch("parts",
                   fmt::format("{} {}--array=1-{} --requeue --open-mode=append", titled("parts of"),
                               given, plan.parts),
                   fmt::format("part=$SLURM_ARRAY_TASK_ID\nexec {}\n",
                               PartCommand(plan, IndexIn(plan, "part"))));
  const std::vector<std::string> merges = MergeCommands(plan);
  if (merges.empty()) return script + "echo \"parts: $parts\"\n";
  std::string job = "set -e\n";
  for (const std::string& merge : merges) job += merge + "\n";
  script += Sbatch("merge",
                   fmt::format("{} {}--dependency=afterok:\"$parts\" --kill-on-invalid-dep=yes "
                               "--requeue --open-mode=append",
                               titled("merge of"), given),
                   job);
  return script + "echo \"parts: $parts, merge: $merge\"\n";
}

Status RunSlurmScript(const std::string& script) {
  if (!HasProgram("sbatch")) {
    return Error{ErrorKind::kInputOutput,
                 "submit --run: no sbatch on the PATH; without --run the script is printed"};
  }
  std::FILE* const shell = popen("sh", "w");
  if (shell == nullptr) return Error{ErrorKind::kInputOutput, "submit --run: no shell can be run"};
  const bool is_written = std::fwrite(script.data(), 1, script.size(), shell) == script.size();
  if (pclose(shell) != 0 || !is_written) {
    return Error{ErrorKind::kInputOutput, "submit --run: sbatch took not all of the jobs"};
  }
  return Done{};
}

}  // namespace sheaf
