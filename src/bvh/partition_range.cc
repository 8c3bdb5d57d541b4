#include "src/bvh/partition_range.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <vector>

namespace sheaf::bvh {
namespace {

constexpr std::uint32_t kBlock = 2048;             // primitives that are moved by one task
constexpr std::uint32_t kParallelSize = 1u << 16;  // ranges from here on are split in parallel

// Up to kBlock primitives of each kind, counted without a branch.
struct PackedCounts {
  static constexpr std::uint32_t kBits = 64 / kKindCount;
  static_assert(kBlock < 1ull << kBits);
  std::uint64_t packed = 0;

  void Add(PrimitiveKind kind, std::uint64_t count) { packed += count << kBits * IndexOf(kind); }
  PrimitiveCounts Unpack() const {
    PrimitiveCounts counts;
    for (std::uint32_t k = 0; k < kKindCount; ++k) {
      counts.of[k] = static_cast<std::uint32_t>(packed >> kBits * k & ((1ull << kBits) - 1));
    }
    return counts;
  }
};

// What became of a block: its first `left` primitives go left.
struct Block {
  std::uint32_t begin, end, left;
  PackedCounts left_counts;
  Box4 left_centroids, right_centroids;
};

// Moves left before right without a branch: every primitive is stored on both sides, and one of
// the two cursors advances.
void PartitionBlock(PrimitiveBox* boxes, const Split& split, Block& block) {
  PrimitiveBox right[kBlock];
  std::uint32_t left_end = block.begin, right_count = 0;
  const int axis = split.axis;
  for (std::uint32_t i = block.begin; i < block.end; ++i) {
    const PrimitiveBox box = boxes[i];
    const std::int32_t bin = static_cast<std::int32_t>(
        (boxes[i].lower[axis] + boxes[i].upper[axis] - split.base) * split.scale);
    const std::uint32_t goes_right = bin >= split.bin;
    const Box4 bounds = BoxOf(box);
    const Float4 sum = bounds.lower + bounds.upper;
    // All ones make a NaN, which Min and Max pass over.
    const std::int32_t ones = -static_cast<std::int32_t>(goes_right);
    const Int4 hide_left = {ones, ones, ones, ones};
    const Float4 of_left = std::bit_cast<Float4>(std::bit_cast<Int4>(sum) | hide_left);
    const Float4 of_right = std::bit_cast<Float4>(std::bit_cast<Int4>(sum) | ~hide_left);
    block.left_centroids.Include(of_left, of_left);
    block.right_centroids.Include(of_right, of_right);
    boxes[left_end] = box;
    right[right_count] = box;
    left_end += 1 - goes_right;
    right_count += goes_right;
    block.left_counts.Add(KindOf(box.tag), 1 - goes_right);
  }
  std::copy(right, right + right_count, boxes + left_end);
  block.left = left_end - block.begin;
}

// Primitives that ended up on the wrong side of the middle, in pairs of equal length.
struct Exchange {
  std::uint32_t a, b, count;
};

std::vector<Exchange> PairMisplaced(const std::vector<Block>& blocks, std::uint32_t middle) {
  std::vector<Exchange> exchanges;
  std::size_t to = 0;
  std::uint32_t b = 0, b_end = 0;  // left primitives beyond the middle
  for (const Block& block : blocks) {
    std::uint32_t a = block.begin + block.left;  // right primitives before the middle
    const std::uint32_t a_end = std::min(block.end, middle);
    while (a < a_end) {
      while (b == b_end) {
        const Block& next = blocks[to++];
        b_end = next.begin + next.left;
        b = std::min(std::max(next.begin, middle), b_end);
      }
      const std::uint32_t count = std::min(a_end - a, b_end - b);
      exchanges.push_back({a, b, count});
      a += count;
      b += count;
    }
  }
  return exchanges;
}

template <typename Body>
void ForEach(std::uint32_t range_size, std::size_t count, const Body& body) {
  if (range_size >= kParallelSize) {
    oneapi::tbb::parallel_for(std::size_t{0}, count, body);
  } else {
    for (std::size_t i = 0; i < count; ++i) body(i);
  }
}

Halves CutAt(const Range& range, std::uint32_t middle, const PrimitiveCounts& left) {
  Halves halves;
  halves.left = {range.begin, middle, range.before, left, {}, {}};
  halves.right = {middle, range.end, range.before, range.counts, {}, {}};
  halves.right.before += left;
  halves.right.counts -= left;
  return halves;
}

Halves PartitionByBin(PrimitiveBox* boxes, const Range& range, const Split& split) {
  const auto finish = [&](std::uint32_t middle, const PrimitiveCounts& left) {
    Halves halves = CutAt(range, middle, left);
    halves.left.bounds = split.left;
    halves.right.bounds = split.right;
    return halves;
  };
  if (range.size() <= kBlock) {
    Block block = {range.begin, range.end, 0, {}, {}, {}};
    PartitionBlock(boxes, split, block);
    Halves halves = finish(block.begin + block.left, block.left_counts.Unpack());
    halves.left.centroids = block.left_centroids;
    halves.right.centroids = block.right_centroids;
    return halves;
  }
  std::vector<Block> blocks((range.size() + kBlock - 1) / kBlock);
  ForEach(range.size(), blocks.size(), [&](std::size_t i) {
    const std::uint32_t begin = range.begin + static_cast<std::uint32_t>(i) * kBlock;
    blocks[i] = {begin, std::min(begin + kBlock, range.end), 0, {}, {}, {}};
    PartitionBlock(boxes, split, blocks[i]);
  });
  std::uint32_t middle = range.begin;
  PrimitiveCounts left_counts;
  Box4 left, right;
  for (const Block& block : blocks) {
    middle += block.left;
    left_counts += block.left_counts.Unpack();
    left.Include(block.left_centroids);
    right.Include(block.right_centroids);
  }
  const std::vector<Exchange> exchanges = PairMisplaced(blocks, middle);
  ForEach(range.size(), exchanges.size(), [&](std::size_t i) {
    const auto [a, b, count] = exchanges[i];
    std::swap_ranges(boxes + a, boxes + a + count, boxes + b);
  });
  Halves halves = finish(middle, left_counts);
  halves.left.centroids = left;
  halves.right.centroids = right;
  return halves;
}

void Measure(const PrimitiveBox* boxes, Range& range) {
  for (std::uint32_t i = range.begin; i < range.end; ++i) {
    const Box4 box = BoxOf(boxes[i]);
    range.bounds.Include(box);
    range.centroids.Include(box.lower + box.upper, box.lower + box.upper);
  }
}

}  // namespace

Halves PartitionRange(PrimitiveBox* boxes, const Range& range, const Split& split) {
  if (split.kind == SplitKind::kBin) return PartitionByBin(boxes, range, split);
  PrimitiveBox* const begin = boxes + range.begin;
  if (split.kind == SplitKind::kByKind) {
    const PrimitiveKind first = FirstKind(range);
    std::partition(begin, boxes + range.end,
                   [&](const PrimitiveBox& box) { return KindOf(box.tag) == first; });
  }
  PrimitiveCounts left;
  std::for_each(begin, begin + split.left_count,
                [&](const PrimitiveBox& box) { ++left[KindOf(box.tag)]; });
  Halves halves = CutAt(range, range.begin + split.left_count, left);
  Measure(boxes, halves.left);
  Measure(boxes, halves.right);
  return halves;
}

}  // namespace sheaf::bvh
