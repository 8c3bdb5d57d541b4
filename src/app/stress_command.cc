#include "src/app/stress_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/interrupt.h"
#include "src/app/standard_output.h"
#include "src/formats/printable.h"
#include "src/formats/suggest_name.h"
#include "src/lab/stress.h"

namespace sheaf {
namespace {

constexpr char kRayFormat[] = "ox,oy,oz,dx,dy,dz,t_min,t_max,source";

struct StressRequest {
  std::vector<std::string> cases;  // empty: all
  bool list = false, thorough = false;
  std::optional<stress::Ray> replay;
};

Result<std::vector<stress::Case>> ChooseCases(const std::vector<std::string>& names) {
  const std::span<const stress::Case> all = stress::Cases();
  if (names.empty()) return std::vector<stress::Case>(all.begin(), all.end());
  std::vector<stress::Case> chosen;
  for (const std::string& name : names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const stress::Case& c) { return name == c.name; });
    if (found == all.end()) {
      std::vector<std::string_view> known;
      for (const stress::Case& c : all) known.push_back(c.name);
      return Usage(fmt::format("unknown case \"{}\"{} (--list shows them)", Printable(name),
                               DidYouMean(name, known)));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

// A ray needs the one case that traces it.
Status CheckReplay(const StressRequest& request) {
  if (!request.replay) return Done{};
  if (request.cases.size() != 1) return Usage("--replay: it takes the one case that is named");
  const std::span<const stress::Case> all = stress::Cases();
  const bool renders = std::any_of(all.begin(), all.end(), [&](const stress::Case& c) {
    return request.cases.front() == c.name && c.subject == stress::Subject::kPictures;
  });
  if (!renders) return Done{};
  return Usage(fmt::format("--replay: the case \"{}\" renders pictures and traces no single rays",
                           request.cases.front()));
}

void AddStressOptions(CLI::App& app, StressRequest& request) {
  AddInputs(app, "CASE", request.cases, Presence::kOptional, "The cases; all if absent");
  AddFlag(app, "--list", request.list, "The cases and what is expected of each");
  AddFlag(app, "--thorough", request.thorough,
          "More and larger: all take a quarter of an hour or more");
  AddParsed(app, "--replay", request.replay, "RAY", fmt::format("a ray {}", kRayFormat),
            fmt::format("Trace {}, as a failure prints it, in the one case named", kRayFormat),
            &stress::ParseRay);
}

// kDifferent where a case fails.
Result<ExitCode> RunStress(const StressRequest& request) {
  const auto cases = ChooseCases(request.cases);
  if (!cases) return cases.error();
  if (request.list) {
    std::string text;
    for (const stress::Case& c : cases.value()) {
      text += fmt::format("{:22}{}\n", c.name, c.expected);
    }
    const Status written = WriteStandardOutput(text);
    if (!written) return written.error();
    return ExitCode::kOk;
  }
  if (const Status sound = CheckReplay(request); !sound) return sound.error();
  ExitOnInterrupts();
  std::size_t failed = 0;
  for (const stress::Case& c : cases.value()) {
    stress::Report report(request.thorough ? stress::Effort::kThorough : stress::Effort::kUsual,
                          request.replay);
    c.run(report);
    // A case that checks nothing has shown nothing.
    const bool passed = report.failures() == 0 && report.checks() > 0;
    failed += !passed;
    std::string text = fmt::format("{:6} {:22}{}\n", passed ? "ok" : "FAILED", c.name, c.expected);
    for (const std::string& line : report.lines()) text += fmt::format("       {}\n", line);
    if (report.failures() > report.lines().size()) {
      text += fmt::format("       {} of {} checks failed\n", report.failures(), report.checks());
    }
    for (const std::string& note : report.notes()) text += fmt::format("       {}\n", note);
    const Status written = WriteStandardOutput(text);
    if (!written) return written.error();
  }
  const Status written =
      WriteStandardOutput(fmt::format("{} of {} cases failed\n", failed, cases.value().size()));
  if (!written) return written.error();
  return failed == 0 ? ExitCode::kOk : ExitCode::kDifferent;
}

}  // namespace

Command StressCommand() { return MakeCommand(&AddStressOptions, &RunStress); }

}  // namespace sheaf
