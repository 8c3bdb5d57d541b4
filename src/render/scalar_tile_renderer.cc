#include "src/render/scalar_tile_renderer.h"

#include "src/render/store_layers.h"
#include "src/scalar/render_adaptively.h"
#include "src/stream/first_hit.h"

namespace sheaf {

template <typename Real>
void ScalarTileRenderer<Real>::Render(const PixelRect& tile, int film_x, int film_y, Film& film) {
  const auto write = [&](int x, int y, const Vec3<Real>& colour, const FirstHit<Real>& first) {
    Write(x - film_x, y - film_y, colour, first, film);
  };
  if (frame_.is_adaptive()) {
    scalar::RenderAdaptively(frame_, tile, scratch_, rays_, stop_, write);
    return;
  }
  const bool has_layers = HasFirstHitLayers(film);
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1 && !stop_.load(std::memory_order_relaxed); ++x) {
      FirstHit<Real> first;
      const auto colour =
          scalar::RenderPixel(frame_, x, y, scratch_, rays_, stop_, has_layers ? &first : nullptr);
      write(x, y, colour, first);
    }
  }
}

template <typename Real>
void ScalarTileRenderer<Real>::RenderRound(const PixelRect& tile, int film_x, int film_y,
                                           Film& film, SampleRound& round) {
  FrameView<Real> frame = frame_;
  frame.error = static_cast<Real>(round.goal());
  const bool is_wanted = round.is_first() && HasFirstHitLayers(film);
  const auto is_stopped = [&] { return stop_.load(std::memory_order_relaxed) || round.Cut(); };
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      scalar::PixelSums<Real>& sums = round.sums().template at<Real>(x, y);
      if (sums.samples == frame.sample_x.size() || sums.IsConverged(frame.error)) continue;
      if (is_stopped()) return;
      FirstHit<Real> first;
      scalar::SamplePixel(frame, x, y, sums, scratch_, rays_, stop_, is_wanted ? &first : nullptr);
      if (round.is_first()) Write(x - film_x, y - film_y, sums.mean(), first, film);
    }
  }
}

template <typename Real>
void ScalarTileRenderer<Real>::Write(int x, int y, const Vec3<Real>& colour,
                                     const FirstHit<Real>& first, Film& film) const {
  if (HasFirstHitLayers(film)) StoreLayers(film, x, y, LayersOf(first, frame_));
  float* rgb = film.pixel(x, y);
  rgb[0] = static_cast<float>(colour.x);
  rgb[1] = static_cast<float>(colour.y);
  rgb[2] = static_cast<float>(colour.z);
}

template class ScalarTileRenderer<float>;
template class ScalarTileRenderer<double>;

}  // namespace sheaf
