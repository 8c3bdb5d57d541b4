// Moves the primitives of a range to the sides of a split.
#ifndef SHEAF_BVH_PARTITION_RANGE_H_
#define SHEAF_BVH_PARTITION_RANGE_H_

#include "src/bvh/find_split.h"
#include "src/bvh/primitive_box.h"

namespace sheaf::bvh {

struct Halves {
  Range left, right;  // never empty
};

// Reorders boxes[range.begin, range.end), in place. Large ranges use all threads of the caller's
// arena; the order is the same.
Halves PartitionRange(PrimitiveBox* boxes, const Range& range, const Split& split);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_PARTITION_RANGE_H_
