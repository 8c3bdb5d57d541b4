#include "src/app/render_request.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <limits>

#include "src/app/add_options.h"
#include "src/app/layer_picture.h"
#include "src/formats/format_table.h"

namespace sheaf {
namespace {

// "2/8".
std::optional<PicturePart> ParsePart(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto parts = ParseInteger(text.substr(slash + 1), 1, kMaxImageSide);
  const auto part = ParseInteger(text.substr(0, slash), 1, parts.value_or(1));
  if (!parts || !part) return std::nullopt;
  return PicturePart{*part, *parts};
}

// "0..47", or one frame alone.
std::optional<FrameRange> ParseFrames(const std::string& text) {
  constexpr int kLast = static_cast<int>(kMaxFrame);
  const std::size_t dots = text.find("..");
  const auto first = ParseInteger(text.substr(0, dots), -kLast, kLast);
  const auto last =
      dots == std::string::npos ? first : ParseInteger(text.substr(dots + 2), -kLast, kLast);
  if (!first || !last || *last < *first) return std::nullopt;
  return FrameRange{*first, *last};
}

// Too little for a ray is enough for the least picture that there is.
std::optional<double> ParseBudget(const std::string& text) {
  const auto seconds = ParseNumber(text, 0, std::numeric_limits<double>::max());
  return seconds && *seconds > 0 ? seconds : std::nullopt;
}

}  // namespace

void AddRenderOptions(CLI::App& app, RenderRequest& request) {
  AddInput(app, "SCENE", request.scene, Presence::kNeeded, "The scene file");
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
  AddCameraChoice(app, request.choice);
  AddParsed(app, "--frames", request.frames, "A..B", "a range of frames like 0..47",
            "Render these frames of an animation", &ParseFrames);
  AddInteger(app, "--turntable", request.turntable, 1, 1000000,
             "Turn the cameras about the scene, once in N frames");
  const std::string picture = fmt::format(
      "The picture, {} (needed); {{camera}} becomes the camera's name, {{frame}} or {{frame:4}} "
      "the frame's number",
      PictureEndings());
  AddOutput(app, request.output, "PATH", picture.c_str());
  AddPictureFormat(app, request.format);
  AddSize(app, request.size);
  AddInteger(app, "--spp", request.samples, 1, kMaxSamples, "Samples a pixel");
  std::vector<std::string> integrators;
  for (const Integrator integrator : kIntegrators) {
    integrators.push_back(IntegratorName(integrator));
  }
  AddChoice(app, "--integrator", request.integrator, integrators, "How light is followed");
  AddInteger(app, "--max-depth", request.max_depth, 0, kMaxDepth,
             "A ray deeper than this is black; primary rays have depth 0");
  AddShare(app, "--adaptive", request.contrast, "T",
           "All samples only where neighbours differ by more than T; else one");
  AddShare(app, "--error", request.error, "E",
           "Samples until the error of a pixel is at most E; --spp N: N at most");
  AddParsed(app, "--budget", request.budget, "SECONDS", "a number above 0",
            "Samples where the error is largest, for so long a picture", &ParseBudget);
  AddShare(app, "--min-throughput,--min-weight", request.min_throughput, "W",
           "Rays that add at most this part of what they see are not traced");
  AddParsed(app, "--crop", request.crop, "x0,y0,x1,y1",
            "a rectangle like 0,0,320,240 with x0 < x1 and y0 < y1",
            "Render this part alone; x1 and y1 are exclusive", &ParseRect);
  AddName(app, "--target", request.target, "auto|scalar|NAME",
          "SIMD target; sheaf info lists the usable ones");
  AddPrecision(app, request.precision);
  const std::string layers = fmt::format(
      "Layers: depth, normal, albedo, id, heat; in {}, else in files beside the picture",
      EndingsText([](const FileFormat& format) { return format.holds_layers; }));
  AddParsed(app, "--aov", request.layers, "LAYER[,LAYER]",
            "a list of depth, normal, albedo, id, heat", layers.c_str(), &ParseLayers);
  AddDenoiseFilter(app, "--denoise", request.denoise,
                   "Filter the noise of random samples, guided by albedo, normals and depth");
  AddBits(app, request.bits);
  AddLookOptions(app, request.look);
  AddThreads(app, request.threads, 0, "Threads; 0: one a core");
  AddParsed(app, "--tile", request.part, "I/N",
            "a part like 2/8 (--tile-size is for pixels a side)", "Render part I of N alone",
            &ParsePart);
  AddInteger(app, "--tile-size", request.tile_size, 1, kMaxTileSize,
             "Pixels a side of a thread's tile, which change no picture but in fast precision");
  AddFlag(app, "--resume", request.resume,
          "Keep a journal of what is done, and go on where an earlier run ended");
  AddChoice(app, "--progress", request.progress, {"auto", "plain", "none"},
            "What stderr shows meanwhile");
  AddFlag(app, "--no-floor", request.no_floor, "No floor under a model without lights");
  AddFlag(app, "-q,--quiet", request.quiet, "Only errors on stderr");
  AddJson(app, request.statistics, "Statistics as JSON to stdout, or into FILE");
  // Each frame of a sequence is the same whatever others there are.
  app.parse_complete_callback([&app, &request] {
    request.identity =
        GivenText(app, {"--frames", "--resume", "--threads", "--progress", "--quiet", "--json"});
    request.work = GivenText(
        app, {"--resume", "--threads", "--progress", "--quiet", "--json", "--target", "--output"});
  });
}

}  // namespace sheaf
