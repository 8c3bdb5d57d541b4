// The command `sheaf`. docs/command.md is its manual.
#include <fcntl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/version.h"
#include "src/app/bench_command.h"
#include "src/app/check_command.h"
#include "src/app/compare_command.h"
#include "src/app/convert_command.h"
#include "src/app/exit_code.h"
#include "src/app/info_command.h"
#include "src/app/merge_command.h"
#include "src/app/pareto_command.h"
#include "src/app/render_command.h"
#include "src/app/standard_output.h"
#include "src/app/stress_command.h"
#include "src/formats/printable.h"
#include "src/formats/suggest_name.h"

namespace sheaf {
namespace {

constexpr char kFooter[] = R"(
Examples:
  sheaf render scene.json -o picture.png
  sheaf render scene.json --views seven -o 'out/{camera}.png'
  sheaf render scene.json --camera front --size 1280x960 --json -o front.pfm
  sheaf render model.glb -o model.exr --aov depth,normal
  sheaf render scene.json --tile 2/8 -o part2.png
  sheaf merge part1.png part2.png ... -o whole.png
  sheaf convert scene.nff -o scene.json
  sheaf check scene.json
  sheaf compare scene.json --targets all --threads 1,2
  sheaf compare expected.png found.png --fail psnr=40
  sheaf bench scene.json --baseline before.json
  sheaf pareto scene.json -o report/
  sheaf stress
  sheaf info scene.json

Exit codes: 0 all went well, 1 differences or slower, 2 usage, 3 bad scene, 4 input or output,
130 interrupted, 143 terminated.)";

// CLI11 names a flag together with the value that it has when it stands alone: "--json{-}".
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    const std::string name = CLI::Formatter::make_option_name(option, is_positional);
    return name.substr(0, name.find('{'));
  }
};

// A file opened while descriptor 1 is closed would become standard output. So the closed ones are
// filled; what is written to standard output then fails, as it should.
void FillStandardDescriptors() {
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) == -1) {
      open("/dev/null", descriptor == 2 ? O_WRONLY : O_RDONLY);
    }
  }
}

ExitCode ToExitCode(const Status& status) {
  return status.ok() ? ExitCode::kOk : Report(status.error());
}

ExitCode ToExitCode(const Result<ExitCode>& result) {
  return result.ok() ? result.value() : Report(result.error());
}

// Names the first word that fits nothing. CLI11 would rather complain about what it then misses.
std::string DescribeExtra(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const CLI::App* subcommand : app.get_subcommands({}))
    known.push_back(subcommand->get_name());
  const auto option = std::find(known.begin(), known.end(), "--" + word);
  const std::string hint = option != known.end() ? fmt::format("; did you mean \"{}\"?", *option)
                                                 : DidYouMean(word, {known.begin(), known.end()});
  const bool is_option = word.starts_with("-");
  const bool needs_subcommand = app.get_require_subcommand_min() > 0;
  return fmt::format("{} \"{}\"{}",
                     is_option          ? "unknown option"
                     : needs_subcommand ? "unknown subcommand"
                                        : "unexpected argument",
                     Printable(word), hint);
}

// CLI11 would take "--json=" for "--json", and "--size= 9x9" for "--size 9x9".
std::optional<std::string> FindEmptyValue(int argc, char** argv) {
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--") && word.find('=') + 1 == word.size()) return word;
  }
  return std::nullopt;
}

// CLI11 asks for help and version by exception, too.
ExitCode ReportParse(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) {
    return ToExitCode(WriteStandardOutput(app.help()));
  }
  if (dynamic_cast<const CLI::CallForVersion*>(&error) != nullptr) {
    return ToExitCode(WriteStandardOutput(fmt::format("{}\n", error.what())));
  }
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App& innermost = parsed.empty() ? app : *parsed.front();
  std::vector<std::string> extra = innermost.remaining();
  // What stands after it is wrong, where anything is.
  extra.erase(std::remove(extra.begin(), extra.end(), "--"), extra.end());
  const bool about_extra = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                           dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string what =
      about_extra && !extra.empty() ? DescribeExtra(innermost, extra.front()) : error.what();
  return Report(
      {ErrorKind::kUsage, fmt::format("{} (see {}{} --help)", what, parsed.empty() ? "" : "sheaf ",
                                      innermost.get_name())});
}

ExitCode Main(int argc, char** argv) {
  FillStandardDescriptors();
  // A reader that goes away and a limit on the size of files show as failed writes, which are
  // reported.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);

  CLI::App app("Sheaf, a SIMD packet ray tracer for CPUs", "sheaf");
  app.set_version_flag("--version", fmt::format("sheaf {}", kVersion));
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(kFooter);
  app.require_subcommand(1);
  RenderRequest render_request;
  BenchRequest bench_request;
  CheckRequest check_request;
  CompareRequest compare_request;
  ConvertRequest convert_request;
  InfoRequest info_request;
  MergeRequest merge_request;
  ParetoRequest pareto_request;
  StressRequest stress_request;
  const CLI::App* render = AddRenderCommand(app, render_request);
  const CLI::App* bench = AddBenchCommand(app, bench_request);
  const CLI::App* compare = AddCompareCommand(app, compare_request);
  const CLI::App* info = AddInfoCommand(app, info_request);
  const CLI::App* convert = AddConvertCommand(app, convert_request);
  const CLI::App* merge = AddMergeCommand(app, merge_request);
  const CLI::App* check = AddCheckCommand(app, check_request);
  const CLI::App* pareto = AddParetoCommand(app, pareto_request);
  const CLI::App* stress = AddStressCommand(app, stress_request);
  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return ExitCode::kUsage;
  }
  if (const auto word = FindEmptyValue(argc, argv)) {
    return Report({ErrorKind::kUsage, fmt::format("{}: nothing follows the =", Printable(*word))});
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ReportParse(app, error);
  }
  if (render->parsed()) return ToExitCode(RunRender(render_request));
  if (bench->parsed()) return ToExitCode(RunBench(bench_request));
  if (compare->parsed()) return ToExitCode(RunCompare(compare_request));
  if (info->parsed()) return ToExitCode(RunInfo(info_request));
  if (convert->parsed()) return ToExitCode(RunConvert(convert_request));
  if (merge->parsed()) return ToExitCode(RunMerge(merge_request));
  if (check->parsed()) return ToExitCode(RunCheck(check_request));
  if (pareto->parsed()) return ToExitCode(RunPareto(pareto_request));
  if (stress->parsed()) return ToExitCode(RunStress(stress_request));
  return ExitCode::kInternal;
}

// Nothing of Sheaf throws; the standard library does where memory or threads run out.
int GuardedMain(int argc, char** argv) {
  try {
    return static_cast<int>(Main(argc, argv));
  } catch (const std::bad_alloc&) {
    std::fputs("sheaf: not enough memory\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sheaf: internal error: %s\n", error.what());
  }
  return static_cast<int>(ExitCode::kInternal);
}

}  // namespace
}  // namespace sheaf

int main(int argc, char** argv) { return sheaf::GuardedMain(argc, argv); }
