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

struct Renderer::Impl {
  explicit Impl(const Scene& scene) : preparer(scene) {}
  ScenePreparer preparer;
};

Renderer::Renderer(const Scene& scene) : impl_(std::make_unique<Impl>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const Scene& Renderer::scene() const { return impl_->preparer.scene(); }

Result<Film> Renderer::Render(const Camera& camera, const RenderOptions& options,
                              RenderStats* stats, RenderProgress* progress) const {
  RenderOptions one_band = options;
  one_band.band_rows = kMaxImageSide;
  Film film;
  const BandSink keep = [&film](Film& band) {
    film = std::move(band);
    return Status(Done{});
  };
  const Status rendered =
      RenderFrame(impl_->preparer, camera, one_band, Skips::kOn, keep, stats, progress);
  if (!rendered) return rendered.error();
  return film;
}

Status Renderer::RenderRows(const Camera& camera, const RenderOptions& options, const RowSink& sink,
                            RenderStats* stats, RenderProgress* progress) const {
  return RenderFrame(impl_->preparer, camera, options, Skips::kOn, sink, stats, progress);
}

Result<Film> Render(const Scene& scene, const Camera& camera, const RenderOptions& options,
                    RenderStats* stats, RenderProgress* progress) {
  return Renderer(scene).Render(camera, options, stats, progress);
}

Status RenderRows(const Scene& scene, const Camera& camera, const RenderOptions& options,
                  const RowSink& sink, RenderStats* stats, RenderProgress* progress) {
  return Renderer(scene).RenderRows(camera, options, sink, stats, progress);
}

}  // namespace sheaf
