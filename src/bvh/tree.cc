#include "src/bvh/tree.h"

namespace sheaf {
namespace {

template <typename T>
std::size_t Bytes(const AlignedArray<T>& array) {
  return array.size() * sizeof(T);
}

}  // namespace

template <typename Real>
TreeView<Real> Tree<Real>::view() const {
  return {nodes.data(),
          node_count,
          triangle_count,
          sphere_count,
          triangles.data(),
          spheres.data(),
          triangle_id.data(),
          sphere_id.data(),
          {lower[0], lower[1], lower[2]},
          {upper[0], upper[1], upper[2]},
          node_count <= 1};
}

template <typename Real>
std::size_t Tree<Real>::bytes() const {
  return Bytes(nodes) + Bytes(triangles) + Bytes(spheres) + Bytes(triangle_id) + Bytes(sphere_id);
}

template struct Tree<float>;
template struct Tree<double>;

}  // namespace sheaf
