// What every traversal relies on, checked.
#ifndef SHEAF_BVH_VALIDATE_TREE_H_
#define SHEAF_BVH_VALIDATE_TREE_H_

#include <string>

#include "simd/tree.h"

namespace sheaf {

// "" where `tree` is a sound tree over `geometry`, else its first defect in one line. Sound: every
// primitive without NaN lies in exactly one leaf, with its very coordinates; boxes contain the
// boxes below them and the grown boxes of their primitives; references are in range and form a
// tree no deeper than kMaxTreeDepth; each order is a permutation with the absent children last.
// Ids are unique. Takes any tree whose arrays are as long as it says; does not recurse.
template <typename Real>
std::string FindTreeDefect(const TreeView<Real>& tree, const GeometryView<Real>& geometry);

}  // namespace sheaf

#endif  // SHEAF_BVH_VALIDATE_TREE_H_
