#include "src/app/check_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "src/app/exit_code.h"
#include "src/app/json_text.h"
#include "src/app/scene_summary.h"
#include "src/app/standard_output.h"

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

std::string CheckText(const Json& json) {
  std::string text =
      fmt::format("{}: sound: {} objects, {} spheres, {} triangles, {} lights, {} cameras\n",
                  json["path"].get<std::string>(), json["objects"].dump(), json["spheres"].dump(),
                  json["triangles"].dump(), json["lights"].dump(), json["cameras"].dump());
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

Status RunCheck(const CheckRequest& request) {
  Json all = Json::array();
  std::optional<Error> first;
  for (const std::string& path : request.scenes) {
    const Result<OpenedScene> opened = OpenSceneWithWarnings(path, request.options);
    if (!opened) {
      if (first) Report(opened.error());
      if (!first) first = opened.error();
      continue;
    }
    const Json json = CheckJson(path, opened.value());
    all.push_back(json);
    if (request.json) continue;
    if (const Status written = WriteStandardOutput(CheckText(json)); !written) return written;
  }
  if (request.json && !first) return WriteStandardOutput(JsonText(all));
  return first ? Status(*first) : Status(Done{});
}

}  // namespace sheaf
