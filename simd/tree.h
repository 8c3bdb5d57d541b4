// The tree over primitives of all kinds, as a plain view.
#ifndef SHEAF_SIMD_TREE_H_
#define SHEAF_SIMD_TREE_H_

#include <cstddef>
#include <cstdint>

#include "simd/primitives.h"
#include "simd/streams.h"

namespace sheaf {

// A bounding volume hierarchy of eight children a node over all kinds together. A child is an inner
// node or a leaf of one kind of primitive, so that the kind is asked once a leaf.

inline constexpr std::uint32_t kTreeWidth = 8;
inline constexpr std::uint32_t kMaxLeafSize = 8;
// Levels of nodes at most, the root's included, whatever the scene: a traversal's stack is an
// array. A depth-first walk leaves at most seven children a level behind.
inline constexpr std::uint32_t kMaxTreeDepth = 26;
inline constexpr std::uint32_t kTreeStackSize = kMaxTreeDepth * (kTreeWidth - 1) + 1;

// A child: the index of a node, or a leaf: kLeafBit, its kind, its size less one (three bits) and
// its first position in the kind's blocks. kNoChild is a leaf to no one: its box is empty, and no
// block has a position so high.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;
inline constexpr std::uint32_t kLeafKindShift = kIndexBits + 3;
inline constexpr std::uint32_t kNoChild = 0xffffffffu;
static_assert((kLeafBit >> kLeafKindShift) == kKindMask + 1);
constexpr std::uint32_t MakeLeaf(PrimitiveKind kind, std::uint32_t first, std::uint32_t count) {
  return kLeafBit | static_cast<std::uint32_t>(kind) << kLeafKindShift | (count - 1) << kIndexBits |
         first;
}
constexpr bool IsLeaf(std::uint32_t child) { return (child & kLeafBit) != 0; }
constexpr PrimitiveKind LeafKind(std::uint32_t child) {
  return static_cast<PrimitiveKind>(child >> kLeafKindShift & kKindMask);
}
constexpr std::uint32_t LeafFirst(std::uint32_t child) { return child & (kMaxTreePrimitives - 1); }
constexpr std::uint32_t LeafCount(std::uint32_t child) { return (child >> kIndexBits & 7u) + 1; }

// Four cache lines. An absent child has lower = +max and upper = -max: no ray meets it.
struct alignas(kAlignment) TreeNode {
  float bounds[6][kTreeWidth];  // lower x, y, z, upper x, y, z of each child
  std::uint32_t child[kTreeWidth];
  // By the signs of a direction (bit k: axis k is negative): the children from front to back, four
  // bits each, the first in the lowest.
  std::uint32_t order[8];
};
static_assert(sizeof(TreeNode) == 256);

// Boxes of primitives are grown by this part of their extent on each side before they enter the
// tree, and box tests by as much relatively (docs/numerics.md): the box of a primitive then
// contains every hit of it as computed, not only as real.
inline constexpr float kBoxGrowth = 0x1p-20f;

// Box tests hold for rays and trees within these limits. No product of a box test then overflows,
// nor does one lose its bits.
inline constexpr float kMaxBoxCoordinate = 0x1p39f;  // of origins and of boxes
inline constexpr float kMinBoxDirection = 0x1p-67f;  // of a direction's largest component
inline constexpr float kMaxBoxDirection = 0x1p67f;
// Rays with other directions, or with t_min < 0, take them in double, one by one. All that is in
// float is within these limits; a direction in double may be beyond them. A ray like that, or from
// further away than kMaxBoxCoordinate, is tested against every primitive.
inline constexpr double kMinWideDirection = 0x1p-149;
inline constexpr double kMaxWideDirection = 0x1p128;
// A direction's components are taken for at least this part of the largest, so that none is zero;
// the box then gives way by twice as much of the ray's reach.
inline constexpr float kMinBoxSlope = 0x1p-20f;
// A box gives way by this part of the origin's coordinates, and a little for origins near zero.
inline constexpr float kBoxOriginSlack = 0x1p-22f;
inline constexpr float kBoxAbsoluteSlack = 0x1p-70f;
// The far side of an interval moves out by this factor. Twice kBoxGrowth, for both sides.
inline constexpr float kBoxFarFactor = 1 + 2 * kBoxGrowth;

// The primitives of one kind, leaf by leaf. A leaf of n of them that begins at position `first`
// holds n numbers of each field in turn, from `field count` * first on: triangles vertex 0 x, y, z,
// vertex 1 x, ..., spheres center x, y, z, radius. Leaves lie without gaps; a whole vector may be
// read at the last field.
template <typename Real>
struct BlockView {
  const Real* fields;
  const std::uint32_t* id;  // primitive id by position
  std::uint32_t count;
};

template <typename Real>
struct TreeView {
  const TreeNode* nodes;     // the root first
  std::uint32_t node_count;  // 0: no primitives
  BlockView<Real> blocks[kKindCount];
  float lower[3], upper[3];  // of all boxes but giants' (GiantBox); lower > upper without any
  bool skips_boxes;  // so few primitives that box tests pay for frusta only; set without nodes too

  const BlockView<Real>& of(PrimitiveKind kind) const { return blocks[IndexOf(kind)]; }
  std::uint32_t primitive_count() const {
    std::uint32_t count = 0;
    for (const BlockView<Real>& block : blocks) count += block.count;
    return count;
  }
};

// Shows a leaf's block as arrays of its kind.
template <typename Real, typename Arrays>
constexpr void ShowLeaf(const TreeView<Real>& tree, std::uint32_t leaf, Arrays& arrays) {
  const BlockView<Real>& block = tree.of(Arrays::kKind);
  const std::uint32_t first = LeafFirst(leaf), n = LeafCount(leaf);
  const Real* next = block.fields + std::size_t{Arrays::kFieldCount} * first;
  Arrays::ForEachField(arrays, [&](const Real*& field) {
    field = next;
    next += n;
  });
  arrays.count = n;
  arrays.id = block.id + first;
}

}  // namespace sheaf

#endif  // SHEAF_SIMD_TREE_H_
