// Geometries that stand in many places: the maps into them, and the tree over where they stand.
#ifndef SHEAF_SIMD_INSTANCES_H_
#define SHEAF_SIMD_INSTANCES_H_

#include <cstdint>

#include "simd/query.h"
#include "simd/tree.h"

namespace sheaf {

// An affine map: row k gives coordinate k, as ((a x + b y) + c z) + d.
struct AffineMap {
  double row[3][4];
};

// Boxes of instances give way by this part of a ray's reach, times InstanceTree::condition: a ray's
// way into an object and back errs by less, whatever the map (docs/numerics.md).
inline constexpr double kInstanceSlack = 0x1p-20;

// A ray whose direction in an object is shorter misses it: its components would have lost digits.
template <typename Real>
inline constexpr Real kMinMappedDirection = sizeof(Real) == 4 ? Real(0x1p-100) : Real(0x1p-900);

// A tree as TreeView has it, whose leaves are single instances: LeafFirst is the number of one.
template <typename Real>
struct InstanceTree {
  const TreeNode* nodes;        // the root first
  std::uint32_t node_count;     // 0: nothing to hit
  float lower[3], upper[3];     // of all boxes but giants'; lower > upper without any
  float condition;              // the largest of all maps': of |M| |M^-1|, the largest sum of a row
  std::uint32_t count;          // of instances
  const AffineMap* to_object;   // by instance: from the world to the object
  const std::uint32_t* object;  // by instance: position in `trees`
  const TreeView<Real>* trees;  // of the objects
};

// The hits of a batch of rays. Before: nearest hits so far, or kNoPrimitive and t_max; then with
// those of instances that are nearer. Of equal t the lowest instance wins, and kNoInstance before
// all of them.
template <typename Real>
struct InstanceHits {
  Real *t, *u, *v;
  std::uint32_t *primitive, *instance;
};

// Whether a hit that is no later than the nearest so far takes its place.
template <typename Real>
constexpr bool TakesOver(Real t, std::uint32_t instance, Real best_t, std::uint32_t best_primitive,
                         std::uint32_t best_instance) {
  // One more makes 0 of kNoInstance.
  return best_primitive == kNoPrimitive || t < best_t || instance + 1 < best_instance + 1;
}

}  // namespace sheaf

#endif  // SHEAF_SIMD_INSTANCES_H_
