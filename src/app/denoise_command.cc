#include "src/app/denoise_command.h"

#include <fmt/format.h>

#include <utility>

#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/choose_look.h"
#include "src/app/display_picture.h"
#include "src/app/open_scene.h"
#include "src/app/output_path.h"
#include "src/app/picture_as_read.h"
#include "src/core/atomic_file.h"
#include "src/formats/format_table.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

struct DenoiseRequest {
  std::string input, output;
  std::string albedo, normal, depth;  // paths; empty: the input's own layer
  std::string format;                 // of --format; empty: by the path's ending
  std::optional<int> bits;
  std::string transfer;  // empty: keep
  LookOptions look;
  std::string target = "auto";
  std::optional<int> threads;
  std::string filter = "sheaf";
};

// An option that names the picture of a layer.
struct GuideOption {
  const char* name;
  Layer layer;
  const std::string& path;
};

std::vector<GuideOption> GuideOptions(const DenoiseRequest& request) {
  return {{"--albedo", Layer::kAlbedo, request.albedo},
          {"--normal", Layer::kNormal, request.normal},
          {"--depth", Layer::kDepth, request.depth}};
}

// A picture of bytes shows normals from [-1, 1] as 0 to 1, and albedo as any light.
Status ReadGuide(const GuideOption& option, const std::string& input, Film* film) {
  if (option.layer == Layer::kDepth && !HoldsFloats(option.path)) {
    return Usage(fmt::format("{} {}: distances need a picture of floats", option.name,
                             PrintablePath(option.path)));
  }
  Result<ReadPictureResult> read = ReadPicture(option.path);
  if (!read) return read.error();
  ReadPictureResult& guide = read.value();
  const Status same = CheckSameSize(option.path, guide.film, input, *film);
  if (!same) return same;
  const bool is_shifted = guide.is_display && option.layer == Layer::kNormal;
  if (!is_shifted) DecodeLight(guide);
  const auto index = static_cast<std::size_t>(option.layer);
  const auto channels = static_cast<std::size_t>(kLayerChannels[index]);
  Film::Floats& layer = film->layers[index];
  // A film of its own, or one with layers in it.
  if (guide.film.has(option.layer)) {
    layer = std::move(guide.film.layers[index]);
    return Done{};
  }
  layer.resize(channels * film->pixel_count());
  for (std::size_t i = 0; i < layer.size(); ++i) {
    const float number = guide.film.rgb[i / channels * 3 + i % channels];
    layer[i] = is_shifted ? 2 * number - 1 : number;
  }
  return Done{};
}

// A picture without any layer is mostly one whose layers were forgotten.
Status CheckGuided(const DenoiseRequest& request, const Film& film) {
  for (const GuideOption& option : GuideOptions(request)) {
    if (film.has(option.layer)) return Done{};
  }
  return Usage(fmt::format(
      "{}: has no layers to be guided by; --albedo, --normal and --depth name their pictures",
      PrintablePath(request.input)));
}

Status CheckFiles(const DenoiseRequest& request) {
  const Status wanted = CheckWritten(request.output, request.format, request.look, request.bits);
  if (!wanted) return wanted;
  std::vector<std::string> inputs = {request.input};
  for (const GuideOption& option : GuideOptions(request)) {
    if (!option.path.empty()) inputs.push_back(option.path);
  }
  const Status apart = CheckOutputs({{"-o", request.output}}, inputs);
  return apart ? CheckWritable(request.output) : apart;
}

void AddDenoiseOptions(CLI::App& app, DenoiseRequest& request) {
  AddInput(app, "INPUT", request.input, Presence::kNeeded, "The picture");
  AddOutput(app, request.output, "PATH",
            fmt::format("The picture without noise, {} (needed)", PictureEndings()));
  AddPath(app, "--albedo", request.albedo, "PATH",
          "The layer as --aov writes it, else INPUT's own");
  AddPath(app, "--normal", request.normal, "PATH", "Likewise");
  AddPath(app, "--depth", request.depth, "PATH", "Likewise; of floats");
  AddPictureFormat(app, request.format);
  AddBits(app, request.bits);
  AddTransfer(app, request.transfer);
  AddLookOptions(app, request.look);
  AddName(app, "--target", request.target, "auto|scalar|NAME",
          "SIMD target; sheaf info lists the usable ones");
  AddThreads(app, request.threads, 0, "Threads; 0: one a core");
  AddChoice(app, "--filter", request.filter, {"sheaf", "oidn"},
            "Sheaf's own, or Open Image Denoise where the build has it");
}

Status RunDenoise(const DenoiseRequest& given) {
  DenoiseRequest request = given;
  if (request.output == "-") request.output = kStandardOutputPath;
  const Result<Target> target = ChooseTarget(request.target);
  if (!target) return target.error();
  const Result<std::optional<DenoiseFilter>> filter = ChooseDenoiseFilter(request.filter);
  if (!filter) return filter.error();
  if (const Status sound = CheckFiles(request); !sound) return sound;
  Result<ReadPictureResult> read = ReadPicture(request.input);
  if (!read) return read.error();
  ReadPictureResult& picture = read.value();
  const std::string named = FormatPath(request.output, request.format);
  PictureSpec spec = SpecAsRead(picture, named, request.bits, request.transfer);
  spec.format = request.format;
  if (HoldsLayers(named)) spec.layers = picture.film.held_layers();
  for (const GuideOption& option : GuideOptions(request)) {
    if (option.path.empty()) continue;
    if (const Status added = ReadGuide(option, request.input, &picture.film); !added) return added;
  }
  if (const Status guided = CheckGuided(request, picture.film); !guided) return guided;
  DecodeLight(picture);
  const Result<Film> film =
      Denoise(picture.film, {target.value(), request.threads.value_or(0), *filter.value()});
  if (!film) return film.error();
  if (request.look.exposure) {
    spec.ev = request.look.exposure->ev.value_or(MeterExposure(film.value()));
  }
  spec.tone = ToneOf(request.look, Tone::kLinear);
  return WritePicture(film.value(), spec, request.output);
}

}  // namespace

Command DenoiseCommand() { return MakeCommand(&AddDenoiseOptions, &RunDenoise); }

}  // namespace sheaf
