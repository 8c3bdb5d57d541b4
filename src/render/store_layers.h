// What a picture's layers hold of the first hit of a pixel.
#ifndef SHEAF_RENDER_STORE_LAYERS_H_
#define SHEAF_RENDER_STORE_LAYERS_H_

#include <limits>

#include "sheaf/film.h"
#include "src/core/vec3.h"

namespace sheaf {

// By default of a ray that meets nothing.
struct FirstHitLayers {
  float depth = std::numeric_limits<float>::infinity();
  Vec3<float> normal = {0, 0, 0}, albedo = {0, 0, 0};
  float id = 0;
};

template <typename Real>
FirstHitLayers MakeLayers(Real t, Vec3<Real> normal, Vec3<Real> albedo, std::uint32_t object) {
  return {static_cast<float>(t), normal.template To<float>(), albedo.template To<float>(),
          static_cast<float>(object + 1)};
}

// Whether the film has any layer but that of costs.
inline bool HasFirstHitLayers(const Film& film) {
  return film.has(Layer::kDepth) || film.has(Layer::kNormal) || film.has(Layer::kAlbedo) ||
         film.has(Layer::kId);
}

inline void StoreLayers(Film& film, int x, int y, const FirstHitLayers& hit) {
  const auto store = [&](Layer layer, Vec3<float> value) {
    float* const to = film.at(layer, x, y);
    to[0] = value.x, to[1] = value.y, to[2] = value.z;
  };
  if (film.has(Layer::kDepth)) *film.at(Layer::kDepth, x, y) = hit.depth;
  if (film.has(Layer::kNormal)) store(Layer::kNormal, hit.normal);
  if (film.has(Layer::kAlbedo)) store(Layer::kAlbedo, hit.albedo);
  if (film.has(Layer::kId)) *film.at(Layer::kId, x, y) = hit.id;
}

}  // namespace sheaf

#endif  // SHEAF_RENDER_STORE_LAYERS_H_
