#include "src/app/render_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <utility>
#include <variant>

#include "sheaf/scene.h"
#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/heat_picture.h"
#include "src/app/interrupt.h"
#include "src/app/layer_picture.h"
#include "src/app/progress.h"
#include "src/app/standard_output.h"
#include "src/app/statistics_json.h"
#include "src/core/atomic_file.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// One picture to make.
struct Frame {
  const Camera* camera;
  std::string path;
  std::vector<std::pair<Layer, std::string>> beside;  // layers in files of their own
};

// What is wrong without a look at the scene: the command line first, then the places to write to.
Status CheckRequest(const RenderRequest& request) {
  if (request.choice.cameras.size() > 1 && request.output.find(kCameraField) == std::string::npos) {
    return Usage(
        fmt::format("-o {}: several cameras need {} in the path", request.output, kCameraField));
  }
  if (const Status known = CheckPicturePath(request.output); !known) return known;
  if (request.bits) {
    if (const Status fits = CheckPictureBits(request.output, *request.bits); !fits) return fits;
  }
  if (request.crop && request.tile.parts > 0) {
    return Usage("--tile, --crop: a part of the picture is one or the other");
  }
  if (const auto chosen = ChooseTarget(request.target); !chosen) return chosen.error();

  // Where the field stands in the folder's name, PlanFrames checks each folder.
  const std::string folder = request.output.substr(0, request.output.rfind('/') + 1);
  if (folder.find(kCameraField) == std::string::npos) {
    if (const Status writable = CheckWritable(request.output); !writable) return writable;
  }
  if (!request.statistics.empty() && request.statistics != "-") {
    return CheckWritable(request.statistics);
  }
  return Done{};
}

std::vector<Output> OutputsOf(const RenderRequest& request, const std::vector<Frame>& frames) {
  std::vector<Output> outputs = {{"--json", request.statistics}};
  for (const Frame& frame : frames) {
    outputs.push_back({"-o", frame.path});
    for (const auto& [layer, path] : frame.beside) outputs.push_back({"--aov", path});
  }
  return outputs;
}

Result<std::vector<Frame>> PlanFrames(const RenderRequest& request, const Scene& scene) {
  const Result<std::vector<const Camera*>> cameras =
      ChooseCameras(request.choice, request.options, request.scene, scene);
  if (!cameras) return cameras.error();
  if (cameras.value().size() > 1 && request.output.find(kCameraField) == std::string::npos) {
    return Usage(fmt::format("-o {}: the view \"{}\" has {} cameras, which need {} in the path",
                             request.output, request.choice.view, cameras.value().size(),
                             kCameraField));
  }
  std::vector<Frame> frames;
  for (const Camera* camera : cameras.value()) {
    const Result<std::string> path = ExpandPath(request.output, camera->name);
    if (!path) return path.error();
    if (const Status writable = CheckWritable(path.value()); !writable) return writable.error();
    Frame frame{camera, path.value(), {}};
    for (int i = 0; i < kLayerCount && !HoldsLayers(path.value()); ++i) {
      const Layer layer = static_cast<Layer>(i);
      if (!request.layers.has(layer)) continue;
      frame.beside.emplace_back(layer, LayerPath(path.value(), layer));
      const Status writable = CheckWritable(frame.beside.back().second);
      if (!writable) return writable.error();
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

Result<RenderOptions> MergeOptions(const RenderRequest& request, const Settings& settings) {
  RenderOptions options = FrameOptions(settings, request.size, request.samples);
  options.max_depth = request.max_depth.value_or(settings.max_depth);
  options.contrast = request.contrast;
  options.min_throughput = request.min_throughput.value_or(0);
  options.crop = request.crop;
  if (const Status chosen = ChooseTarget(request.target, options); !chosen) return chosen.error();
  options.precision = PrecisionOf(request.precision);
  if (options.precision == Precision::kFast && options.target.is_scalar()) {
    return Usage("--precision fast: needs a SIMD target, not --target scalar");
  }
  options.threads = request.threads.value_or(options.threads);
  options.tile_size = request.tile.size.value_or(options.tile_size);
  options.layers = request.layers;
  options.tile_costs = request.layers.has(Layer::kHeat) ? TileCosts::kOn : TileCosts::kOff;
  if (const int part = request.tile.part, parts = request.tile.parts; parts > 0) {
    if (parts > options.height) {
      return Usage(
          fmt::format("--tile {}/{}: the picture has {} rows", part, parts, options.height));
    }
    // Rows as even as can be, whatever the number of parts.
    const auto row = [&](int i) {
      return static_cast<int>(static_cast<std::int64_t>(options.height) * i / parts);
    };
    options.crop = PixelRect{0, row(part - 1), options.width, row(part)};
  }
  options.timing = request.statistics.empty() ? Timing::kOff : Timing::kOn;
  if (options.crop && (options.crop->x1 > options.width || options.crop->y1 > options.height)) {
    return Usage(fmt::format("--crop: {},{},{},{} is not inside the picture of {}x{}",
                             options.crop->x0, options.crop->y0, options.crop->x1, options.crop->y1,
                             options.width, options.height));
  }
  return options;
}

ProgressStyle ChooseProgressStyle(const RenderRequest& request) {
  if (request.quiet || request.progress == "none") return ProgressStyle::kNone;
  return request.progress == "plain" ? ProgressStyle::kPlain : AutomaticProgressStyle();
}

PixelSize PictureSize(const RenderOptions& options) {
  if (options.crop) return {options.crop->width(), options.crop->height()};
  return {options.width, options.height};
}

std::uint64_t PixelCount(const PixelSize& size) {
  return static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
}

// With the camera's place: parts are of one picture where these texts are the same, and the command
// line may have moved it.
std::string SettingsText(const RenderOptions& options, const Camera& camera) {
  const Vec3d& eye = camera.eye;
  const Vec3d& look_at = camera.look_at;
  const auto* perspective = std::get_if<Perspective>(&camera.projection);
  const double view =
      perspective ? perspective->fov_y : std::get<Orthographic>(camera.projection).height;
  return fmt::format(
      "{}x{} pixels, {} samples, depth {}, {} precision, min weight {:g}{}, "
      "eye {} {} {}, look at {} {} {}, {} {}",
      options.width, options.height, options.samples, options.max_depth,
      PrecisionName(options.precision), options.min_throughput,
      options.contrast ? fmt::format(", adaptive {:g}", *options.contrast) : "", eye.x, eye.y,
      eye.z, look_at.x, look_at.y, look_at.z, perspective ? "fov" : "height", view);
}

// The picture of a frame, and its layers where they have files of their own.
class FrameWriter {
 public:
  static Result<FrameWriter> Create(const Scene& scene, const Frame& frame,
                                    const RenderOptions& options, std::optional<int> bits,
                                    const std::string& scene_path) {
    PictureSpec spec = WholePicture(options.width, options.height, scene.settings.transfer);
    if (options.crop) spec.window = *options.crop;
    spec.bits = bits.value_or(0);
    spec.metadata = {{"Scene", scene_path},
                     {"Camera", frame.camera->name},
                     {"Settings", SettingsText(options, *frame.camera)}};
    if (HoldsLayers(frame.path)) spec.layers = options.layers;
    Result<PictureWriter> picture = PictureWriter::Create(frame.path, spec);
    if (!picture) return picture.error();
    FrameWriter writer(std::move(picture).value());
    for (const auto& [layer, path] : frame.beside) {
      if (layer == Layer::kDepth) writer.far_ = FarthestDepth(scene, *frame.camera);
      if (layer == Layer::kHeat) continue;  // known when all tiles are
      PictureSpec beside = spec;
      beside.metadata.back().second += fmt::format(", layer {}", LayerName(layer));
      if (layer != Layer::kAlbedo) beside.transfer = Transfer::kLinear;
      Result<PictureWriter> created = PictureWriter::Create(path, beside);
      if (!created) return created.error();
      const LayerLook look = HoldsFloats(path) ? LayerLook::kNumbers : LayerLook::kDisplay;
      writer.beside_.push_back({layer, look, std::move(created).value()});
    }
    return writer;
  }

  Status WriteRows(const Film& rows) {
    Status status = picture_.WriteRows(rows);
    for (Beside& beside : beside_) {
      if (status) {
        status = beside.writer.WriteRows(ShowLayer(rows, beside.layer, beside.look, far_));
      }
    }
    return status;
  }

  Status Finish() {
    Status status = picture_.Finish();
    for (Beside& beside : beside_) {
      if (status) status = beside.writer.Finish();
    }
    return status;
  }

 private:
  struct Beside {
    Layer layer;
    LayerLook look;
    PictureWriter writer;
  };
  explicit FrameWriter(PictureWriter picture) : picture_(std::move(picture)) {}

  PictureWriter picture_;
  std::vector<Beside> beside_;
  double far_ = 1;  // where depth is shown: what it is black at
};

Result<FrameRecord> RenderFrame(const Scene& scene, const std::string& scene_path,
                                const Frame& frame, const RenderOptions& options,
                                std::optional<int> bits, ProgressStyle style, std::string label) {
  const PixelSize size = PictureSize(options);
  FrameRecord record{frame.camera->name, frame.path, options, {}};
  // Before the first ray: what cannot be written costs no rendering.
  Result<FrameWriter> writer = FrameWriter::Create(scene, frame, options, bits, scene_path);
  if (!writer) return writer.error();
  FrameWatch watch(style, std::move(label), options, PixelCount(size));
  const RowSink write = [&](const Film& rows) { return writer.value().WriteRows(rows); };
  const Status rendered =
      RenderRows(scene, *frame.camera, options, write, &record.stats, watch.progress());
  // A signal in the last tenth of a second may find the frame finished: it stops the command still.
  if (PendingSignal() != 0 || (!rendered && rendered.error().kind == ErrorKind::kInterrupted)) {
    return Error{ErrorKind::kInterrupted,
                 fmt::format("interrupted; {} was not written", frame.path)};
  }
  if (!rendered) return rendered.error();
  watch.Finish(record.stats);
  if (const Status written = writer.value().Finish(); !written) return written.error();
  for (const auto& [layer, path] : frame.beside) {
    if (layer != Layer::kHeat) continue;
    const Status written = WriteHeatPicture(options, record.stats, path);
    if (!written) return written.error();
  }
  return record;
}

Status WriteStatistics(const std::string& destination, const std::string& json) {
  if (destination.empty()) return Done{};
  return destination == "-" ? WriteStandardOutput(json) : WriteFileWhole(destination, json);
}

// "32" or "2/8".
std::optional<TileChoice> ParseTile(const std::string& text) {
  TileChoice tile;
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) {
    tile.size = ParseInteger(text, 1, kMaxTileSize);
    return tile.size ? std::optional(tile) : std::nullopt;
  }
  const auto parts = ParseInteger(text.substr(slash + 1), 1, kMaxImageSide);
  const auto part = ParseInteger(text.substr(0, slash), 1, parts.value_or(1));
  if (!parts || !part) return std::nullopt;
  tile.part = *part;
  tile.parts = *parts;
  return tile;
}

}  // namespace

CLI::App* AddRenderCommand(CLI::App& app, RenderRequest& request) {
  CLI::App* render = app.add_subcommand("render", "Render a scene into pictures");
  render->add_option("SCENE", request.scene, "The scene file")->required()->option_text(" ");
  AddSceneOptions(*render, request.options);
  AddCameraChoice(*render, request.choice);
  AddOutput(*render, request.output, "PATH",
            "The picture, .png, .pfm or .exr (needed); {camera} becomes the camera's name");
  AddSize(*render, request.size);
  AddInteger(*render, "--spp", request.samples, 1, kMaxSamples, "Samples a pixel");
  AddInteger(*render, "--max-depth", request.max_depth, 0, kMaxDepth,
             "A ray deeper than this is black; primary rays have depth 0");
  AddShare(*render, "--adaptive", request.contrast, "T",
           "All samples only where neighbours differ by more than T; else one");
  AddShare(*render, "--min-weight", request.min_throughput, "W",
           "Rays that add at most this part of what they see are not traced");
  AddParsed(*render, "--crop", request.crop, "x0,y0,x1,y1",
            "a rectangle like 0,0,320,240 with x0 < x1 and y0 < y1",
            "Render this part alone; x1 and y1 are exclusive", &ParseRect);
  render->add_option("--target", request.target, "SIMD target; sheaf info lists the usable ones")
      ->option_text("auto|scalar|NAME");
  AddPrecision(*render, request.precision);
  AddParsed(*render, "--aov", request.layers, "LAYER[,LAYER]",
            "a list of depth, normal, albedo, id, heat",
            "Layers: depth, normal, albedo, id, heat; in .exr, else in files beside the picture",
            &ParseLayers);
  AddBits(*render, request.bits);
  AddInteger(*render, "--threads", request.threads, 0, kMaxThreads, "Threads; 0: one a core");
  AddParsed(*render, "--tile", request.tile, "N|I/N",
            fmt::format("a size of 1 to {}, or a part like 2/8", kMaxTileSize),
            "Pixels a side of a tile, which change no picture but in fast precision; I/N: part I "
            "of N alone",
            &ParseTile);
  render->add_option("--progress", request.progress, "What stderr shows meanwhile")
      ->option_text("auto|plain|none")
      ->check(CLI::IsMember({"auto", "plain", "none"}));
  render->add_flag("-q,--quiet", request.quiet, "Only errors on stderr");
  AddJson(*render, request.statistics, "Statistics as JSON to stdout, or into FILE");
  return render;
}

Status RunRender(const RenderRequest& request) {
  // Whatever can be refused is refused before the work.
  if (const Status sound = CheckRequest(request); !sound) return sound;
  const ProgressStyle style = ChooseProgressStyle(request);
  const Result<OpenedScene> opened = [&] {
    const ReadingNotice notice(style, request.scene);
    return OpenSceneAndFiles(request.scene, request.options);
  }();
  if (!opened) return opened.error();
  const Scene& scene = opened.value().scene;
  const Result<RenderOptions> options = MergeOptions(request, scene.settings);
  if (!options) return options.error();
  const Result<std::vector<Frame>> frames = PlanFrames(request, scene);
  if (!frames) return frames.error();
  const Status apart = CheckOutputs(OutputsOf(request, frames.value()), opened.value().files);
  if (!apart) return apart;

  CatchInterrupts();
  const std::size_t count = frames.value().size();
  std::vector<FrameRecord> records;
  for (const Frame& frame : frames.value()) {
    std::string label = Printable(frame.camera->name);
    if (count > 1) label += fmt::format(" {}/{}", records.size() + 1, count);
    Result<FrameRecord> record =
        RenderFrame(scene, request.scene, frame, options.value(), request.bits, style, label);
    if (!record) return record.error();
    // Not fmt::print: it throws where stderr is gone, which is no reason to stop.
    std::vector<std::string> paths = {frame.path};
    for (const auto& [layer, path] : frame.beside) paths.push_back(path);
    for (const std::string& path : paths) {
      if (!request.quiet) std::fprintf(stderr, "wrote %s\n", path.c_str());
    }
    records.push_back(std::move(record).value());
  }
  return WriteStatistics(request.statistics, StatisticsJson(request.scene, records));
}

}  // namespace sheaf
