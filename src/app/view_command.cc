#include "src/app/view_command.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>
#include <mutex>
#include <utility>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/choose_look.h"
#include "src/app/interrupt.h"
#include "src/app/open_scene.h"
#include "src/app/print_message.h"
#include "src/app/standard_output.h"
#include "src/core/build_info.h"
#include "src/formats/printable.h"
#include "src/view/keys.h"
#include "src/view/viewer.h"
#include "src/view/window.h"

namespace sheaf {
namespace {

struct ViewArguments {
  SceneOptions options;
  std::string scene;
  CameraChoice choice;
  std::optional<PixelSize> size;
  std::optional<int> samples, max_depth, threads;
  std::optional<double> contrast, min_throughput, rate, spin;
  std::string target = "auto";
  std::string precision = "strict";
  LookOptions look;
  std::string save;
  bool no_floor = false;
};

std::string KeysText() {
  std::string text = "\nIn the window:\n";
  for (const Motion& motion : Motions()) {
    text += fmt::format("  {:14}{}\n", motion.name, motion.help);
  }
  for (const Key& key : Keys()) text += fmt::format("  {:14}{}\n", key.name, key.help);
  return text;
}

void AddViewOptions(CLI::App& app, ViewArguments& request) {
  AddInput(app, "SCENE", request.scene, Presence::kNeeded, "The scene file or model");
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
  AddCameraChoice(app, request.choice);
  AddSize(app, request.size);
  AddInteger(app, "--spp", request.samples, 1, kMaxSamples,
             "Samples a pixel of a picture at rest; the scene's, or 16 adaptive ones");
  AddInteger(app, "--max-depth", request.max_depth, 0, kMaxDepth,
             "A ray deeper than this is black; primary rays have depth 0");
  AddShare(app, "--adaptive", request.contrast, "T",
           "All samples only where neighbours differ by more than T; else one");
  AddShare(app, "--min-throughput,--min-weight", request.min_throughput, "W",
           "Rays that add at most this part of what they see are not traced");
  AddName(app, "--target", request.target, "auto|scalar|NAME",
          "SIMD target; sheaf info lists the usable ones");
  AddPrecision(app, request.precision);
  AddLookOptions(app, request.look);
  AddThreads(app, request.threads, 0, "Threads; 0: one a core");
  AddFlag(app, "--no-floor", request.no_floor, "No floor under a model without lights");
  const auto parse = [](double least, double most) {
    return [least, most](const std::string& text) { return ParseNumber(text, least, most); };
  };
  AddParsed(app, "--rate", request.rate, "N", "a number 1 to 240",
            "Pictures a second in motion, which have as many pixels as allow it; 30 if absent",
            parse(1, 240));
  AddPath(app, "--save", request.save, "PREFIX",
          "Pictures and cameras are saved as PREFIX-1.png, PREFIX-1.json and so on; the scene's "
          "name in this folder if absent");
  AddParsed(app, "--spin", request.spin, "SECONDS", "a number 0.1 to 3600",
            "Turn about the scene for so long, print how many pictures came, and close",
            parse(0.1, 3600));
  AddFooter(app, KeysText());
}

// The module's function; it stays loaded, because drivers of OpenGL have threads of their own.
struct WindowModule {
  RunWindow* run;
};
Result<WindowModule> LoadWindow() {
  for (const OptionalPart& part : OptionalParts()) {
    if (std::string_view(part.name) == "window" && !part.is_built_in) {
      return Usage(
          "view: Sheaf was built without GLFW, OpenGL and Dear ImGui, which a window needs");
    }
  }
  void* const module = dlopen(kWindowModule, RTLD_NOW | RTLD_LOCAL);
  void* const found = module != nullptr ? dlsym(module, kRunWindow) : nullptr;
  if (found == nullptr) {
    return Usage(fmt::format("view: {} cannot be loaded: {}", kWindowModule, Printable(dlerror())));
  }
  return WindowModule{reinterpret_cast<RunWindow*>(found)};
}

// The scene as `sheaf render` would have it, and how its light is shown through `camera`.
Result<LoadedView> ViewOf(const ViewArguments& request, OpenedScene opened, const Camera& camera) {
  const RenderOptions frame = FrameOptions(opened.scene.settings, request.size, request.samples);
  const Result<Look> look = ChooseLook(request.look, Renderer(opened.scene), camera, frame);
  if (!look) return look.error();
  return LoadedView{std::move(opened.scene), std::move(opened.files), std::move(opened.warnings),
                    Development{look.value().ev, look.value().tone}};
}

// Reads it once more. The exposure is that of the first camera chosen, where it still exists.
Result<LoadedView> ReadAnew(const ViewArguments& request) {
  Result<OpenedScene> opened = OpenSceneWithWarnings(request.scene, request.options);
  if (!opened) return opened.error();
  const Status strict = CheckStrict(request.scene, opened.value().warnings, request.options);
  if (!strict) return strict.error();
  const Scene& scene = opened.value().scene;
  if (scene.cameras.empty()) return Error{ErrorKind::kScene, request.scene + ": no camera"};
  const auto cameras = ChooseCameras(request.choice, request.options, request.scene, scene);
  const Camera camera = cameras ? *cameras.value().front() : scene.cameras.front();
  return ViewOf(request, std::move(opened).value(), camera);
}

Result<ViewerSetup> SetupOf(const ViewArguments& request) {
  ViewerSetup setup;
  RenderOptions options;
  if (const Status chosen = ChooseTarget(request.target, options); !chosen) return chosen.error();
  setup.target = options.target;
  setup.precision = PrecisionOf(request.precision);
  if (setup.precision == Precision::kFast && setup.target.is_scalar()) {
    return Usage("--precision fast: needs a SIMD target, not --target scalar");
  }
  setup.scene_path = request.scene;
  setup.view = request.choice.view;
  setup.samples = request.samples;
  setup.max_depth = request.max_depth;
  setup.contrast = request.contrast;
  setup.min_throughput = request.min_throughput.value_or(0);
  setup.threads = request.threads.value_or(0);
  setup.frame_seconds = 1 / request.rate.value_or(30);
  setup.spin_seconds = request.spin.value_or(0);
  setup.save_prefix = request.save;
  if (request.save.empty())
    setup.save_prefix = std::filesystem::path(request.scene).stem().string();
  setup.print = [](const std::string& line) {
    // What a reader who is gone misses is in the window too.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    [[maybe_unused]] const Status written = WriteStandardOutput(line + "\n");
  };
  setup.is_interrupted = [] { return PendingSignal() != 0; };
  setup.load = [request] { return ReadAnew(request); };
  return setup;
}

Status RunView(const ViewArguments& given) {
  ViewArguments request = given;
  if (!request.no_floor) request.options.floor = Floor::kUnderLoneModels;
  if (request.size) {
    request.options.aspect = static_cast<double>(request.size->width) / request.size->height;
  }
  Result<ViewerSetup> setup = SetupOf(request);
  if (!setup) return setup.error();
  const Result<WindowModule> window = LoadWindow();
  if (!window) return window.error();
  Result<OpenedScene> opened = OpenSceneAndFiles(request.scene, request.options);
  if (!opened) return opened.error();
  const Scene& scene = opened.value().scene;
  const auto cameras = ChooseCameras(request.choice, request.options, request.scene, scene);
  if (!cameras) return cameras.error();
  const Camera camera = *cameras.value().front();
  setup.value().camera = static_cast<std::size_t>(cameras.value().front() - scene.cameras.data());
  const PixelSize size =
      request.size.value_or(PixelSize{scene.settings.width, scene.settings.height});
  Result<LoadedView> first = ViewOf(request, std::move(opened).value(), camera);
  if (!first) return first.error();

  CatchInterrupts();
  Viewer viewer(std::move(setup).value(), std::move(first).value());
  std::string error;
  if (!window.value().run(viewer, size.width, size.height, error)) {
    return Error{ErrorKind::kInputOutput, "view: no window: " + Printable(error)};
  }
  const std::string moved = viewer.motion().Text();
  if (!moved.empty()) {
    if (const Status written = WriteStandardOutput(moved + "\n"); !written) return written;
  }
  return CheckInterrupted();
}

}  // namespace

Command ViewCommand() { return MakeCommand(&AddViewOptions, &RunView); }

}  // namespace sheaf
