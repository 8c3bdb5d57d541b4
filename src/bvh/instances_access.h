// The inside of a public Instances, for those that trace it.
#ifndef SHEAF_BVH_INSTANCES_ACCESS_H_
#define SHEAF_BVH_INSTANCES_ACCESS_H_

#include <memory>
#include <vector>

#include "sheaf/instances.h"
#include "src/bvh/build_instances.h"

namespace sheaf {

template <typename Real>
struct InstancesOf<Real>::Data {
  std::vector<std::shared_ptr<const GeometryOf<Real>>> geometries;
  InstanceForest<Real> forest;  // over their trees
};

struct InstancesAccess {
  // A class of its own: clang 14 looks at an alias's access from where it is used.
  template <typename Real>
  struct DataType {
    using Type = typename InstancesOf<Real>::Data;
  };
  template <typename Real>
  using Data = typename DataType<Real>::Type;
  // Null: nothing to hit.
  template <typename Real>
  static const Data<Real>* DataOf(const InstancesOf<Real>& instances) {
    return instances.data_.get();
  }
};

static_assert(Instances::kNoInstance == kNoInstance);

}  // namespace sheaf

#endif  // SHEAF_BVH_INSTANCES_ACCESS_H_
