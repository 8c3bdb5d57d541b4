// The hits of a ray in order, and the rules by which they count.
#ifndef SHEAF_SIMD_HIT_LIST_H_
#define SHEAF_SIMD_HIT_LIST_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace sheaf {

// A hit in a list: as HitFields has them. A sphere is hit twice, where the ray enters it (u is 0)
// and where it leaves it (u is 1).
template <typename Real>
struct ListedHit {
  Real t;
  std::uint32_t primitive;
  Real u, v;
};

// The order of a ray's hits: by t, then by primitive; a sphere that is touched is entered first.
template <typename Real>
constexpr bool Precedes(const ListedHit<Real>& a, const ListedHit<Real>& b) {
  if (a.t != b.t) return a.t < b.t;
  return a.primitive != b.primitive ? a.primitive < b.primitive : a.u < b.u;
}

// Which hits count, besides those in the interval. What is null rules nothing out.
struct HitRuleView {
  // A hit on object k counts for ray i where object_mask[k] & ray_mask[i] is not 0. Object k has
  // the primitives [first[k], first[k + 1]).
  const std::uint32_t* object_mask = nullptr;
  const std::uint32_t* first = nullptr;
  std::uint32_t object_count = 0;
  const std::uint32_t* ray_mask = nullptr;  // null: all_ray_mask for all
  std::uint32_t all_ray_mask = 0xffffffffu;
  // Ray i does not hit excluded[i * excluded_count, (i + 1) * excluded_count).
  const std::uint32_t* excluded = nullptr;
  std::uint32_t excluded_count = 0;

  bool Admits(std::uint32_t ray, std::uint32_t primitive) const {
    for (std::uint32_t k = 0; k < excluded_count; ++k) {
      if (excluded[std::size_t{ray} * excluded_count + k] == primitive) return false;
    }
    if (!object_mask) return true;
    // The last object that begins at or before the primitive.
    std::uint32_t low = 0, high = object_count;
    while (high - low > 1) {
      const std::uint32_t middle = low + (high - low) / 2;
      (first[middle] <= primitive ? low : high) = middle;
    }
    return (object_mask[low] & (ray_mask ? ray_mask[ray] : all_ray_mask)) != 0;
  }
};

// Which hits a list keeps that has not room for all.
enum class ListOrder {
  kNearest,  // the first ones
  kAny,      // any: a ray ends as soon as its list is full
};

// Where lists are written: the hits of ray i in hits[i * capacity, i * capacity + listed[i]), in
// order. `total` has how many there are besides those that no list has room for; null: nobody asks,
// and rays end where their lists do.
template <typename Real>
struct HitListOutput {
  ListedHit<Real>* hits;
  std::uint32_t capacity;
  std::uint32_t* listed;
  std::uint32_t* total;
  ListOrder order = ListOrder::kNearest;
  // The hit of each ray that its list begins after; null: lists begin at the first hit. Where its t
  // is beyond the interval, nothing is listed nor counted.
  const ListedHit<Real>* after = nullptr;
};

// The list of one ray while it grows.
template <typename Real>
class HitList {
 public:
  HitList(const HitListOutput<Real>& output, const HitRuleView& rules, std::uint32_t ray,
          Real t_max)
      : output_(output),
        rules_(rules),
        ray_(ray),
        hits_(output.hits + std::size_t{ray} * output.capacity),
        last_(t_max) {}

  // No hit beyond is wanted.
  Real last() const { return last_; }
  bool is_done() const {
    return output_.order == ListOrder::kAny && listed_ == output_.capacity && !output_.total;
  }

  // Takes a hit of the interval, in whatever order they are found.
  void Add(const ListedHit<Real>& hit) {
    if (output_.after && !Precedes(output_.after[ray_], hit)) return;
    if (!rules_.Admits(ray_, hit.primitive)) return;
    ++total_;
    if (listed_ < output_.capacity) {
      hits_[listed_++] = hit;
      if (listed_ < output_.capacity) return;
      std::make_heap(hits_, hits_ + listed_, Precedes<Real>);
    } else {
      // Full: a heap, whose first element is the last of the list.
      if (listed_ == 0 || !Precedes(hit, hits_[0])) return;
      std::pop_heap(hits_, hits_ + listed_, Precedes<Real>);
      hits_[listed_ - 1] = hit;
      std::push_heap(hits_, hits_ + listed_, Precedes<Real>);
    }
    if (!output_.total) last_ = hits_[0].t;
  }

  // Puts the list in order. Nothing is added any more.
  void Finish() const {
    std::sort(hits_, hits_ + listed_, Precedes<Real>);
    output_.listed[ray_] = listed_;
    if (output_.total) output_.total[ray_] = total_;
  }

 private:
  const HitListOutput<Real>& output_;
  const HitRuleView& rules_;
  std::uint32_t ray_;
  ListedHit<Real>* hits_;
  std::uint32_t listed_ = 0, total_ = 0;
  Real last_;
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_HIT_LIST_H_
