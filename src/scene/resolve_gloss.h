// Materials that are as metallic and as rough everywhere, in the terms that others are given in.
#ifndef SHEAF_SCENE_RESOLVE_GLOSS_H_
#define SHEAF_SCENE_RESOLVE_GLOSS_H_

#include "sheaf/scene.h"

namespace sheaf {

// How rough mirrors are shown: docs/formats.md, "glTF".
enum class GlossModel {
  kFading,  // sharply, the less the rougher: GlossOf, of whitted and distributed
  kFacets,  // by facets that are drawn: FacetGlossOf, of path
};

// The same material without `metallic_roughness`, where neither that nor the colour of a metal
// varies from point to point; else the material as it is.
Material ResolveGloss(Material material, GlossModel model);

}  // namespace sheaf

#endif  // SHEAF_SCENE_RESOLVE_GLOSS_H_
