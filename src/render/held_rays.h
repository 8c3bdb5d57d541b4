// Rays of some pixels that wait while those of others go on: how a tile whose rays outgrow their
// memory is rendered in parts.
#ifndef SHEAF_RENDER_HELD_RAYS_H_
#define SHEAF_RENDER_HELD_RAYS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simd/shading.h"
#include "src/render/ray_queue.h"

namespace sheaf {

// A depth of more rays is divided, unless they are few a pixel. Most tiles never have so many.
inline std::uint32_t MostRaysAtOnce(std::uint32_t pixels) {
  constexpr std::uint32_t kLeast = 8192, kAPixel = 4;
  return std::max(kLeast, kAPixel * pixels);
}

// A stack of what waits. Every part has fewer pixels than the one before it, so that there are
// never more than the logarithm of the pixels.
template <typename Real>
class HeldRays {
 public:
  // For the secondary rays of pixels 0 to `pixels`; nothing waits.
  void Start(std::uint32_t pixels) {
    waiting_ = 0;
    first_ = 0, end_ = pixels;
  }

  // Holds rays of the last pixels back, and leaves at most `most` or those of one pixel. Within a
  // pixel they keep their order. Returns how many are left in the `queues`, one a kind.
  std::uint32_t Divide(int depth, std::uint32_t most, RayQueue<Real>* queues);

  // Puts the rays that were held back last in the queues' place; false where none wait.
  bool TakeLast(int* depth, RayQueue<Real>* queues);

  std::size_t bytes() const;

 private:
  struct Part {
    RayQueue<Real> queues[kChildKinds];
    int depth = 0;
    std::uint32_t first = 0, end = 0;  // of its pixels
  };

  std::vector<Part> parts_;  // the first `waiting_` wait; the memory of the others is kept
  std::size_t waiting_ = 0;
  std::uint32_t first_ = 0, end_ = 0;  // pixels of the rays that go on
  std::vector<std::uint8_t> stays_;    // scratch, by ray
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_HELD_RAYS_H_
