#include "src/app/open_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
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
#include "src/scene/transform.h"

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

// Around the middle of the scene, counter-clockwise seen from above: about that axis of the scene
// which is nearest to a camera's up, because that of a model's camera is tilted as the camera is.
void TurnCameras(const Bounds& bounds, double degrees, Scene* scene) {
  if (degrees == 0) return;  // to the bit where they were
  const Vec3d middle = (bounds.min + bounds.max) * 0.5;
  for (Camera& camera : scene->cameras) {
    int nearest = 1;
    for (const int axis : {0, 2}) {
      if (std::abs(camera.up[axis]) > std::abs(camera.up[nearest])) nearest = axis;
    }
    Vec3d above(0.0);
    above[nearest] = camera.up[nearest] < 0 ? -1 : 1;
    const Transform turn = RotationAbout(above, degrees);
    camera.eye = middle + turn.Vector(camera.eye - middle);
    camera.look_at = middle + turn.Vector(camera.look_at - middle);
    camera.up = turn.Vector(camera.up);
  }
}

ReadOptions ReadOptionsOf(const SceneOptions& options) {
  ReadOptions read;
  read.outside = options.allow_outside ? Outside::kAllowed : Outside::kRefused;
  read.cone_sides = options.cone_sides.value_or(read.cone_sides);
  read.aspect = options.aspect;
  read.animation = options.animation;
  return read;
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

void AddMomentOptions(CLI::App& app, SceneOptions& options) {
  AddParsed(app, "--time", options.time, "SECONDS", "a number -1e6 to 1e6",
            "The moment of animations and of cameras on paths",
            [](const std::string& text) { return ParseNumber(text, -1e6, 1e6); });
  AddParsed(app, "--fps", options.fps, "N", "a number 0.001 to 1000",
            "Frames a second of animations; 24 if absent",
            [](const std::string& text) { return ParseNumber(text, 0.001, 1000); });
  AddName(app, "--animation", options.animation, "NAME",
          "The one animation that counts; all of them if absent");
}

std::optional<std::string> GivenSceneOption(const SceneOptions& options) {
  if (options.eye) return "--eye";
  if (options.look_at) return "--look-at";
  if (options.projection) return "--projection";
  if (options.fov) return "--fov";
  if (options.cone_sides) return "--cone-sides";
  if (options.time) return "--time";
  if (options.fps != SceneOptions().fps) return "--fps";
  if (!options.animation.empty()) return "--animation";
  if (options.allow_outside) return "--allow-outside";
  if (options.strict) return "--strict";
  return std::nullopt;
}

Result<OpenedScene> OpenSceneWithWarnings(const std::string& path, const SceneOptions& options) {
  DecodedImages images;
  Result<ReadSceneResult> result = ReadScene(path, ReadOptionsOf(options), images);
  if (!result) return result.error();
  ReadSceneResult& read = result.value();
  OpenedScene opened{std::move(read.scene), std::move(read.warnings),
                     std::move(read.files), read.duration,
                     read.key_light,        {},
                     std::nullopt,          std::nullopt,
                     std::move(images)};
  Scene& scene = opened.scene;
  opened.cameras = scene.cameras;
  if (options.frame) opened.bounds = BoundsOf(scene);
  const std::size_t objects = scene.objects.size();
  if (opened.key_light == KeyLight::kAdded && options.floor == Floor::kUnderLoneModels) {
    AddGround(&scene);
  }
  if (scene.objects.size() > objects) {
    opened.ground = Ground{scene.objects.back(), scene.materials.back()};
  }
  if (const Status posed = PoseScene(path, options, &opened); !posed) return posed.error();
  return opened;
}

Status PoseScene(const std::string& path, const SceneOptions& options, OpenedScene* opened) {
  Scene& scene = opened->scene;
  std::optional<double> time = options.time;
  if (options.frame) time = *options.frame / options.fps;
  if (time && opened->duration > 0) {
    ReadOptions at_time = ReadOptionsOf(options);
    at_time.time = time;
    if (!opened->cameras.empty()) at_time.camera = opened->cameras.front();
    Result<ReadSceneResult> result = ReadScene(path, at_time, opened->images);
    if (!result) return result.error();
    scene = std::move(result.value().scene);
    if (const auto& ground = opened->ground) {
      scene.objects.push_back(ground->disk);
      scene.objects.back().material = static_cast<std::uint32_t>(scene.materials.size());
      scene.materials.push_back(ground->material);
    }
    opened->warnings = std::move(result.value().warnings);
  } else {
    scene.cameras = opened->cameras;
  }
  if (time) {
    const double frame = options.frame.value_or(*time * options.fps);
    for (Camera& camera : scene.cameras) camera = CameraAt(camera, frame);
  }
  if (const Status aimed = Aim(options, &scene); !aimed) return aimed.error();
  if (opened->bounds) TurnCameras(*opened->bounds, options.turn, &scene);
  if (opened->key_light == KeyLight::kAdded) AimStudio(&scene);
  return Done{};
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
  std::set<std::string> read, written;
  for (const std::string& input : inputs) read.merge(FileKeys(input));
  const auto meets = [](const std::set<std::string>& keys, const std::set<std::string>& others) {
    return std::any_of(keys.begin(), keys.end(),
                       [&](const std::string& key) { return others.contains(key); });
  };
  for (const auto& [option, path] : outputs) {
    if (path.empty() || path == "-") continue;
    std::set<std::string> keys = FileKeys(path);
    if (meets(keys, read)) {
      return Usage(fmt::format("{} {}: would replace a file that this run reads", option,
                               PrintablePath(path)));
    }
    if (meets(keys, written)) {
      return Usage(fmt::format("{} {}: another output of this run has the same path", option,
                               PrintablePath(path)));
    }
    written.merge(keys);
  }
  return Done{};
}

}  // namespace sheaf
