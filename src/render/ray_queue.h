// A stream of rays together with where their light goes.
#ifndef SHEAF_RENDER_RAY_QUEUE_H_
#define SHEAF_RENDER_RAY_QUEUE_H_

#include <vector>

#include "src/stream/stream.h"

namespace sheaf {

template <typename Real>
struct RayQueue {
  RayStream<Real> rays;
  PathStream<Real> paths;
  std::uint32_t count = 0, capacity = 0;

  // Room for `n` rays; empties the queue.
  void Reset(std::uint32_t n) {
    count = 0;
    if (n <= capacity) return;
    // Doubling keeps the number of allocations small while depths grow.
    capacity = n > 2 * capacity ? n : 2 * capacity;
    rays.Allocate(capacity);
    paths.Allocate(capacity);
  }
};

// Brings the rays from `first` on into the order of their parents; no two share one. `parent_count`
// bounds PathFields::parent. Batches append material by material; this makes a pixel's rays
// independent of that.
template <typename Real>
class ParentOrder {
 public:
  void Apply(RayQueue<Real>& queue, std::uint32_t first, std::uint32_t parent_count);

 private:
  // Kept from call to call.
  std::vector<std::uint32_t> ray_of_parent_, order_, ids_;
  std::vector<Real> numbers_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_RAY_QUEUE_H_
