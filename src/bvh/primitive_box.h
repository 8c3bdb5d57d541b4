// The boxes that a tree is built over: one a primitive, in float, grown by kBoxGrowth.
#ifndef SHEAF_BVH_PRIMITIVE_BOX_H_
#define SHEAF_BVH_PRIMITIVE_BOX_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>

#include "sheaf/error.h"
#include "simd/tree.h"
#include "src/bvh/float4.h"
#include "src/bvh/primitive_rules.h"
#include "src/bvh/round_outward.h"

namespace sheaf::bvh {

// Box and primitive in 32 bytes. Bounds are finite and never -0, so that minima and maxima do not
// depend on the order in which they are taken; FLT_MAX stands for whatever lies beyond it, which
// no box test is asked about (kMaxBoxCoordinate).
struct alignas(16) PrimitiveBox {
  float lower[3];
  std::uint32_t tag;  // see MakeTag
  float upper[3];
  std::uint32_t unused;
};
static_assert(sizeof(PrimitiveBox) == 32);

// A primitive's place; tags order by kind, then by index. As lane 3 of a vector a tag is a normal
// float: sums of denormals are slow on some processors.
inline constexpr std::uint32_t kTagBase = 0x40000000u;
constexpr std::uint32_t MakeTag(PrimitiveKind kind, std::uint32_t index) {
  return kTagBase | MakePlace(kind, index);
}

inline Box4 BoxOf(const PrimitiveBox& box) { return {Load4(box.lower), Load4(box.upper)}; }

// Whether a box leaves the limits of box tests.
inline bool IsGiant(const PrimitiveBox& box) {
  bool is_giant = false;
  for (int axis = 0; axis < 3; ++axis) {
    is_giant |= -box.lower[axis] > kMaxBoxCoordinate || box.upper[axis] > kMaxBoxCoordinate;
  }
  return is_giant;
}

// The box that a giant has in the tree: all within the limits, where every ray is that box tests
// hold for. So each of them meets it, and the primitive costs what one primitive costs.
inline PrimitiveBox GiantBox(std::uint32_t tag) {
  constexpr float kMax = kMaxBoxCoordinate;
  return {{-kMax, -kMax, -kMax}, tag, {kMax, kMax, kMax}, 0};
}

// What contains lower to upper exactly, grown. Adding 0 turns -0 into 0.
inline void Grow(float lower, float upper, float& grown_lower, float& grown_upper) {
  constexpr float kMax = std::numeric_limits<float>::max();
  const double low = static_cast<double>(lower), high = static_cast<double>(upper);
  const double growth = static_cast<double>(kBoxGrowth) * (high - low);
  grown_lower = std::max(RoundDown(low - growth), -kMax) + 0.0f;
  grown_upper = std::min(RoundUp(high + growth), kMax) + 0.0f;
}

// The box of a primitive with these fields, all of them finite.
template <PrimitiveKind kKind, typename Real>
void MakeFiniteBox(const Real* fields, std::uint32_t tag, PrimitiveBox& box) {
  for (int axis = 0; axis < 3; ++axis) {
    float lower, upper;
    Rules<kKind>::ExactBounds(fields, axis, lower, upper);
    Grow(lower, upper, box.lower[axis], box.upper[axis]);
  }
  box.tag = tag;
  box.unused = 0;
}

enum class BoxState { kFinite, kNever, kInfinite };

// The box of the primitive at `place`. kNever: it has a NaN, kInfinite: an infinite coordinate;
// then `box` is left alone.
template <typename Real>
BoxState MakeBox(const GeometryView<Real>& geometry, std::uint32_t place, PrimitiveBox& box);

struct PrimitiveBoxes {
  std::unique_ptr<PrimitiveBox[]> boxes;
  PrimitiveCounts counts;  // that have a box; they lie kind by kind, in the order of the input
  Box4 bounds, centroids;  // of the boxes and of the sums lower + upper
  Box4 all;                // of the primitives, giants too as they are
  Box4 others;             // of the primitives but giants
};

// The boxes of all primitives without NaN, GiantBox for giants. Fails with kUsage where a
// coordinate is infinite. Runs on the threads of the caller's arena.
template <typename Real>
Result<PrimitiveBoxes> MakePrimitiveBoxes(const GeometryView<Real>& geometry);

// The same of `count` things of the first kind, whose boxes make(index, box) makes, kInfinite for
// none of them.
PrimitiveBoxes MakeBoxes(std::uint32_t count,
                         const std::function<BoxState(std::uint32_t, PrimitiveBox&)>& make);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_PRIMITIVE_BOX_H_
