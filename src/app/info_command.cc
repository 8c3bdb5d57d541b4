#include "src/app/info_command.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "sheaf/scene.h"
#include "sheaf/target.h"
#include "sheaf/version.h"
#include "src/app/add_options.h"
#include "src/app/json_text.h"
#include "src/app/machine.h"
#include "src/app/open_scene.h"
#include "src/app/scene_summary.h"
#include "src/app/standard_output.h"
#include "src/core/build_info.h"
#include "src/core/running_target.h"
#include "src/formats/printable.h"
#include "src/scene/placed_groups.h"
#include "src/scene/projection.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

struct InfoRequest {
  SceneOptions options;
  std::string scene;  // empty: none
  bool json = false;
};

Json VectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json PartsJson() {
  Json json = Json::object();
  for (const OptionalPart& part : OptionalParts()) json[part.name] = part.is_built_in;
  return json;
}

Json MachineJson() {
  std::vector<std::string> usable = UsableTargets();
  usable.push_back("scalar");
  return {
      {"sheaf",
       {{"version", kVersion}, {"compiler", CompilerName()}, {"build_type", BuildTypeName()}}},
      {"parts", PartsJson()},
      {"processor", {{"model", ProcessorModel()}, {"cores", std::thread::hardware_concurrency()}}},
      {"targets",
       {{"compiled", CompiledTargets()},
        {"usable", usable},
        {"chosen", RunningTarget(Target())},
        {"lanes", Target().lanes()}}},
  };
}

Json CameraJson(const Camera& camera) {
  Json json = {{"name", camera.name}};
  const ProjectionKind& kind = KindOf(camera.projection);
  json["projection"] = kind.name;
  if (kind.unit != ProjectionUnit::kNone) json[kind.parameter] = ParameterOf(camera.projection);
  json["eye"] = VectorJson(camera.eye);
  json["look_at"] = VectorJson(camera.look_at);
  return json;
}

Json SettingsJson(const Settings& settings) {
  return {{"width", settings.width},
          {"height", settings.height},
          {"samples", settings.samples},
          {"max_depth", settings.max_depth},
          {"background", VectorJson(settings.background)},
          {"ambient", VectorJson(settings.ambient.value_or(settings.background))},
          {"exposure", settings.exposure},
          {"transfer", settings.transfer == Transfer::kSrgb ? "srgb" : "linear"}};
}

Json SceneJson(const std::string& path, const Scene& scene) {
  const SceneSummary summary = Summarize(scene);
  Json json = {{"path", path},
               {"counts",
                {{"objects", scene.objects.size()},
                 {"spheres", summary.spheres},
                 {"triangles", summary.triangles},
                 {"disks", summary.disks},
                 {"materials", scene.materials.size()},
                 {"lights", scene.lights.size()},
                 {"cameras", scene.cameras.size()},
                 {"views", scene.views.size()},
                 {"groups", scene.groups.size()},
                 {"instances", CountPlacedGroups(scene)}}},
               {"bounds", nullptr},
               {"settings", SettingsJson(scene.settings)},
               {"cameras", Json::array()},
               {"views", Json::array()},
               {"features", Json::array()},
               {"skipped", Json::array()}};
  if (summary.bounds) {
    json["bounds"] = {{"min", VectorJson(summary.bounds->min)},
                      {"max", VectorJson(summary.bounds->max)}};
  }
  for (const Camera& camera : scene.cameras) json["cameras"].push_back(CameraJson(camera));
  for (const View& view : scene.views) {
    Json names = Json::array();
    for (const std::uint32_t index : view.cameras) names.push_back(scene.cameras[index].name);
    json["views"].push_back({{"name", view.name}, {"cameras", names}});
  }
  for (const Feature& feature : summary.features) {
    json[feature.present ? "features" : "skipped"].push_back(feature.name);
  }
  return json;
}

// The text is laid out from the JSON, so that the two cannot tell different stories.

std::string JoinNames(const Json& names, const char* separator) {
  if (names.empty()) return "none";
  return PrintablePath(
      fmt::format("{}", fmt::join(names.get<std::vector<std::string>>(), separator)));
}

std::string VectorText(const Json& v) {
  return fmt::format("({:g}, {:g}, {:g})", v[0].get<double>(), v[1].get<double>(),
                     v[2].get<double>());
}

std::string TextOf(const Json& value) {
  return value.is_string() ? PrintablePath(value.get<std::string>()) : value.dump();
}

enum class Held { kBuiltIn, kMissing };

// Names of the optional parts that are there, or of those that are not.
std::string PartsText(const Json& parts, Held which) {
  Json names = Json::array();
  for (const auto& [name, is_built_in] : parts.items()) {
    if (is_built_in.get<bool>() == (which == Held::kBuiltIn)) names.push_back(name);
  }
  return JoinNames(names, ", ");
}

std::string MachineText(const Json& machine) {
  const Json& sheaf = machine["sheaf"];
  const Json& processor = machine["processor"];
  const Json& targets = machine["targets"];
  return fmt::format(
      "sheaf {}\n"
      "compiler    {}, {}\n"
      "built in    {}\n"
      "missing     {}\n"
      "processor   {}, {} cores\n"
      "compiled    {}\n"
      "usable      {}\n"
      "chosen      {}, {} lanes of float\n",
      TextOf(sheaf["version"]), TextOf(sheaf["compiler"]), TextOf(sheaf["build_type"]),
      PartsText(machine["parts"], Held::kBuiltIn), PartsText(machine["parts"], Held::kMissing),
      TextOf(processor["model"]), TextOf(processor["cores"]), JoinNames(targets["compiled"], ", "),
      JoinNames(targets["usable"], ", "), TextOf(targets["chosen"]), TextOf(targets["lanes"]));
}

std::string ProjectionText(const Json& camera) {
  const std::string name = TextOf(camera["projection"]);
  const ProjectionKind& kind = KindOf(*ProjectionNamed(name));
  if (kind.unit == ProjectionUnit::kNone) return name;
  return fmt::format("{} {:g} {}", name, camera[kind.parameter].get<double>(),
                     kind.unit == ProjectionUnit::kDegrees ? "degrees" : "units");
}

std::string SceneText(const Json& scene) {
  std::string text = fmt::format("\nscene       {}\n", TextOf(scene["path"]));
  auto out = std::back_inserter(text);
  const char* separator = "counts      ";
  for (const auto& [name, count] : scene["counts"].items()) {
    fmt::format_to(out, "{}{} {}", separator, name, TextOf(count));
    separator = ", ";
  }
  const Json& bounds = scene["bounds"];
  fmt::format_to(out, "\nbounds      {}\n",
                 bounds.is_null() ? "none"
                                  : fmt::format("{} to {}", VectorText(bounds["min"]),
                                                VectorText(bounds["max"])));
  const Json& settings = scene["settings"];
  fmt::format_to(out,
                 "settings    {}x{}, {} spp, depth {}, background {}, ambient {}, exposure {:g}, "
                 "{}\n",
                 TextOf(settings["width"]), TextOf(settings["height"]), TextOf(settings["samples"]),
                 TextOf(settings["max_depth"]), VectorText(settings["background"]),
                 VectorText(settings["ambient"]), settings["exposure"].get<double>(),
                 TextOf(settings["transfer"]));
  for (const Json& camera : scene["cameras"]) {
    fmt::format_to(out, "camera      {}: {}, eye {}, look at {}\n", TextOf(camera["name"]),
                   ProjectionText(camera), VectorText(camera["eye"]),
                   VectorText(camera["look_at"]));
  }
  for (const Json& view : scene["views"]) {
    fmt::format_to(out, "view        {}: {}\n", TextOf(view["name"]),
                   JoinNames(view["cameras"], ", "));
  }
  fmt::format_to(out, "has         {}\n", JoinNames(scene["features"], ", "));
  fmt::format_to(out, "skipped     {}\n", JoinNames(scene["skipped"], ", "));
  return text;
}

void AddInfoOptions(CLI::App& app, InfoRequest& request) {
  AddInput(app, "SCENE", request.scene, Presence::kOptional, "A scene file to describe");
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
  AddFlag(app, "--json", request.json, "The same as JSON");
}

Status RunInfo(const InfoRequest& request) {
  Json json = MachineJson();
  if (!request.scene.empty()) {
    const Result<Scene> scene = OpenScene(request.scene, request.options);
    if (!scene) return scene.error();
    json["scene"] = SceneJson(request.scene, scene.value());
  }
  if (request.json) {
    return WriteStandardOutput(JsonText(json));
  }
  std::string text = MachineText(json);
  if (json.contains("scene")) text += SceneText(json["scene"]);
  return WriteStandardOutput(text);
}

}  // namespace

Command InfoCommand() { return MakeCommand(&AddInfoOptions, &RunInfo); }

}  // namespace sheaf
