// Rough mirrors and interfaces: facets that are smooth, with slopes after Trowbridge and Reitz
// (GGX).
//
// A facet is drawn as often as the ray sees it (Heitz, "Sampling the GGX Distribution of Visible
// Normals", JCGT 7(4), 2018; by the spherical caps of Dupuy and Benyoub, HPG 2023), so that a ray's
// throughput is multiplied with the masking of the direction it leaves in alone. Light that facets
// send to one another comes back by a table (Turquin, "Practical multiple scattering compensation
// for microfacet models", 2019), so that no light is lost.
#ifndef SHEAF_SCALAR_MICROFACET_H_
#define SHEAF_SCALAR_MICROFACET_H_

#include <cmath>
#include <cstddef>

#include "simd/shading.h"
#include "src/scalar/draw_sample.h"
#include "src/scalar/frame.h"
#include "src/scalar/sin_cos.h"
#include "src/scalar/surface.h"

namespace sheaf::scalar {

// The share of facets that a direction with this cosine to the surface's normal sees unhidden:
// Smith's function. `width` is that of the slopes.
template <typename Real>
Real Unmasked(Real cosine, Real width) {
  if (!(cosine > 0)) return 0;
  const Real square = cosine * cosine;
  return 2 * cosine / (cosine + std::sqrt(square + (width * width) * (1 - square)));
}

// The normal of a facet that the ray sees.
template <typename Real>
Vec3<Real> DrawFacet(Real width, const Surface<Real>& surface, SamplePoint<Real> point) {
  const Vec3<Real> n = surface.normal, o = -surface.direction;
  const Frame<Real> frame(n);
  const Real height = Dot(n, o);
  if (!(height > 0)) return n;
  const Vec3<Real> seen =
      Normalize(Vec3<Real>{Dot(frame.x, o) * width, Dot(frame.y, o) * width, height});
  const Real z = (1 - point.v) * (1 + seen.z) - seen.z;
  const Real square = 1 - z * z;
  const Real radius = std::sqrt(square > 0 ? square : Real(0));
  const SinCos<Real> angle = SinCosOf(4 * point.u);
  const Vec3<Real> facet = Normalize(Vec3<Real>{(radius * angle.cos + seen.x) * width,
                                                (radius * angle.sin + seen.y) * width, z + seen.z});
  return (frame.x * facet.x + frame.y * facet.y) + n * facet.z;
}

// What throughputs are multiplied with besides: the table between the cosines around that of the
// arriving ray, and between the widths around the material's where these vary.
template <typename Real>
Real GlossAt(const MaterialData<Real>& material, const Surface<Real>& surface) {
  const Real* table = material.gloss + (surface.inside() ? kGlossEntries : 0);
  const Real height = Dot(surface.normal, -surface.direction);
  const Real clamped = height > 0 ? (height < 1 ? height : Real(1)) : Real(0);
  const Real along = std::sqrt(clamped) * kGlossSteps, step = std::floor(along);
  const int i = static_cast<int>(step);
  const auto between = [&] { return table[i] + (table[i + 1] - table[i]) * (along - step); };
  if (!material.finish.has_facets) return between();
  const Real across = std::sqrt(material.slope_width) * kGlossRowSteps, row = std::floor(across);
  table += static_cast<std::ptrdiff_t>(row) * (2 * kGlossEntries);
  const Real low = between();
  table += 2 * kGlossEntries;
  return low + (between() - low) * (across - row);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_MICROFACET_H_
