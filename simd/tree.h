// Primitives as arrays and the tree over them, as plain views.
#ifndef SHEAF_SIMD_TREE_H_
#define SHEAF_SIMD_TREE_H_

#include <cstddef>
#include <cstdint>

#include "simd/streams.h"

namespace sheaf {

template <typename Real>
struct SphereArrays {
  std::uint32_t count;
  const Real *center_x, *center_y, *center_z;
  const Real* radius;  // NaN: never hit (stands for radius 0)
  const std::uint32_t* id;
};

template <typename Real>
struct TriangleArrays {
  std::uint32_t count;
  const Real* vertex[3][3];  // [vertex][axis]; NaN: never hit (stands for zero area)
  const Real* uv[3][2];      // [vertex][u or v]; null where no material asks for coordinates
  // Null where no mesh has them. A normal of 0, or a mean of 0, stands for the face's own; a colour
  // of 1 for none. Normals have any length and either side.
  const Real* normal[3][3];  // [vertex][axis]
  const Real* colour[3][3];  // [vertex][channel]
  const std::uint32_t* id;
};

// Spheres and triangles share one range of ids.
template <typename Real>
struct GeometryView {
  SphereArrays<Real> spheres;
  TriangleArrays<Real> triangles;
};

// ---- The tree ----
// A bounding volume hierarchy of eight children a node over spheres and triangles together. A child
// is an inner node or a leaf of one kind of primitive, so that the kind is asked once a leaf.

inline constexpr std::uint32_t kTreeWidth = 8;
inline constexpr std::uint32_t kMaxLeafSize = 8;
inline constexpr std::uint32_t kMaxTreePrimitives = 1u << 26;  // of each kind
// Levels of nodes at most, the root's included, whatever the scene: a traversal's stack is an
// array. A depth-first walk leaves at most seven children a level behind.
inline constexpr std::uint32_t kMaxTreeDepth = 48;
inline constexpr std::uint32_t kTreeStackSize = kMaxTreeDepth * (kTreeWidth - 1) + 1;

// A child: the index of a node, or a leaf as its kind, size and first position in the kind's
// blocks. kNoChild is a leaf to no one: its box is empty.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;
inline constexpr std::uint32_t kTriangleLeafBit = 0x40000000u;
inline constexpr std::uint32_t kNoChild = 0xffffffffu;
constexpr std::uint32_t MakeLeaf(std::uint32_t kind_bit, std::uint32_t first, std::uint32_t count) {
  return kLeafBit | kind_bit | (count - 1) << 26 | first;
}
constexpr bool IsLeaf(std::uint32_t child) { return (child & kLeafBit) != 0; }
constexpr bool IsTriangleLeaf(std::uint32_t child) { return (child & kTriangleLeafBit) != 0; }
constexpr std::uint32_t LeafFirst(std::uint32_t child) { return child & (kMaxTreePrimitives - 1); }
constexpr std::uint32_t LeafCount(std::uint32_t child) { return (child >> 26 & 7u) + 1; }

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

// Box tests hold for rays and trees within these limits; other rays are tested against every
// primitive. No product of a box test then overflows, nor does one lose its bits.
inline constexpr float kMaxBoxCoordinate = 0x1p39f;  // of origins and of the tree's bounds
inline constexpr float kMinBoxDirection = 0x1p-67f;  // of a direction's largest component
inline constexpr float kMaxBoxDirection = 0x1p67f;
// A direction's components are taken for at least this part of the largest, so that none is zero;
// the box then gives way by twice as much of the ray's reach.
inline constexpr float kMinBoxSlope = 0x1p-20f;
// A box gives way by this part of the origin's coordinates, and a little for origins near zero.
inline constexpr float kBoxOriginSlack = 0x1p-22f;
inline constexpr float kBoxAbsoluteSlack = 0x1p-70f;
// The far side of an interval moves out by this factor. Twice kBoxGrowth, for both sides.
inline constexpr float kBoxFarFactor = 1 + 2 * kBoxGrowth;

// A leaf block of n primitives that begins at position `first` holds n numbers of each field in
// turn: triangles from 9 * first (vertex 0 x, y, z, vertex 1 x, ...), spheres from 4 * first
// (center x, y, z, radius). Blocks lie without gaps; a whole vector may be read at the last field.
template <typename Real>
struct TreeView {
  const TreeNode* nodes;     // the root first
  std::uint32_t node_count;  // 0: no primitives
  std::uint32_t triangle_count, sphere_count;
  const Real* triangles;
  const Real* spheres;
  const std::uint32_t* triangle_id;  // primitive id by position
  const std::uint32_t* sphere_id;
  float lower[3], upper[3];  // of all boxes; lower > upper without primitives
  bool skips_boxes;  // so few primitives that boxes pay for tiles alone; set where there is no node
};

// Whether box tests hold for the tree.
template <typename Real>
constexpr bool IsWithinBoxLimits(const TreeView<Real>& tree) {
  bool is_within = true;
  for (int axis = 0; axis < 3; ++axis) {
    is_within &= -tree.lower[axis] <= kMaxBoxCoordinate && tree.upper[axis] <= kMaxBoxCoordinate;
  }
  return is_within;
}

}  // namespace sheaf

#endif  // SHEAF_SIMD_TREE_H_
