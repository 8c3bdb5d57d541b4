#include "src/scene/resolve_gloss.h"

#include <variant>

#include "src/scene/gloss.h"

namespace sheaf {

Material ResolveGloss(Material material, GlossModel model) {
  if (!material.metallic_roughness || material.metallic_roughness->texture.image) return material;
  const MetallicRoughness from = *material.metallic_roughness;
  const Colour* const base = std::get_if<Colour>(&material.base_colour);
  if (base == nullptr && from.metallic > 0) return material;  // its mirror has the colours
  const bool has_facets = model == GlossModel::kFacets;
  const Gloss<double> gloss = has_facets
                                  ? FacetGlossOf(from.metallic, from.roughness, from.specular)
                                  : GlossOf(from.metallic, from.roughness, from.specular);
  material.kd *= gloss.kd;
  material.ks = gloss.ks;
  material.shininess = gloss.shininess;
  material.ambient *= gloss.ambient;
  material.reflect = base == nullptr ? Colour(0.0) : glm::min(*base, Colour(1.0)) * gloss.mirror;
  material.transmit *= 1 - from.metallic;
  if (material.transmission) material.transmission->share *= 1 - from.metallic;
  material.roughness = has_facets ? from.roughness : 0.0;
  material.metallic_roughness.reset();
  return material;
}

}  // namespace sheaf
