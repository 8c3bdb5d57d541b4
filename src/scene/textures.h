// The textures of a material, whatever they are for.
#ifndef SHEAF_SCENE_TEXTURES_H_
#define SHEAF_SCENE_TEXTURES_H_

#include <variant>

#include "sheaf/scene.h"

namespace sheaf {

// Calls f(name, texture) for each texture of `material`, a Material that may be const, but for
// those that may be left out and are. Names are those of scene JSON.
template <typename M, typename F>
void ForEachTexture(M& material, F f) {
  if (auto* base = std::get_if<Texture>(&material.base_colour)) f("base_colour", *base);
  if (material.emission_texture) f("emission_texture", *material.emission_texture);
  if (material.metallic_roughness && material.metallic_roughness->texture.image) {
    f("metallic_roughness", material.metallic_roughness->texture);
  }
  if (material.occlusion) f("occlusion", material.occlusion->texture);
  if (material.transmission) f("transmission", material.transmission->texture);
  if (material.normal_map) f("normal_map", material.normal_map->texture);
}

}  // namespace sheaf

#endif  // SHEAF_SCENE_TEXTURES_H_
