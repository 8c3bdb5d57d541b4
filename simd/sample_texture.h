// Look-ups of texels.
#ifndef SHEAF_SIMD_SAMPLE_TEXTURE_H_
#define SHEAF_SIMD_SAMPLE_TEXTURE_H_

#include "simd/shading.h"
#include "simd/streams.h"

namespace sheaf {

// Where the channels of a texture go; null pointers for those that nobody asks for.
template <typename Real>
struct ChannelOutput {
  Real *r, *g, *b, *a;
};

// Writes what a texture shows at surfaces[0, count), by its set of their coordinates and, where the
// texture has several levels, of their footprints: red, green and blue in linear light, alpha in
// [0, 1]. Bits: as sheaf::scalar::SampleTexture and SampleAlpha. Reads and writes
// PaddedCount(count) lanes.
template <typename Real>
using SampleTextureKernel = void(const TextureData<Real>& texture,
                                 const SurfaceView<Real>& surfaces, std::uint32_t count,
                                 const ChannelOutput<Real>& channels);

}  // namespace sheaf

#endif  // SHEAF_SIMD_SAMPLE_TEXTURE_H_
