// The rays that surfaces send on: reflection and refraction.
#ifndef SHEAF_SIMD_SPAWN_RAYS_H_
#define SHEAF_SIMD_SPAWN_RAYS_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Appends the children of surfaces[0, count), in order and without gaps, from position 0 of each
// output: rays, the position of the parent in its stream (`paths.parent`), the throughput
// and, with kNeedsWidth, the width; leaves paths.pixel alone. `parents` gives the throughputs of
// the ray stream; null pointers there stand for 1. A child none of whose throughputs is over
// `min_throughput`, which is at least 0, is left out. Bits: as sheaf::scalar::Spawn. Reads
// PaddedCount(count) lanes; writes StreamCapacity(count) at most.
template <typename Real>
using SpawnRaysKernel = SpawnCounts(const MaterialData<Real>& material,
                                    const SurfaceView<Real>& surfaces, std::uint32_t count,
                                    const PathView<Real>& parents, Real min_throughput,
                                    const RayOutput<Real>& reflected_rays,
                                    const PathOutput<Real>& reflected_paths,
                                    const RayOutput<Real>& refracted_rays,
                                    const PathOutput<Real>& refracted_paths);

}  // namespace sheaf

#endif  // SHEAF_SIMD_SPAWN_RAYS_H_
