// Smaller and smaller copies of an image, for what is seen from afar.
#ifndef SHEAF_RENDER_BUILD_MIP_CHAIN_H_
#define SHEAF_RENDER_BUILD_MIP_CHAIN_H_

#include <cstdint>
#include <vector>

#include "sheaf/scene.h"
#include "simd/shading.h"

namespace sheaf {

// The levels of an image (Williams, "Pyramidal Parametrics", SIGGRAPH 1983). Level 0 is the image
// itself; the sides of each further one are half of those before, rounded down, and at least 1.
struct MipChain {
  int level_count = 1;
  TextureLevels levels;
  std::vector<std::uint32_t> texels;  // of the levels after the first, one after the other
};

// A texel is the mean of what it covers of the level before: where a side is odd, of two and a
// fraction, so that each texel counts as much as any other. Means are taken in linear light, of
// alpha too, and of numbers: only what is stored is rounded to bytes. So each level has the image's
// mean, to the nearest byte.
MipChain BuildMipChain(const Image& image, Transfer transfer);

}  // namespace sheaf

#endif  // SHEAF_RENDER_BUILD_MIP_CHAIN_H_
