// Lists of hits for blocks of rays, from wherever the rays lie: what queries are made of.
#ifndef SHEAF_BVH_LIST_HITS_H_
#define SHEAF_BVH_LIST_HITS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/geometry.h"
#include "sheaf/queries.h"
#include "simd/hit_list.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/ray_block.h"

namespace sheaf {

inline constexpr std::uint32_t kListBlock = 128;  // rays whose lists are made at a time

// Fails as TraceAll does.
template <typename Real>
Status CheckRules(const RayArraysOf<Real>& rays, std::size_t count,
                  const RuledTraceOptionsOf<Real>& options);

inline Status CheckRules(const HitRules& rules, std::size_t count) {
  if (count > 0 && rules.excluded_per_ray > 0 && !rules.excluded) return NullArray("excluded");
  return Done{};
}

// The rules of rays, or other things that are asked about, from number `first` on.
template <typename Real>
HitRuleView RuleViewOf(const GeometryOf<Real>& geometry, const HitRules& rules, std::size_t first);

// The lists of at most kListBlock rays: elements [i * capacity, i * capacity + listed[i]) of
// `hits`.
template <typename Real>
class HitLister {
 public:
  HitLister(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
            const RuledTraceOptionsOf<Real>& options, std::uint32_t capacity);

  ListOrder order = ListOrder::kNearest;
  bool counts = false;  // whether `total` is wanted

  std::uint32_t capacity() const { return capacity_; }
  const ListedHit<Real>* list(std::uint32_t i) const {
    return hits_.data() + std::size_t{i} * capacity_;
  }
  std::uint32_t listed[kListBlock], total[kListBlock];

  // Takes rays [first, first + count), and lists their first hits.
  void Take(std::size_t first, std::uint32_t count);
  // Lists the hits that follow the last of each list, for rays of which wants(i) holds; the lists
  // of others are empty then. Returns whether any list has a hit.
  template <typename Wants>
  bool Next(Wants wants) {
    bool has_any = false;
    for (std::uint32_t i = 0; i < count_; ++i) {
      const bool goes_on = wants(i) && listed[i] == capacity_;
      after_[i] = goes_on ? list(i)[capacity_ - 1] : kNothing;
      has_any |= goes_on;
    }
    if (!has_any) return false;
    Grow();
    List(after_);
    has_any = false;
    for (std::uint32_t i = 0; i < count_; ++i) has_any |= listed[i] > 0;
    return has_any;
  }

  // t of ray `i` of the block where it misses.
  Real end(std::uint32_t i) const {
    const RayIntervals<Real>& intervals = block_.intervals();
    const Real t_max = intervals.t_max ? intervals.t_max[i] : intervals.all_t_max;
    return t_max > kDefaultTMax<Real> ? kDefaultTMax<Real> : t_max;
  }
  const RayView<Real>& rays() const { return block_.view(); }

 private:
  // After all that there is.
  static constexpr ListedHit<Real> kNothing = {std::numeric_limits<Real>::infinity(), kNoPrimitive,
                                               0, 0};
  void List(const ListedHit<Real>* after);
  // Rays that have many hits have more.
  void Grow() {
    capacity_ = std::min(4 * capacity_, std::max(capacity_, 1u << 12));
    hits_.resize(std::size_t{kListBlock} * capacity_);
  }

  const GeometryOf<Real>& geometry_;
  const RayArraysOf<Real>& arrays_;
  const RuledTraceOptionsOf<Real>& options_;
  std::uint32_t first_capacity_, capacity_;
  HitRuleView rules_;  // of the block
  RayBlock<Real, kListBlock> block_;
  std::uint32_t count_ = 0;
  ListedHit<Real> after_[kListBlock];
  std::vector<ListedHit<Real>> hits_;
};

}  // namespace sheaf

#endif  // SHEAF_BVH_LIST_HITS_H_
