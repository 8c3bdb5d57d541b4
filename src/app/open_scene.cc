#include "src/app/open_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/parse_options.h"
#include "src/app/print_message.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/studio.h"
#include "src/scene/projection.h"

namespace sheaf {
namespace {

std::optional<Vec3d> ParsePoint(const std::string& text) {
  const std::vector<std::string> words = SplitAtCommas(text);
  if (words.size() != 3) return std::nullopt;
  Vec3d point;
  for (int i = 0; i < 3; ++i) {
    const auto number =
        ParseNumber(words[static_cast<std::size_t>(i)], -kMaxCoordinate, kMaxCoordinate);
    if (!number) return std::nullopt;
    point[i] = *number;
  }
  return point;
}

// The first camera as the command line wants it.
Status Aim(const SceneOptions& options, Scene* scene) {
  if (scene->cameras.empty()) return Done{};
  Camera& camera = scene->cameras.front();
  camera.eye = options.eye.value_or(camera.eye);
  camera.look_at = options.look_at.value_or(camera.look_at);
  camera.projection = options.projection.value_or(camera.projection);
  if (options.fov && KindOf(camera.projection).unit != ProjectionUnit::kDegrees) {
    return Usage(fmt::format("--fov: the scene's first camera, \"{}\", is {}",
                             Printable(camera.name), KindOf(camera.projection).name));
  }
  if (options.fov) SetParameter(camera.projection, *options.fov);
  const Vec3d ahead = camera.look_at - camera.eye;
  if (!(glm::length(ahead) > 0)) return Usage("--eye, --look-at: the camera looks at its own eye");
  if (glm::length(glm::cross(ahead, camera.up)) <=
      1e-6 * glm::length(ahead) * glm::length(camera.up)) {
    camera.up = std::abs(ahead.z) > std::abs(ahead.y) ? Vec3d(0, 1, 0) : Vec3d(0, 0, -1);
  }
  return Done{};
}

}  // namespace

void AddSceneOptions(CLI::App& app, SceneOptions& options) {
  AddParsed(app, "--eye", options.eye, "X,Y,Z", "a point like 1,2.5,-3",
            "Where the scene's first camera stands", &ParsePoint);
  AddParsed(app, "--look-at", options.look_at, "X,Y,Z", "a point like 1,2.5,-3",
            "What the scene's first camera looks at", &ParsePoint);
  AddParsed(app, "--projection", options.projection, "NAME",
            fmt::format("one of {}", fmt::join(ProjectionNames(), ", ")),
            "Its projection, such as orthographic", &ProjectionNamed);
  AddParsed(app, "--fov", options.fov, "DEGREES", "a number between 0 and 180",
            "Its full vertical angle", [](const std::string& text) {
              const auto fov = ParseNumber(text, 0, 180);
              return fov && *fov > 0 && *fov < 180 ? fov : std::nullopt;
            });
  AddInteger(app, "--cone-sides", options.cone_sides, 3, kMaxConeSides,
             "Sides of an NFF file's cones and cylinders; 32 if absent");
  AddFlag(app, "--allow-outside", options.allow_outside,
          "Let the scene name files outside its folder");
  AddFlag(app, "--strict", options.strict, "Take warnings about the scene for errors");
}

std::optional<std::string> GivenSceneOption(const SceneOptions& options) {
  if (options.eye) return "--eye";
  if (options.look_at) return "--look-at";
  if (options.projection) return "--projection";
  if (options.fov) return "--fov";
  if (options.cone_sides) return "--cone-sides";
  if (options.allow_outside) return "--allow-outside";
  if (options.strict) return "--strict";
  return std::nullopt;
}

Result<OpenedScene> OpenSceneWithWarnings(const std::string& path, const SceneOptions& options) {
  ReadOptions read;
  read.outside = options.allow_outside ? Outside::kAllowed : Outside::kRefused;
  read.cone_sides = options.cone_sides.value_or(read.cone_sides);
  read.aspect = options.aspect;
  Result<ReadSceneResult> result = ReadScene(path, read);
  if (!result) return result.error();
  OpenedScene opened{std::move(result.value().scene), std::move(result.value().warnings),
                     std::move(result.value().files)};
  if (const Status aimed = Aim(options, &opened.scene); !aimed) return aimed.error();
  if (result.value().key_light == KeyLight::kAdded) {
    AimStudio(&opened.scene);
    if (options.floor == Floor::kUnderLoneModels) AddGround(&opened.scene);
  }
  return opened;
}

Status CheckStrict(const std::string& path, const std::vector<std::string>& warnings,
                   const SceneOptions& options) {
  if (!options.strict || warnings.empty()) return Done{};
  return SceneError(path, fmt::format("{} warning{}, which --strict takes for errors",
                                      warnings.size(), warnings.size() == 1 ? "" : "s"));
}

Result<OpenedScene> OpenSceneAndFiles(const std::string& path, const SceneOptions& options,
                                      Verbosity verbosity) {
  Result<OpenedScene> opened = OpenSceneWithWarnings(path, options);
  if (!opened) return opened;
  const std::vector<std::string>& warnings = opened.value().warnings;
  for (const std::string& warning : warnings) {
    if (options.strict) {
      PrintMessage(warning);
    } else if (verbosity == Verbosity::kWarnings) {
      PrintMessage("sheaf: warning: " + warning);
    }
  }
  if (const Status strict = CheckStrict(path, warnings, options); !strict) return strict.error();
  return opened;
}

Result<Scene> OpenScene(const std::string& path, const SceneOptions& options, Verbosity verbosity) {
  Result<OpenedScene> opened = OpenSceneAndFiles(path, options, verbosity);
  if (!opened) return opened.error();
  return std::move(opened.value().scene);
}

Status CheckOutputs(const std::vector<Output>& outputs, const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const char* const option = outputs[i].option;
    const std::string& path = outputs[i].path;
    if (path.empty() || path == "-") continue;
    const auto is_same = [&](const std::string& other) { return IsSameFile(path, other); };
    if (std::any_of(inputs.begin(), inputs.end(), is_same)) {
      return Usage(fmt::format("{} {}: would replace a file that this run reads", option,
                               PrintablePath(path)));
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (!is_same(outputs[k].path)) continue;
      return Usage(fmt::format("{} {}: another output of this run has the same path", option,
                               PrintablePath(path)));
    }
  }
  return Done{};
}

}  // namespace sheaf
