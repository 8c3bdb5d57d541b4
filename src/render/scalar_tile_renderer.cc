#include "src/render/scalar_tile_renderer.h"

#include "src/render/store_layers.h"
#include "src/scalar/render_adaptively.h"
#include "src/stream/first_hit.h"

namespace sheaf {

template <typename Real>
void ScalarTileRenderer<Real>::Render(const PixelRect& tile, int film_x, int film_y, Film& film) {
  const bool has_layers = HasFirstHitLayers(film);
  const auto write = [&](int x, int y, const Vec3<Real>& colour, const FirstHit<Real>& first) {
    if (has_layers) StoreLayers(film, x - film_x, y - film_y, LayersOf(first, frame_));
    float* rgb = film.pixel(x - film_x, y - film_y);
    rgb[0] = static_cast<float>(colour.x);
    rgb[1] = static_cast<float>(colour.y);
    rgb[2] = static_cast<float>(colour.z);
  };
  if (frame_.is_adaptive()) {
    scalar::RenderAdaptively(frame_, tile, scratch_, rays_, stop_, write);
    return;
  }
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1 && !stop_.load(std::memory_order_relaxed); ++x) {
      FirstHit<Real> first;
      const auto colour =
          scalar::RenderPixel(frame_, x, y, scratch_, rays_, stop_, has_layers ? &first : nullptr);
      write(x, y, colour, first);
    }
  }
}

template class ScalarTileRenderer<float>;
template class ScalarTileRenderer<double>;

}  // namespace sheaf
