#include "src/bvh/primitive_box.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace sheaf::bvh {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();
constexpr std::uint32_t kBlock = 4096;  // primitives a task; the result does not depend on it

// Rounds down without a branch: half of all roundings would go the wrong way.
float RoundDown(double x) {
  const float f = static_cast<float>(x);
  // As integers that order as floats do; what is above x is no +0, whose neighbour is -0.
  std::int32_t bits = std::bit_cast<std::int32_t>(f);
  bits ^= (bits >> 31) & 0x7fffffff;
  bits -= static_cast<std::int32_t>(static_cast<double>(f) > x);
  bits ^= (bits >> 31) & 0x7fffffff;
  return std::bit_cast<float>(bits);
}
float RoundUp(double x) { return -RoundDown(-x); }

// a + b, rounded up to double: the rounding error of a sum is a double (Knuth's TwoSum).
double SumUp(double a, double b) {
  const double sum = a + b, part = sum - a;
  const double error = (a - (sum - part)) + (b - part);
  return error > 0 ? std::nextafter(sum, std::numeric_limits<double>::infinity())
                   : sum;  // false for the NaN of an infinite sum
}

// Stores what contains the primitive exactly, grown. Adding 0 turns -0 into 0.
void StoreGrown(const float (&lower)[3], const float (&upper)[3], std::uint32_t tag,
                PrimitiveBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = static_cast<double>(lower[axis]), high = static_cast<double>(upper[axis]);
    const double growth = static_cast<double>(kBoxGrowth) * (high - low);
    box.lower[axis] = std::max(RoundDown(low - growth), -kMax) + 0.0f;
    box.upper[axis] = std::min(RoundUp(high + growth), kMax) + 0.0f;
  }
  box.tag = tag;
  box.unused = 0;
}

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

// Fills boxes[0, n) of the primitives [first, first + n) without gaps; returns how many there are,
// or -1 where a coordinate is infinite.
template <typename Make>
std::int64_t FillBlock(std::uint32_t first, std::uint32_t n, PrimitiveBox* boxes, Box4& bounds,
                       Box4& centroids, const Make& make) {
  std::uint32_t count = 0;
  for (std::uint32_t i = first; i < first + n; ++i) {
    const BoxState state = make(i, boxes[count]);
    if (state == BoxState::kInfinite) return -1;
    if (state == BoxState::kNever) continue;
    const Box4 box = BoxOf(boxes[count++]);
    bounds.Include(box);
    centroids.Include(box.lower + box.upper, box.lower + box.upper);
  }
  return count;
}

struct Block {
  std::uint32_t first;  // box
  std::int64_t count;
  Box4 bounds, centroids;
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
                            block.bounds, block.centroids, make);
  });
  std::uint32_t total = 0;
  for (const Block& block : blocks) {
    if (block.count < 0) return -1;
    // Nothing moves in a scene where every primitive can be hit.
    if (total != block.first) {
      std::copy(boxes + block.first, boxes + block.first + block.count, boxes + total);
    }
    total += static_cast<std::uint32_t>(block.count);
    result.bounds.Include(block.bounds);
    result.centroids.Include(block.centroids);
  }
  return total;
}

Error InfiniteCoordinate(const char* kind) {
  return {ErrorKind::kUsage, std::string("a ") + kind + " has an infinite coordinate"};
}

}  // namespace

template <typename Real>
BoxState MakeTriangleBox(const TriangleArrays<Real>& triangles, std::uint32_t index,
                         PrimitiveBox& box) {
  Real values[9];
  for (int i = 0; i < 9; ++i) values[i] = triangles.vertex[i / 3][i % 3][index];
  if (const BoxState state = StateOf(values, 9); state != BoxState::kFinite) return state;
  float lower[3], upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Real a = values[axis], b = values[3 + axis], c = values[6 + axis];
    lower[axis] = RoundDown(static_cast<double>(std::min(std::min(a, b), c)));
    upper[axis] = RoundUp(static_cast<double>(std::max(std::max(a, b), c)));
  }
  StoreGrown(lower, upper, MakeTag(0, index), box);
  return BoxState::kFinite;
}

template <typename Real>
BoxState MakeSphereBox(const SphereArrays<Real>& spheres, std::uint32_t index, PrimitiveBox& box) {
  const Real values[4] = {spheres.center_x[index], spheres.center_y[index], spheres.center_z[index],
                          spheres.radius[index]};
  if (const BoxState state = StateOf(values, 4); state != BoxState::kFinite) return state;
  const double radius = std::abs(static_cast<double>(values[3]));
  float lower[3], upper[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double center = static_cast<double>(values[axis]);
    lower[axis] = RoundDown(-SumUp(-center, radius));
    upper[axis] = RoundUp(SumUp(center, radius));
  }
  StoreGrown(lower, upper, MakeTag(kSphereTag, index), box);
  return BoxState::kFinite;
}

template <typename Real>
Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<Real>& geometry) {
  const SphereArrays<Real>& spheres = geometry.spheres;  // clang 14 captures no structured binding
  const TriangleArrays<Real>& triangles = geometry.triangles;
  PrimitiveBoxes result;
  result.boxes =
      std::make_unique_for_overwrite<PrimitiveBox[]>(std::size_t{triangles.count} + spheres.count);
  const std::int64_t triangle_boxes = FillKind(
      triangles.count, result.boxes.get(), result,
      [&](std::uint32_t i, PrimitiveBox& to) { return MakeTriangleBox(triangles, i, to); });
  if (triangle_boxes < 0) return InfiniteCoordinate("triangle");
  const std::int64_t sphere_boxes =
      FillKind(spheres.count, result.boxes.get() + triangle_boxes, result,
               [&](std::uint32_t i, PrimitiveBox& to) { return MakeSphereBox(spheres, i, to); });
  if (sphere_boxes < 0) return InfiniteCoordinate("sphere");
  result.triangles = static_cast<std::uint32_t>(triangle_boxes);
  result.spheres = static_cast<std::uint32_t>(sphere_boxes);
  return result;
}

template BoxState MakeTriangleBox(const TriangleArrays<float>&, std::uint32_t, PrimitiveBox&);
template BoxState MakeTriangleBox(const TriangleArrays<double>&, std::uint32_t, PrimitiveBox&);
template BoxState MakeSphereBox(const SphereArrays<float>&, std::uint32_t, PrimitiveBox&);
template BoxState MakeSphereBox(const SphereArrays<double>&, std::uint32_t, PrimitiveBox&);
template Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<float>&);
template Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<double>&);

}  // namespace sheaf::bvh
