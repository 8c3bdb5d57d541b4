#include "src/app/choose.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "src/app/open_scene.h"
#include "src/core/build_info.h"
#include "src/formats/printable.h"
#include "src/formats/suggest_name.h"

namespace sheaf {
namespace {

template <typename T>
std::vector<std::string> NamesOf(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) names.push_back(item.name);
  return names;
}

template <typename T>
const T* FindByName(const std::vector<T>& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const T& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

// E.g. `--camera: unknown camera "frnt"; did you mean "front"? (the scene has: front, up, down)`.
Error UnknownName(std::string_view option, std::string_view kind, const std::string& name,
                  std::string_view title, const std::vector<std::string>& choices) {
  const std::string list = fmt::format("{}", fmt::join(choices, ", "));
  return Usage(fmt::format("{}: unknown {} \"{}\"{} ({}: {})", option, kind, Printable(name),
                           DidYouMean(name, {choices.begin(), choices.end()}), title,
                           choices.empty() ? "none" : Printable(list)));
}

// Names that others give to what has another one here.
struct OtherName {
  std::string_view name, target, meaning;
};
constexpr OtherName kOtherNames[] = {
    {"avx512", "avx3", "AVX-512"},   {"avx-512", "avx3", "AVX-512"}, {"avx512f", "avx3", "AVX-512"},
    {"avx512bw", "avx3", "AVX-512"}, {"skx", "avx3", "AVX-512"},     {"sse4.1", "sse4", "SSE4.1"},
    {"sse4.2", "sse4", "SSE4.1"},    {"sse41", "sse4", "SSE4.1"},    {"sse42", "sse4", "SSE4.1"},
};

// Why `target` does not run, with `choices` of the option before the usable ones.
Error UnusableTarget(std::string_view option, const std::string& target,
                     std::vector<std::string> choices) {
  for (std::string& usable : UsableTargets()) choices.push_back(std::move(usable));
  const auto has = [](const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const std::vector<std::string> compiled = CompiledTargets();
  if (has(compiled, target)) {
    return Usage(fmt::format("{}: this processor does not run \"{}\" (usable: {})", option, target,
                             fmt::join(choices, ", ")));
  }
  std::string lower = target;
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  for (const OtherName& other : kOtherNames) {
    if (lower != other.name || !has(compiled, other.target)) continue;
    return Usage(
        fmt::format("{}: unknown target \"{}\"; {} is called \"{}\" here{} (usable: {})", option,
                    Printable(target), other.meaning, other.target,
                    has(choices, other.target) ? "" : ", and this processor does not run it",
                    fmt::join(choices, ", ")));
  }
  return UnknownName(option, "target", target, "usable", choices);
}

}  // namespace

Error Usage(std::string message) { return {ErrorKind::kUsage, std::move(message)}; }

std::set<std::string> FileKeys(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::set<std::string> keys;
  struct stat status;
  if (stat(path.c_str(), &status) == 0) {
    keys.insert(fmt::format("{}:{}", status.st_dev, status.st_ino));
  }
  const fs::path full = fs::weakly_canonical(fs::absolute(path, error), error);
  if (!full.empty()) keys.insert(full.string());
  return keys;
}

bool IsSameFile(const std::string& a, const std::string& b) {
  const std::set<std::string> keys = FileKeys(a), others = FileKeys(b);
  return std::any_of(keys.begin(), keys.end(),
                     [&](const std::string& key) { return others.contains(key); });
}

std::optional<std::vector<std::string>> ParseNames(const std::string& text) {
  std::vector<std::string> names = SplitAtCommas(text);
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  const bool repeated = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
  if (repeated || sorted.front().empty()) return std::nullopt;
  return names;
}

Result<Target> ChooseTarget(const std::string& target) {
  if (const std::optional<Target> named = Target::Named(target)) return *named;
  return UnusableTarget("--target", target, {"auto", "scalar"});
}

Status ChooseTarget(const std::string& target, RenderOptions& options) {
  const Result<Target> chosen = ChooseTarget(target);
  if (!chosen) return chosen.error();
  options.target = chosen.value();
  return Done{};
}

Precision PrecisionOf(const std::string& name) {
  for (const Precision precision : kPrecisions) {
    if (name == PrecisionName(precision)) return precision;
  }
  return Precision::kStrict;
}

Result<std::optional<DenoiseFilter>> ChooseDenoiseFilter(const std::string& name) {
  if (name.empty()) return std::optional<DenoiseFilter>();
  if (name != "oidn") return std::optional(DenoiseFilter::kSheaf);
  for (const OptionalPart& part : OptionalParts()) {
    if (part.name == std::string_view(kOidnPart) && part.is_built_in)
      return std::optional(DenoiseFilter::kOidn);
  }
  return Usage("oidn: this build has no Open Image Denoise");
}

RenderOptions FrameOptions(const Settings& settings, const std::optional<PixelSize>& size,
                           const std::optional<int>& samples) {
  RenderOptions options;
  options.width = size ? size->width : settings.width;
  options.height = size ? size->height : settings.height;
  options.samples = samples.value_or(settings.samples);
  options.max_depth = settings.max_depth;
  return options;
}

RenderOptions SmallPicture(const RenderOptions& options, int side) {
  RenderOptions small = options;
  const int longer = std::max({options.width, options.height, side});
  small.width = std::max(1, options.width * side / longer);
  small.height = std::max(1, options.height * side / longer);
  small.crop.reset();
  small.samples = 1;
  small.contrast.reset();
  small.error.reset();
  small.budget.reset();
  small.timing = Timing::kOff;
  small.layers = {};
  return small;
}

Result<std::vector<std::string>> ExpandTargets(const std::vector<std::string>& names) {
  const std::vector<std::string> usable = UsableTargets();
  std::vector<std::string> every = {"scalar"};
  every.insert(every.end(), usable.begin(), usable.end());
  std::vector<std::string> targets;
  for (const std::string& name : names) {
    const std::vector<std::string> meant = name == "all"    ? every
                                           : name == "auto" ? std::vector{usable.front()}
                                                            : std::vector{name};
    for (const std::string& target : meant) {
      if (std::find(every.begin(), every.end(), target) == every.end()) {
        return UnusableTarget("--targets", target, {"all", "auto", "scalar"});
      }
      if (std::find(targets.begin(), targets.end(), target) != targets.end()) {
        return Usage(fmt::format(
            "--targets: \"{}\" is there twice, counting what all and auto mean", target));
      }
      targets.push_back(target);
    }
  }
  return targets;
}

Result<std::vector<const Camera*>> ChooseCameras(const CameraChoice& choice,
                                                 const SceneOptions& options,
                                                 const std::string& path, const Scene& scene) {
  std::vector<const Camera*> cameras;
  if (!choice.view.empty()) {
    const View* view = FindByName(scene.views, choice.view);
    if (view == nullptr) {
      return UnknownName("--views", "view", choice.view, "the scene has", NamesOf(scene.views));
    }
    for (const std::uint32_t index : view->cameras) cameras.push_back(&scene.cameras[index]);
  }
  for (const std::string& name : choice.cameras) {
    const Camera* camera = FindByName(scene.cameras, name);
    if (camera == nullptr) {
      return UnknownName("--camera", "camera", name, "the scene has", NamesOf(scene.cameras));
    }
    cameras.push_back(camera);
  }
  if (cameras.empty()) {
    if (scene.cameras.empty()) {
      return Error{ErrorKind::kScene, fmt::format("{}: the scene has no camera", path)};
    }
    cameras.push_back(&scene.cameras.front());
  }
  const char* const aim = options.eye          ? "--eye"
                          : options.look_at    ? "--look-at"
                          : options.projection ? "--projection"
                          : options.fov        ? "--fov"
                                               : nullptr;
  const Camera& first = scene.cameras.front();
  if (aim != nullptr && std::find(cameras.begin(), cameras.end(), &first) == cameras.end()) {
    return Usage(fmt::format("{}: moves the scene's first camera, \"{}\", which is not chosen", aim,
                             Printable(first.name)));
  }
  return cameras;
}

std::string FormatPath(const std::string& path, const std::string& format) {
  return format.empty() ? path : "." + format;
}

}  // namespace sheaf
