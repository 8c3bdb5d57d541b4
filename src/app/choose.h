// What a word on the command line names: targets, cameras, views.
#ifndef SHEAF_APP_CHOOSE_H_
#define SHEAF_APP_CHOOSE_H_

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/parse_options.h"

namespace sheaf {

Error Usage(std::string message);  // of kind kUsage

// What tells a file from others: its place with all links followed, and its inode where it exists.
std::set<std::string> FileKeys(const std::string& path);

// Whether two paths name one file, there already or not.
bool IsSameFile(const std::string& a, const std::string& b);

// Names between commas, without a blank or a double among them.
std::optional<std::vector<std::string>> ParseNames(const std::string& text);

// The target that --target names; kUsage where this processor does not run it.
Result<Target> ChooseTarget(const std::string& target);

// The same, into a frame's options.
Status ChooseTarget(const std::string& target, RenderOptions& options);

// "strict", "fast" or "double".
Precision PrecisionOf(const std::string& name);

// "sheaf" or "oidn"; nothing for an empty name. kUsage where the build lacks it.
Result<std::optional<DenoiseFilter>> ChooseDenoiseFilter(const std::string& name);

// A scene's settings, and what the command line says instead.
RenderOptions FrameOptions(const Settings& settings, const std::optional<PixelSize>& size,
                           const std::optional<int>& samples);

// The options for a picture of the same proportions, at most `side` pixels each way, with one
// sample a pixel.
RenderOptions SmallPicture(const RenderOptions& options, int side);

// The targets that words of --targets name, where "all" stands for scalar and every usable one,
// "auto" for the best. kUsage where one does not run here, or is there twice.
Result<std::vector<std::string>> ExpandTargets(const std::vector<std::string>& names);

struct SceneOptions;

// Which cameras of a scene to use.
struct CameraChoice {
  std::vector<std::string> cameras;  // empty: the view's, or the scene's first
  std::string view;                  // empty: none
};

// `path` is the scene's, for messages. At least one camera. kUsage where `options` aim the scene's
// first camera and it is not among them.
Result<std::vector<const Camera*>> ChooseCameras(const CameraChoice& choice,
                                                 const SceneOptions& options,
                                                 const std::string& path, const Scene& scene);

// What tells the format of an output: its path, or what --format says in its stead.
std::string FormatPath(const std::string& path, const std::string& format);

}  // namespace sheaf

#endif  // SHEAF_APP_CHOOSE_H_
