#include "src/app/check_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "src/app/json_text.h"
#include "src/app/scene_summary.h"
#include "src/app/standard_output.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

Json CheckJson(const std::string& path, const OpenedScene& opened) {
  const SceneSummary summary = Summarize(opened.scene);
  Json json = {{"path", path},
               {"objects", opened.scene.objects.size()},
               {"spheres", summary.spheres},
               {"triangles", summary.triangles},
               {"lights", opened.scene.lights.size()},
               {"cameras", opened.scene.cameras.size()},
               {"skipped", Json::array()},
               {"warnings", opened.warnings}};
  for (const Feature& feature : summary.features) {
    if (!feature.present) json["skipped"].push_back(feature.name);
  }
  return json;
}

// E.g. "1 light" or "3 lights".
std::string CountText(const Json& json, const std::string& kind) {
  const auto count = json[kind].get<std::size_t>();
  return fmt::format("{} {}", count, kind.substr(0, kind.size() - (count == 1 ? 1 : 0)));
}

std::string CheckText(const Json& json) {
  std::vector<std::string> counts;
  for (const char* kind : {"objects", "spheres", "triangles", "lights", "cameras"}) {
    counts.push_back(CountText(json, kind));
  }
  std::string text = fmt::format("{}: sound: {}\n", PrintablePath(json["path"].get<std::string>()),
                                 fmt::join(counts, ", "));
  const auto skipped = json["skipped"].get<std::vector<std::string>>();
  if (!skipped.empty()) text += fmt::format("  skipped: {}\n", fmt::join(skipped, ", "));
  for (const Json& warning : json["warnings"]) {
    text += fmt::format("  warning: {}\n", warning.get<std::string>());
  }
  return text;
}

}  // namespace

CLI::App* AddCheckCommand(CLI::App& app, CheckRequest& request) {
  CLI::App* check =
      app.add_subcommand("check", "Validate scenes and say what rendering them would skip");
  check->add_option("SCENE", request.scenes, "Scenes or models")->required()->option_text("...");
  AddSceneOptions(*check, request.options);
  check->add_flag("--json", request.json, "The same as JSON");
  return check;
}

Result<ExitCode> RunCheck(const CheckRequest& request) {
  Json all = Json::array();
  ExitCode code = ExitCode::kOk;
  for (const std::string& path : request.scenes) {
    const Result<OpenedScene> opened = OpenSceneWithWarnings(path, request.options);
    if (!opened) {
      const ExitCode bad = Report(opened.error());
      if (code == ExitCode::kOk) code = bad;
      all.push_back({{"path", path}, {"error", opened.error().message}});
      continue;
    }
    const Json json = CheckJson(path, opened.value());
    all.push_back(json);
    if (request.json) continue;
    const Status written = WriteStandardOutput(CheckText(json));
    if (!written) return written.error();
  }
  const Status written = request.json ? WriteStandardOutput(JsonText(all)) : Status(Done{});
  if (!written) return written.error();
  return code;
}

}  // namespace sheaf
