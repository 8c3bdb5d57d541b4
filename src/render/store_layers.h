// What a picture's layers hold of the first hit of a pixel.
#ifndef SHEAF_RENDER_STORE_LAYERS_H_
#define SHEAF_RENDER_STORE_LAYERS_H_

#include <limits>

#include "sheaf/film.h"
#include "simd/query.h"
#include "src/core/vec3.h"
#include "src/stream/first_hit.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// By default of a ray that meets nothing.
struct FirstHitLayers {
  float depth = std::numeric_limits<float>::infinity();
  Vec3<float> normal = {0, 0, 0}, albedo = {0, 0, 0};
  float id = 0;
};

template <typename Real>
FirstHitLayers LayersOf(const FirstHit<Real>& first, const FrameView<Real>& frame) {
  if (first.primitive == kNoPrimitive) return {};
  return {static_cast<float>(first.t * frame.length_unit), first.normal.template To<float>(),
          first.albedo.template To<float>(),
          static_cast<float>(frame.object_of_primitive[first.primitive] + 1)};
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
