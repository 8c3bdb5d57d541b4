#include "src/app/check_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/app/add_options.h"
#include "src/app/json_text.h"
#include "src/app/open_scene.h"
#include "src/app/scene_summary.h"
#include "src/app/standard_output.h"
#include "src/app/suspect_scene.h"
#include "src/formats/printable.h"
#include "src/lab/find_thin_walls.h"
#include "src/scene/placed_groups.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

struct CheckRequest {
  SceneOptions options;
  std::vector<std::string> scenes;
  bool json = false;
};

Json CheckJson(const std::string& path, const OpenedScene& opened) {
  const SceneSummary summary = Summarize(opened.scene);
  Json json = {{"path", path},
               {"objects", opened.scene.objects.size()},
               {"spheres", summary.spheres},
               {"triangles", summary.triangles},
               {"disks", summary.disks},
               {"lights", opened.scene.lights.size()},
               {"cameras", opened.scene.cameras.size()},
               {"groups", opened.scene.groups.size()},
               {"instances", CountPlacedGroups(opened.scene)},
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
  for (const std::string kind :
       {"objects", "spheres", "triangles", "disks", "lights", "cameras", "groups", "instances"}) {
    const bool is_usual = kind != "disks" && kind != "groups" && kind != "instances";
    if (!is_usual && json[kind] == 0) continue;
    counts.push_back(CountText(json, kind));
  }
  std::string text =
      fmt::format("{}: {}: {}\n", PrintablePath(json["path"].get<std::string>()),
                  json.contains("error") ? "not sound" : "sound", fmt::join(counts, ", "));
  const auto skipped = json["skipped"].get<std::vector<std::string>>();
  if (!skipped.empty()) text += fmt::format("  skipped: {}\n", fmt::join(skipped, ", "));
  for (const Json& warning : json["warnings"]) {
    text += fmt::format("  warning: {}\n", warning.get<std::string>());
  }
  return text;
}

// Where strict arithmetic cannot tell how thin glass is. No loss, so that --strict lets it pass.
void WarnOfThinWalls(const Scene& scene, Json& json) {
  constexpr std::size_t kMost = 3;
  const std::vector<ThinWall> walls = FindThinWalls(scene);
  for (std::size_t i = 0; i < walls.size() && i < kMost; ++i) {
    json["warnings"].push_back(
        fmt::format("objects[{}]: glass {:.2g} thin, where floats need {:.2g}; --precision double "
                    "needs less",
                    walls[i].object, walls[i].thickness, walls[i].needed));
  }
  if (walls.size() > kMost) {
    json["warnings"].push_back(fmt::format("{} more objects of thin glass", walls.size() - kMost));
  }
}

void AddCheckOptions(CLI::App& app, CheckRequest& request) {
  AddInputs(app, "SCENE", request.scenes, Presence::kNeeded, "Scenes or models");
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
  AddFlag(app, "--json", request.json, "The same as JSON");
}

// Reads every scene, also after a bad one, and prints the errors. The first of them is the code.
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
    Json json = CheckJson(path, opened.value());
    // What a picture would look like is no loss, so that --strict does not ask for it.
    for (const std::string& line : SuspectScene(opened.value().scene)) {
      json["warnings"].push_back(fmt::format("{}: {}", PrintablePath(path), line));
    }
    const Status strict = CheckStrict(path, opened.value().warnings, request.options);
    if (!strict) json["error"] = strict.error().message;
    WarnOfThinWalls(opened.value().scene, json);
    all.push_back(json);
    if (!request.json) {
      const Status written = WriteStandardOutput(CheckText(json));
      if (!written) return written.error();
    }
    if (strict) continue;
    const ExitCode bad = Report(strict.error());
    if (code == ExitCode::kOk) code = bad;
  }
  const Status written = request.json ? WriteStandardOutput(JsonText(all)) : Status(Done{});
  if (!written) return written.error();
  return code;
}

}  // namespace

Command CheckCommand() { return MakeCommand(&AddCheckOptions, &RunCheck); }

}  // namespace sheaf
