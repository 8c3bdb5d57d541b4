// Finds where to split a range of primitives in two, by the binned surface area heuristic (Wald
// 2007) over all three axes.
#ifndef SHEAF_BVH_FIND_SPLIT_H_
#define SHEAF_BVH_FIND_SPLIT_H_

#include <cstdint>

#include "src/bvh/float4.h"
#include "src/bvh/primitive_box.h"

namespace sheaf::bvh {

// ---- Cost model ----

// A leaf costs kBlockCost for each block of kMaxLeafSize primitives that it begins, because a block
// is tested at once, plus kPrimitiveCost for each primitive. Where the node has room, a leaf is
// split if its two halves cost less than kWorthSplitting times as much. All kinds of primitives
// cost the same, as far as was measured.
inline constexpr float kBlockCost = 1.0f;
inline constexpr float kPrimitiveCost = 0.125f;
inline constexpr float kWorthSplitting = 1.0f;
inline constexpr std::uint32_t kSmallLeaf = 4;  // leaves of up to so many are never split
// Bins of an axis: one for every kPrimitivesPerBin primitives, between these limits.
inline constexpr int kMinBins = 8;
inline constexpr int kMaxBins = 32;
inline constexpr std::uint32_t kPrimitivesPerBin = 8;

// Primitives [begin, end) of the builder's array.
struct Range {
  std::uint32_t begin, end;
  PrimitiveCounts before, counts;  // by kind: of primitives before `begin`, and within
  Box4 bounds;                     // of the primitives' boxes
  Box4 centroids;                  // of lower + upper of each box, twice its centre

  std::uint32_t size() const { return end - begin; }
};

// The first kind, in the order of the enumerators, of which the range has primitives.
inline PrimitiveKind FirstKind(const Range& range) {
  std::uint32_t kind = 0;
  while (kind + 1 < kKindCount && range.counts.of[kind] == 0) ++kind;
  return static_cast<PrimitiveKind>(kind);
}

enum class SplitKind {
  kNone,
  kBin,     // by position along an axis
  kMedian,  // by position in the array
  kByKind,  // the first kind before the others
};

struct Split {
  SplitKind kind = SplitKind::kNone;
  int axis = 0, bin = 0;         // bins from `bin` on go right
  float base = 0, scale = 0;     // a primitive's bin is (lower + upper - base) * scale, truncated
  std::uint32_t left_count = 0;  // of kMedian and kByKind
  float cost = 0;                // of both sides, with lengths relative to the largest extent
  Box4 left, right;              // bounds, of kBin
};

// The factor that makes the largest extent of a box 1. Not finite or 0 where the box has none.
float UnitScale(const Box4& box);

float CostOfLeaf(const Range& range);

// The cheapest split by bins, or by median where bins tell nothing apart. Large ranges use all
// threads of the caller's arena; the split is the same.
Split FindSplit(const PrimitiveBox* boxes, const Range& range);

Split MedianSplit(const Range& range);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_FIND_SPLIT_H_
