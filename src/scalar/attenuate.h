// What a transparent body takes from the light that goes through it: Beer's law.
#ifndef SHEAF_SCALAR_ATTENUATE_H_
#define SHEAF_SCALAR_ATTENUATE_H_

#include "simd/query.h"
#include "simd/shading.h"
#include "src/core/vec3.h"
#include "src/scalar/pow.h"
#include "src/stream/frame_view.h"

namespace sheaf::scalar {

// The share of light, by colour, that is left after `length` along a ray from `source`. A ray that
// starts on the inner side of a surface runs in its body; all others, and one that leaves the
// scene without meeting the body's end, keep everything.
template <typename Real>
Vec3<Real> TransmittanceOf(const FrameView<Real>& frame, std::uint32_t source, Real length) {
  if (source == kNoPrimitive || (source & kInsideBit) == 0) return {1, 1, 1};
  const MaterialData<Real>& material =
      frame.materials[frame.primitives[source & ~kInsideBit].material];
  if (!material.attenuates) return {1, 1, 1};
  const Real distances = length / material.attenuation_distance;
  return {Pow(material.attenuation[0], distances), Pow(material.attenuation[1], distances),
          Pow(material.attenuation[2], distances)};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_ATTENUATE_H_
