#include "src/view/show_layer.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "src/scene/bounds.h"

namespace sheaf {
namespace {

// Neighbouring numbers get colours far apart: steps of the golden ratio along three channels.
void ShowId(float id, float* rgb) {
  constexpr double kSteps[3] = {0.61803398874989485, 0.75487766624669276, 0.81917251339616444};
  for (int c = 0; c < 3; ++c) {
    const double turns = static_cast<double>(id) * kSteps[c];
    rgb[c] = id == 0 ? 0.0f : static_cast<float>(0.25 + 0.75 * (turns - std::floor(turns)));
  }
}

void ShowPixel(Layer layer, LayerLook look, const float* from, double far, float* rgb) {
  const bool is_display = look == LayerLook::kDisplay;
  switch (layer) {
    case Layer::kDepth: {
      const double share = 1 - static_cast<double>(*from) / far;
      std::fill_n(rgb, 3, is_display ? static_cast<float>(std::max(share, 0.0)) : *from);
      return;
    }
    case Layer::kId:
      if (is_display) return ShowId(*from, rgb);
      std::fill_n(rgb, 3, *from);
      return;
    case Layer::kNormal:
      for (int c = 0; c < 3; ++c) rgb[c] = is_display ? 0.5f + 0.5f * from[c] : from[c];
      return;
    default:
      std::copy_n(from, 3, rgb);
  }
}

}  // namespace

Film ShowLayer(const Film& rows, Layer layer, LayerLook look, double far) {
  Film film(rows.width, rows.height);
  for (int y = 0; y < rows.height; ++y) {
    for (int x = 0; x < rows.width; ++x) {
      ShowPixel(layer, look, rows.at(layer, x, y), far, film.pixel(x, y));
    }
  }
  return film;
}

double FarthestDepth(const Scene& scene, const Camera& camera) {
  const auto bounds = BoundsOf(scene);
  if (!bounds) return 1;
  const Vec3d reach =
      glm::max(glm::abs(bounds->min - camera.eye), glm::abs(bounds->max - camera.eye));
  return std::max(glm::length(reach), 1e-30);
}

}  // namespace sheaf
