// The tree over places where geometries stand.
#ifndef SHEAF_BVH_BUILD_INSTANCES_H_
#define SHEAF_BVH_BUILD_INSTANCES_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sheaf/error.h"
#include "simd/instances.h"
#include "src/core/aligned_array.h"

namespace sheaf {

// Where an object stands: to the world, with the object's position among the trees.
struct PlacedObject {
  AffineMap to_world;
  std::uint32_t object;
};

// The owning arrays behind an InstanceTree.
template <typename Real>
struct InstanceForest {
  AlignedArray<TreeNode> nodes;
  std::uint32_t node_count = 0;
  float lower[3], upper[3];          // see InstanceTree
  float all_lower[3], all_upper[3];  // giants too
  float condition = 1;
  std::vector<AffineMap> to_object;  // by instance
  std::vector<std::uint32_t> object;
  std::vector<TreeView<Real>> trees;

  InstanceTree<Real> view() const;
  std::size_t bytes() const;
};

// Maps have no fault, objects are positions in `trees`. A function of its arguments alone, but not
// of `threads` (0: one a core). What trees point at must outlive the forest.
template <typename Real>
InstanceForest<Real> BuildInstances(std::span<const PlacedObject> places,
                                    std::vector<TreeView<Real>> trees, int threads = 0);

}  // namespace sheaf

#endif  // SHEAF_BVH_BUILD_INSTANCES_H_
