#include "sheaf/render.h"

#include <utility>

#include "src/render/render_frame.h"

namespace sheaf {

const char* PrecisionName(Precision precision) {
  static constexpr const char* kNames[] = {"strict", "fast", "double"};
  return kNames[static_cast<int>(precision)];
}

const char* PhaseName(Phase phase) {
  static constexpr const char* kNames[] = {"generate", "trace",  "bin",   "surface",
                                           "shade",    "shadow", "spawn", "accumulate"};
  return kNames[static_cast<int>(phase)];
}

Result<Film> Render(const Scene& scene, const Camera& camera, const RenderOptions& options,
                    RenderStats* stats, RenderProgress* progress) {
  RenderOptions one_band = options;
  one_band.band_rows = kMaxImageSide;
  Film film;
  const BandSink keep = [&film](Film& band) {
    film = std::move(band);
    return Status(Done{});
  };
  const Status rendered = RenderFrame(scene, camera, one_band, Skips::kOn, keep, stats, progress);
  if (!rendered) return rendered.error();
  return film;
}

Status RenderRows(const Scene& scene, const Camera& camera, const RenderOptions& options,
                  const RowSink& sink, RenderStats* stats, RenderProgress* progress) {
  return RenderFrame(scene, camera, options, Skips::kOn, sink, stats, progress);
}

}  // namespace sheaf
