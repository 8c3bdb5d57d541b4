#include "src/app/frame_writer.h"

#include <fmt/format.h>

#include <variant>

#include "src/app/choose.h"
#include "src/scene/projection.h"

namespace sheaf {
namespace {

// What `sheaf merge` compares to see that parts belong to one picture. It names the camera's place,
// because the command line may have moved the camera.
std::string SettingsText(const RenderOptions& options, const Frame& frame) {
  const Camera& camera = *frame.camera;
  const Look look = frame.look.value_or(Look());
  const Vec3d& eye = camera.eye;
  const Vec3d& look_at = camera.look_at;
  const bool perspective = std::holds_alternative<Perspective>(camera.projection);
  const ProjectionKind& kind = KindOf(camera.projection);
  const char* const name = perspective                            ? "fov"
                           : kind.unit == ProjectionUnit::kLength ? kind.parameter
                                                                  : kind.name;
  return fmt::format(
      "{}x{} pixels, {} samples, depth {}, {} precision, min weight {:g}{}, "
      "eye {} {} {}, look at {} {} {}, {} {}{}{}{}{}",
      options.width, options.height, options.samples, options.max_depth,
      PrecisionName(options.precision), options.min_throughput,
      options.budget     ? fmt::format(", budget {:g} s", *options.budget)
      : options.error    ? fmt::format(", error {:g}", *options.error)
      : options.contrast ? fmt::format(", adaptive {:g}", *options.contrast)
                         : "",
      eye.x, eye.y, eye.z, look_at.x, look_at.y, look_at.z, name, ParameterOf(camera.projection),
      look.ev != 0 ? fmt::format(", {:.3g} stops", look.ev) : "",
      look.tone == Tone::kFilmic ? ", filmic" : "",
      options.integrator && *options.integrator != Integrator::kDistributed
          ? fmt::format(", {} integrator", IntegratorName(*options.integrator))
          : "",
      frame.is_denoised ? ", denoised" : "");
}

}  // namespace

Result<FrameWriter> FrameWriter::Create(const Scene& scene, const Frame& frame,
                                        const RenderOptions& options, std::optional<int> bits,
                                        const std::string& scene_path) {
  PictureSpec spec = WholePicture(options.width, options.height, scene.settings.transfer);
  if (options.crop) spec.window = *options.crop;
  spec.bits = bits.value_or(0);
  spec.metadata = {{"Scene", scene_path},
                   {"Camera", frame.camera->name},
                   {"Settings", SettingsText(options, frame)}};
  const Look shown = frame.look.value_or(Look());
  spec.ev = shown.ev;
  spec.tone = shown.tone;
  spec.format = frame.format;
  if (HoldsLayers(FormatPath(frame.path, frame.format))) spec.layers = options.layers;
  Result<PictureWriter> picture = PictureWriter::Create(frame.path, spec);
  if (!picture) return picture.error();
  FrameWriter writer(std::move(picture).value());
  for (const auto& [layer, path] : frame.beside) {
    if (layer == Layer::kDepth) writer.far_ = FarthestDepth(scene, *frame.camera);
    if (layer == Layer::kHeat) continue;  // known when all tiles are
    PictureSpec beside = spec;            // no format: such files go by their endings
    beside.ev = 0;
    beside.tone = Tone::kLinear;
    beside.metadata.back().second += fmt::format(", layer {}", LayerName(layer));
    if (layer != Layer::kAlbedo) beside.values = Values::kNumbers;
    Result<PictureWriter> created = PictureWriter::Create(path, beside);
    if (!created) return created.error();
    const LayerLook look = HoldsFloats(path) ? LayerLook::kNumbers : LayerLook::kDisplay;
    writer.beside_.push_back({layer, look, std::move(created).value()});
  }
  return writer;
}

Status FrameWriter::WriteRows(const Film& rows) {
  Status status = picture_.WriteRows(rows);
  for (Beside& beside : beside_) {
    if (status) {
      status = beside.writer.WriteRows(ShowLayer(rows, beside.layer, beside.look, far_));
    }
  }
  return status;
}

Status FrameWriter::Finish() {
  Status status = picture_.Finish();
  for (Beside& beside : beside_) {
    if (status) status = beside.writer.Finish();
  }
  return status;
}

}  // namespace sheaf
