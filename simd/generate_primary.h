// The primary rays of a list of pixels.
#ifndef SHEAF_SIMD_GENERATE_PRIMARY_H_
#define SHEAF_SIMD_GENERATE_PRIMARY_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Writes the origins and directions of `count` rays, one a pixel at the point (sx, sy) in [0, 1)^2
// of it; `x` and `y` hold whole numbers. `lens` has a point of the lens for each, read of cameras
// with one alone. Leaves the sources alone. Directions are unit vectors.
// Bits: as sheaf::scalar::CameraRay. Reads and writes PaddedCount(count) lanes.
template <typename Real>
using GeneratePrimaryKernel = void(const CameraData<Real>& camera, const Real* x, const Real* y,
                                   Real sx, Real sy, const SampleView<Real>& lens,
                                   std::uint32_t count, const RayOutput<Real>& rays);

}  // namespace sheaf

#endif  // SHEAF_SIMD_GENERATE_PRIMARY_H_
