// Triangles that shine, as a light: one of them is drawn by its power, then a point of it.
//
// Whether light is found by drawing the lamp or by a diffuse ray that meets it, both weigh by the
// power heuristic: Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo
// Rendering" (SIGGRAPH 1995).
#ifndef SHEAF_SCALAR_EMITTERS_H_
#define SHEAF_SCALAR_EMITTERS_H_

#include <cmath>
#include <cstdint>

#include "simd/sample_terms.h"
#include "simd/shading.h"
#include "src/scalar/draw_sample.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// An emitter, and where on it: what is left of the number that chose.
template <typename Real>
struct EmitterChoice {
  std::uint32_t emitter;
  Real rest;
};

// By the alias method: Walker, "An Efficient Method for Generating Discrete Random Variables with
// General Distributions" (ACM TOMS 3(3), 1977).
template <typename Real>
EmitterChoice<Real> ChooseEmitter(const EmitterView<Real>& emitters, Real u) {
  const Real last = static_cast<Real>(emitters.count - 1);
  const Real along = u * static_cast<Real>(emitters.count), floor = std::floor(along);
  const Real cell = floor < last ? floor : last;
  const auto i = static_cast<std::uint32_t>(cell);
  const Real part = along - cell, threshold = emitters.threshold[i];
  if (part < threshold) return {i, part / threshold};
  return {static_cast<std::uint32_t>(emitters.alias[i]), (part - threshold) / (1 - threshold)};
}

// The weight of a way to find light whose density is 1 where that of the other way is `other`.
template <typename Real>
Real PowerWeight(Real other) {
  return 1 / (1 + other * other);
}

// What light of a lamp counts that a diffuse ray found, which was drawn with this density.
// `distance` is how far it came; `density` of the lamp's drawing by area.
template <typename Real>
Real FoundWeight(Real ray_density, Real density, const Surface<Real>& surface, Real distance) {
  const Real cosine = std::abs(Dot(surface.face, surface.direction));
  const Real light_density = density * (distance * distance) / cosine;
  return PowerWeight(light_density / ray_density);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_EMITTERS_H_
