// The step from hits to the surfaces that are shaded.
#ifndef SHEAF_RENDER_FIND_SURFACES_H_
#define SHEAF_RENDER_FIND_SURFACES_H_

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/render/instanced_hits.h"
#include "src/render/ray_queue.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// The fields of surfaces that materials with `needs` read, as bits for Stream::Reserve.
template <typename Real>
constexpr std::uint64_t SurfaceFieldsFor(std::uint32_t needs) {
  using Fields = SurfaceView<Real>;
  const auto bits = [](auto... field) { return (FieldBit(field) | ...); };
  const std::uint64_t coordinates = bits(&Fields::u, &Fields::v);
  const std::uint64_t faces = bits(&Fields::face_x, &Fields::face_y, &Fields::face_z);
  const std::uint64_t curves =
      bits(&Fields::shadow_x, &Fields::shadow_y, &Fields::shadow_z, &Fields::bend);
  const std::uint64_t tints = bits(&Fields::tint_r, &Fields::tint_g, &Fields::tint_b);
  const std::uint64_t terms =
      bits(&Fields::ambient_r, &Fields::ambient_g, &Fields::ambient_b, &Fields::emission_r,
           &Fields::emission_g, &Fields::emission_b, &Fields::kd, &Fields::ks, &Fields::shininess,
           &Fields::reflect_r, &Fields::reflect_g, &Fields::reflect_b, &Fields::transmit_r,
           &Fields::transmit_g, &Fields::transmit_b, &Fields::slope_width);
  const std::uint64_t widths = FieldBit(&Fields::width);
  const std::uint64_t footprints = bits(&Fields::footprint_u, &Fields::footprint_v);
  const std::uint64_t facets =
      bits(&Fields::facet_x, &Fields::facet_y, &Fields::facet_z, &Fields::gloss);
  const std::uint64_t choices = bits(&Fields::choice_reflect, &Fields::choice_refract,
                                     &Fields::choice_diffuse, &Fields::scatter);
  const std::uint64_t alphas = FieldBit(&Fields::alpha);
  const std::uint64_t second = bits(&Fields::u2, &Fields::v2);
  const std::uint64_t second_footprints = bits(&Fields::footprint_u2, &Fields::footprint_v2);
  const bool has_second = (needs & kNeedsSecondSet) != 0;
  return ~(coordinates | faces | curves | tints | terms | widths | footprints | facets | choices |
           alphas | second | second_footprints) |
         (needs & kNeedsCoordinates ? coordinates : 0) | (needs & kNeedsNormals ? faces : 0) |
         (NeedsCurves(needs) ? curves : 0) | (needs & kNeedsTint ? tints : 0) |
         (needs & kNeedsTerms ? terms : 0) | (needs & kNeedsWidth ? widths : 0) |
         (needs & kNeedsFootprint ? footprints : 0) | (needs & kNeedsGloss ? facets : 0) |
         (needs & kNeedsChoice ? choices : 0) | (needs & kNeedsVertexAlpha ? alphas : 0) |
         (has_second ? second : 0) |
         (has_second && (needs & kNeedsFootprint) ? second_footprints : 0);
}

// The fields of texels that these materials look up in so many textures, likewise.
template <typename Real>
constexpr std::uint64_t TexelFieldsFor(std::uint32_t needs, std::size_t textures) {
  using Fields = TexelView<Real>;
  // Materials vary without textures too, where they are partly there.
  if (needs & kNeedsTerms) return ~std::uint64_t{0};
  if (textures == 0) return 0;
  return FieldBit(&Fields::r) | FieldBit(&Fields::g) | FieldBit(&Fields::b);
}

// Writes the surfaces of the bin's hits to surfaces[0, bin.batch.count), as far as the bin's
// material needs them, and returns what to read them through. `batch` has rays as what they hit
// sees them, and `instanced` takes surfaces from there. Leaves in `texels` what textures say.
template <typename Real>
SurfaceView<Real> FindSurfaces(const FrameView<Real>& frame, const Kernels<Real>& kernels,
                               const HitBin& bin, const RayBatch<Real>& batch,
                               const HitView<Real>& hits, const InstancedHits<Real>& instanced,
                               SurfaceStream<Real>& surfaces, const TexelOutput<Real>& texels);

}  // namespace sheaf

#endif  // SHEAF_RENDER_FIND_SURFACES_H_
