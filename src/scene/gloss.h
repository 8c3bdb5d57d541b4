// glTF's metal and roughness in a material's terms: the formulas of docs/formats.md, "glTF".
#ifndef SHEAF_SCENE_GLOSS_H_
#define SHEAF_SCENE_GLOSS_H_

#include <algorithm>

namespace sheaf {

template <typename Real>
struct Gloss {
  Real kd, ambient;  // what a material's are multiplied with
  Real ks, shininess;
  Real mirror;       // of the base colour
  Real slope_width;  // of its facets
};

// Of what mirrors sharply: a metal turns from a mirror to diffuse as it grows rough. `metallic` and
// `roughness` in [0, 1]; `specular` >= 0: the highlight of what is no metal, over that of an index
// of 1.5.
template <typename Real>
Gloss<Real> GlossOf(Real metallic, Real roughness, Real specular) {
  const Real smooth = 1 - roughness;
  const Real mirror = metallic * (smooth * smooth);
  const Real dielectric = Real(0.2) * (1 - metallic);
  // Blinn and Phong's exponent for the roughness of a microfacet surface (Walter et al. 2007).
  const Real alpha = std::max(roughness * roughness, Real(0.01));
  return {1 - metallic * smooth,
          1 - mirror,
          (Real(0.2) + Real(0.6) * metallic + dielectric * (specular - 1)) * smooth,
          std::max(2 / (alpha * alpha) - 2, Real(1)),
          mirror > Real(0.02) ? mirror : Real(0),
          0};
}

// Of what is mirrored by facets that are drawn: a metal is a mirror, however rough.
template <typename Real>
Gloss<Real> FacetGlossOf(Real metallic, Real roughness, Real specular) {
  Gloss<Real> gloss = GlossOf(metallic, roughness, specular);
  gloss.kd = gloss.ambient = 1 - metallic;
  gloss.mirror = metallic;
  gloss.slope_width = roughness * roughness;
  return gloss;
}

}  // namespace sheaf

#endif  // SHEAF_SCENE_GLOSS_H_
