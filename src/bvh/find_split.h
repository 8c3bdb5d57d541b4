// Where to split a range of primitives in two: binned surface area heuristic (Wald 2007), in all
// three axes at once.
#ifndef SHEAF_BVH_FIND_SPLIT_H_
#define SHEAF_BVH_FIND_SPLIT_H_

#include <cstdint>

#include "src/bvh/float4.h"
#include "src/bvh/primitive_box.h"

namespace sheaf::bvh {

// ---- Cost model: to be tuned by the measured speed of traversal ----

// A leaf of n primitives costs kBlockCost for every kMaxLeafSize of them begun, plus kPrimitiveCost
// each: whole blocks are tested at once. A leaf is split, where the node has room, only if its two
// halves cost less than kWorthSplitting of it.
// No measurement tells the kinds apart so far.
inline constexpr float kBlockCost = 1.0f;
inline constexpr float kPrimitiveCost = 0.125f;
inline constexpr float kWorthSplitting = 1.0f;
inline constexpr std::uint32_t kSmallLeaf = 4;  // leaves of so many are never split
// Bins an axis: a few more the more primitives there are.
inline constexpr int kMinBins = 8;
inline constexpr int kMaxBins = 32;
inline constexpr std::uint32_t kPrimitivesPerBin = 8;

// Primitives [begin, end) of the builder's array.
struct Range {
  std::uint32_t begin, end;
  PrimitiveCounts before, counts;  // by kind: of primitives before `begin`, and within
  Box4 bounds, centroids;          // of the boxes and of the sums lower + upper

  std::uint32_t size() const { return end - begin; }
};

// The first kind that is there, in the order of the enumerators.
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
  float base = 0, scale = 0;     // bin of a primitive: truncated (sum - base) * scale
  std::uint32_t left_count = 0;  // of kMedian and kByKind
  float cost = 0;                // of both sides, where the range's largest extent is 1
  Box4 left, right;              // bounds, of kBin
};

// Scale by which the largest extent of a box is 1; not finite or 0 where there is none.
float UnitScale(const Box4& box);

float CostOfLeaf(const Range& range);

// The cheapest split by bins, or by median where bins tell nothing apart. Large ranges use all
// threads of the caller's arena; the split is the same.
Split FindSplit(const PrimitiveBox* boxes, const Range& range);

Split MedianSplit(const Range& range);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_FIND_SPLIT_H_
