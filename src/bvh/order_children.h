// The order in which a ray meets the children of a node.
#ifndef SHEAF_BVH_ORDER_CHILDREN_H_
#define SHEAF_BVH_ORDER_CHILDREN_H_

#include "simd/tree.h"

namespace sheaf::bvh {

// Fills node.order from node.bounds: by the boxes' centers along each octant's diagonal, equal ones
// and absent children (from `count` on) by position.
void OrderChildren(TreeNode& node, std::uint32_t count);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_ORDER_CHILDREN_H_
