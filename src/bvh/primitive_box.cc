#include "src/bvh/primitive_box.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "src/bvh/primitive_rules.h"
#include "src/bvh/round_outward.h"

namespace sheaf::bvh {
namespace {

constexpr std::uint32_t kBlock = 4096;  // primitives a task; the result does not depend on it

template <typename Real>
BoxState StateOf(const Real* values, int count) {
  // A NaN anywhere makes the sum of zeros NaN, and so does an infinity.
  Real zeros = 0;
  for (int i = 0; i < count; ++i) zeros += values[i] * 0;
  if (zeros == 0) return BoxState::kFinite;
  for (int i = 0; i < count; ++i) {
    if (values[i] != values[i]) return BoxState::kNever;
  }
  return BoxState::kInfinite;
}

template <typename Arrays>
BoxState MakeBoxOf(const Arrays& arrays, std::uint32_t index, PrimitiveBox& box) {
  using Real = typename Arrays::Number;
  Real values[Arrays::kFieldCount];
  Real* next = values;
  Arrays::ForEachField(arrays, [&](const Real* field) { *next++ = field[index]; });
  if (const BoxState state = StateOf(values, Arrays::kFieldCount); state != BoxState::kFinite) {
    return state;
  }
  MakeFiniteBox<Arrays::kKind>(values, MakeTag(Arrays::kKind, index), box);
  return BoxState::kFinite;
}

struct BlockBounds {
  Box4 boxes, centroids, all, others;  // as PrimitiveBoxes has them
};

// Fills boxes[0, n) of the primitives [first, first + n) without gaps; returns how many there are,
// or -1 where a coordinate is infinite.
template <typename Make>
std::int64_t FillBlock(std::uint32_t first, std::uint32_t n, PrimitiveBox* boxes,
                       BlockBounds& bounds, const Make& make) {
  std::uint32_t count = 0;
  for (std::uint32_t i = first; i < first + n; ++i) {
    const BoxState state = make(i, boxes[count]);
    if (state == BoxState::kInfinite) return -1;
    if (state == BoxState::kNever) continue;
    PrimitiveBox& made = boxes[count++];
    bounds.all.Include(BoxOf(made));
    if (IsGiant(made)) {
      made = GiantBox(made.tag);
    } else {
      bounds.others.Include(BoxOf(made));
    }
    const Box4 box = BoxOf(made);
    bounds.boxes.Include(box);
    bounds.centroids.Include(box.lower + box.upper, box.lower + box.upper);
  }
  return count;
}

struct Block {
  std::uint32_t first;  // box
  std::int64_t count;
  BlockBounds bounds;
};

// Makes the boxes of one kind at `boxes`; returns their number or -1.
template <typename Make>
std::int64_t FillKind(std::uint32_t n, PrimitiveBox* boxes, PrimitiveBoxes& result,
                      const Make& make) {
  std::vector<Block> blocks((n + kBlock - 1) / kBlock);
  oneapi::tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
    Block& block = blocks[i];
    block.first = static_cast<std::uint32_t>(i) * kBlock;
    block.count = FillBlock(block.first, std::min(kBlock, n - block.first), boxes + block.first,
                            block.bounds, make);
  });
  std::uint32_t total = 0;
  for (const Block& block : blocks) {
    if (block.count < 0) return -1;
    // Nothing moves in a scene where every primitive can be hit.
    if (total != block.first) {
      std::copy(boxes + block.first, boxes + block.first + block.count, boxes + total);
    }
    total += static_cast<std::uint32_t>(block.count);
    result.bounds.Include(block.bounds.boxes);
    result.centroids.Include(block.bounds.centroids);
    result.all.Include(block.bounds.all);
    result.others.Include(block.bounds.others);
  }
  return total;
}

Error InfiniteCoordinate(const char* kind) {
  return {ErrorKind::kUsage, std::string("a ") + kind + " has an infinite coordinate"};
}

}  // namespace

template <typename Real>
BoxState MakeBox(const GeometryView<Real>& geometry, std::uint32_t place, PrimitiveBox& box) {
  BoxState state = BoxState::kNever;
  ForEachKind(geometry, [&](const auto& arrays) {
    if (arrays.kKind == KindOf(place)) state = MakeBoxOf(arrays, IndexIn(place), box);
  });
  return state;
}

template <typename Real>
Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<Real>& geometry) {
  PrimitiveBoxes result;
  std::size_t most = 0;
  ForEachKind(geometry, [&](const auto& arrays) { most += arrays.count; });
  result.boxes = std::make_unique_for_overwrite<PrimitiveBox[]>(most);
  const char* infinite = nullptr;
  ForEachKind(geometry, [&](const auto& arrays) {
    if (infinite) return;
    const std::int64_t made =
        FillKind(arrays.count, result.boxes.get() + result.counts.total(), result,
                 [&](std::uint32_t i, PrimitiveBox& to) { return MakeBoxOf(arrays, i, to); });
    if (made < 0) infinite = arrays.kName;
    result.counts[arrays.kKind] = static_cast<std::uint32_t>(made);
  });
  if (infinite) return InfiniteCoordinate(infinite);
  return result;
}

PrimitiveBoxes MakeBoxes(std::uint32_t count,
                         const std::function<BoxState(std::uint32_t, PrimitiveBox&)>& make) {
  PrimitiveBoxes result;
  result.boxes = std::make_unique_for_overwrite<PrimitiveBox[]>(count);
  const std::int64_t made = FillKind(count, result.boxes.get(), result, make);
  result.counts[PrimitiveKind{}] = static_cast<std::uint32_t>(made);
  return result;
}

template BoxState MakeBox(const GeometryView<float>&, std::uint32_t, PrimitiveBox&);
template BoxState MakeBox(const GeometryView<double>&, std::uint32_t, PrimitiveBox&);
template Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<float>&);
template Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<double>&);

}  // namespace sheaf::bvh
