#include "src/render/held_rays.h"

#include <utility>

namespace sheaf {
namespace {

template <typename Real>
std::uint32_t CountRays(const RayQueue<Real>* queues) {
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < kChildKinds; ++i) count += queues[i].count();
  return count;
}

}  // namespace

template <typename Real>
std::uint32_t HeldRays<Real>::Divide(int depth, std::uint32_t most, RayQueue<Real>* queues) {
  std::uint32_t count = CountRays(queues);
  while (count > most && end_ - first_ > 1) {
    const std::uint32_t middle = first_ + (end_ - first_) / 2;
    if (waiting_ == parts_.size()) parts_.emplace_back();
    Part& part = parts_[waiting_++];
    for (std::size_t i = 0; i < kChildKinds; ++i) {
      queues[i].MoveFrom(middle, stays_, part.queues[i]);
    }
    part.depth = depth;
    part.first = middle, part.end = end_;
    end_ = middle;
    count = CountRays(queues);
  }
  return count;
}

template <typename Real>
bool HeldRays<Real>::TakeLast(int* depth, RayQueue<Real>* queues) {
  if (waiting_ == 0) return false;
  Part& part = parts_[--waiting_];
  for (std::size_t i = 0; i < kChildKinds; ++i) std::swap(queues[i], part.queues[i]);
  *depth = part.depth;
  first_ = part.first, end_ = part.end;
  return true;
}

template <typename Real>
std::size_t HeldRays<Real>::bytes() const {
  std::size_t sum = stays_.capacity();
  for (const Part& part : parts_) {
    for (const RayQueue<Real>& queue : part.queues) sum += queue.bytes();
  }
  return sum;
}

template class HeldRays<float>;
template class HeldRays<double>;

}  // namespace sheaf
