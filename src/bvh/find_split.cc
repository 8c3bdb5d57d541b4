#include "src/bvh/find_split.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_reduce.h>
#include <oneapi/tbb/partitioner.h>

#include <algorithm>

#include "simd/tree.h"

namespace sheaf::bvh {
namespace {

constexpr std::uint32_t kParallelSize = 1u << 16;  // ranges from here on are binned in parallel
constexpr std::uint32_t kGrain = 1u << 14;

// Bin of a primitive: its sum's distance from the lowest, scaled, axis by axis.
struct BinMap {
  int bins;
  Float4 base, scale;  // scale 0: all in bin 0
  bool is_usable;      // some axis tells primitives apart and none overflows

  BinMap(const Range& range)
      : bins(std::clamp(static_cast<int>(range.size() / kPrimitivesPerBin), kMinBins, kMaxBins)),
        base(range.centroids.lower),
        scale(Set4(0)),
        is_usable(false) {
    const Float4 extent = range.centroids.upper - range.centroids.lower;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(extent[axis] <= std::numeric_limits<float>::max())) {
        is_usable = false;
        return;
      }
      // Short of the count by more than rounding adds: the largest sum falls into the last bin.
      const float along = static_cast<float>(bins) * 0.9999f / extent[axis];
      if (!(along <= std::numeric_limits<float>::max())) continue;
      scale[axis] = along;
      is_usable = true;
    }
  }
  Int4 operator()(const Box4& box) const {
    return __builtin_convertvector((box.lower + box.upper - base) * scale, Int4);
  }
};

struct Bins {
  Box4 box[kMaxBins][3];
  alignas(16) std::int32_t count[kMaxBins][4];

  explicit Bins(int bins) {
    for (int i = 0; i < bins; ++i) {
      for (Box4& b : box[i]) b = Box4();
      std::memset(count[i], 0, sizeof(count[i]));
    }
  }

  Int4 Counts(int bin) const {
    Int4 counts;
    std::memcpy(&counts, count[bin], sizeof(counts));
    return counts;
  }
  void Add(const Box4& primitive, Int4 bin) {
    for (int axis = 0; axis < 3; ++axis) {
      box[bin[axis]][axis].Include(primitive);
      ++count[bin[axis]][axis];
    }
  }
  void Add(const PrimitiveBox* boxes, std::uint32_t begin, std::uint32_t end, const BinMap& map) {
    // In pairs from far apart, because neighbours tend to share bins and then wait for each other.
    const std::uint32_t half = (end - begin) / 2;
    for (std::uint32_t i = begin; i < begin + half; ++i) {
      const Box4 a = BoxOf(boxes[i]), b = BoxOf(boxes[i + half]);
      const Int4 bin_a = map(a), bin_b = map(b);
      Add(a, bin_a);
      Add(b, bin_b);
    }
    if (begin + 2 * half < end) {
      const Box4 last = BoxOf(boxes[end - 1]);
      Add(last, map(last));
    }
  }
  void Add(const Bins& other, int bins) {
    for (int i = 0; i < bins; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        box[i][axis].Include(other.box[i][axis]);
        count[i][axis] += other.count[i][axis];
      }
    }
  }
};

// Half areas of three boxes, one an axis of the bins, and a little of their length: where all areas
// are zero, lengths decide.
Float4 HalfAreas(const Box4 (&box)[3], Float4 scale) {
  const Float4 a = (box[0].upper - box[0].lower) * scale;
  const Float4 b = (box[1].upper - box[1].lower) * scale;
  const Float4 c = (box[2].upper - box[2].lower) * scale;
  const Float4 ab_xy = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Float4 ab_z = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Float4 x = __builtin_shufflevector(ab_xy, c, 0, 1, 4, 4);
  const Float4 y = __builtin_shufflevector(ab_xy, c, 2, 3, 5, 5);
  const Float4 z = __builtin_shufflevector(ab_z, c, 0, 1, 6, 6);
  return x * (y + z) + y * z + (x + y + z) * 1e-6f;
}

Float4 CostOfCounts(Int4 count) {
  static_assert(kMaxLeafSize == 8);
  return __builtin_convertvector((count + 7) >> 3, Float4) * kBlockCost +
         __builtin_convertvector(count, Float4) * kPrimitiveCost;
}

// Sweeps over the bins from both sides, the three axes in three lanes.
void ChooseBin(const Bins& bins, const BinMap& map, const Range& range, Split& split) {
  const Float4 scale = Set4(UnitScale(range.bounds));
  Float4 right_cost[kMaxBins];
  Box4 boxes[3];
  Int4 counts = {};
  for (int i = map.bins - 1; i > 0; --i) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[axis].Include(bins.box[i][axis]);
    }
    counts += bins.Counts(i);
    // An empty side has an infinite area and no cost: NaN, which never is the best.
    right_cost[i] = HalfAreas(boxes, scale) * CostOfCounts(counts);
  }
  Float4 best = Set4(std::numeric_limits<float>::infinity());
  Int4 best_bin = {};
  for (Box4& box : boxes) box = Box4();
  counts = Int4{};
  for (int i = 1; i < map.bins; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      boxes[axis].Include(bins.box[i - 1][axis]);
    }
    counts += bins.Counts(i - 1);
    const Float4 cost = HalfAreas(boxes, scale) * CostOfCounts(counts) + right_cost[i];
    const Int4 bin = {i, i, i, i};
    best_bin = cost < best ? bin : best_bin;
    best = Min(cost, best);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_better = split.kind == SplitKind::kNone || best[axis] < split.cost;
    if (best_bin[axis] == 0 || !is_better) continue;
    split.kind = SplitKind::kBin;
    split.axis = axis;
    split.bin = best_bin[axis];
    split.cost = best[axis];
  }
  if (split.kind == SplitKind::kNone) return;
  split.base = map.base[split.axis];
  split.scale = map.scale[split.axis];
  for (int i = 0; i < split.bin; ++i) split.left.Include(bins.box[i][split.axis]);
  for (int i = split.bin; i < map.bins; ++i) split.right.Include(bins.box[i][split.axis]);
}

}  // namespace

float UnitScale(const Box4& box) {
  const Float4 d = box.upper - box.lower;
  return 1 / std::max({d[0], d[1], d[2]});
}

float CostOfLeaf(const Range& range) {
  const std::uint32_t blocks = (range.size() + kMaxLeafSize - 1) / kMaxLeafSize;
  return HalfArea(range.bounds, UnitScale(range.bounds)) *
         (static_cast<float>(blocks) * kBlockCost +
          static_cast<float>(range.size()) * kPrimitiveCost);
}

Split MedianSplit(const Range& range) {
  Split split;
  split.kind = SplitKind::kMedian;
  split.left_count = range.size() / 2;
  split.cost = std::numeric_limits<float>::infinity();
  return split;
}

Split FindSplit(const PrimitiveBox* boxes, const Range& range) {
  const BinMap map(range);
  Split split;
  if (map.is_usable && range.size() < kParallelSize) {
    Bins bins(map.bins);
    bins.Add(boxes, range.begin, range.end, map);
    ChooseBin(bins, map, range, split);
  } else if (map.is_usable) {
    // Minima, maxima and counts do not depend on how the range is cut up.
    using oneapi::tbb::blocked_range;
    const Bins bins = oneapi::tbb::parallel_reduce(
        blocked_range<std::uint32_t>(range.begin, range.end, kGrain), Bins(map.bins),
        [&](const blocked_range<std::uint32_t>& part, Bins into) {
          into.Add(boxes, part.begin(), part.end(), map);
          return into;
        },
        [&](Bins a, const Bins& b) {
          a.Add(b, map.bins);
          return a;
        });
    ChooseBin(bins, map, range, split);
  }
  return split.kind == SplitKind::kNone ? MedianSplit(range) : split;
}

}  // namespace sheaf::bvh
