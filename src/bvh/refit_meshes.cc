#include "src/bvh/refit_meshes.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iterator>
#include <limits>

#include "src/bvh/primitive_box.h"
#include "src/bvh/refit_nodes.h"
#include "src/core/has_area.h"

namespace sheaf::bvh {
namespace {

constexpr std::size_t kNumbersATask = 1 << 16;
// Coordinates below this are scaled by nothing, and their grown boxes are no giants'.
constexpr float kModerate = 0x1p38f;
constexpr float kCertainArea = 0x1p-90f;  // scales nothing either, computed in float
constexpr double kLeastArea = 0x1p-100;   // likewise, in double
constexpr float kCertainPart = 0x1p-20f;  // of the products: far more than float rounds away

// Whether all lanes of are_sound hold of four numbers at a time, whatever their type. The last four
// may be looked at twice; of fewer than four the first stands for those that are missing.
template <typename Number, typename AreSound>
bool AllSound(std::span<const Number> numbers, const AreSound& are_sound) {
  static_assert(sizeof(Number) == sizeof(float));
  const auto load = [&](std::size_t i) {
    Float4 v;
    std::memcpy(&v, numbers.data() + i, sizeof(v));
    return v;
  };
  const std::size_t count = numbers.size();
  if (count < 4) {
    Number few[4] = {numbers[0], numbers[0], numbers[0], numbers[0]};
    std::copy(numbers.begin(), numbers.end(), few);
    return AllSound(std::span<const Number>(few), are_sound);
  }
  std::atomic<bool> all = true;
  oneapi::tbb::parallel_for(std::size_t{0}, (count + kNumbersATask - 1) / kNumbersATask,
                            [&](std::size_t task) {
                              std::size_t i = task * kNumbersATask;
                              const std::size_t end = std::min(i + kNumbersATask, count);
                              Int4 sound = are_sound(load(end - 4));
                              for (; i + 4 <= end; i += 4) sound &= are_sound(load(i));
                              if (!(sound[0] & sound[1] & sound[2] & sound[3])) all = false;
                            });
  return all;
}

Float4 Rotated(Float4 v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
Float4 Magnitude(Float4 v) { return Max(v, -v); }

// A vertex and, where there is one, the number after it.
Float4 VertexAt(std::span<const float> numbers, std::size_t first) {
  const float* const from = numbers.data() + first;
  return first + 4 <= numbers.size() ? Load4(from) : Float4{from[0], from[1], from[2], 0};
}

// Whether rays can hit the triangle as it is. True where in doubt would be the exception.
bool HasPlainArea(const Float4 (&vertex)[3]) {
  const Float4 a = vertex[1] - vertex[0], b = vertex[2] - vertex[0];
  const Float4 one = a * Rotated(b), other = Rotated(a) * b;
  const Float4 area = Magnitude(one - other);
  const Float4 least = Max((Magnitude(one) + Magnitude(other)) * kCertainPart, Set4(kCertainArea));
  const Int4 is_certain = area > least;
  if (is_certain[0] | is_certain[1] | is_certain[2]) return true;
  double exact[3][3];
  for (int k = 0; k < 3; ++k) {
    for (int axis = 0; axis < 3; ++axis) exact[k][axis] = static_cast<double>(vertex[k][axis]);
  }
  return HasArea(exact) && LargestArea(exact) >= kLeastArea;
}

Box4 Grown(const Box4& box) {
  float lower[4] = {}, upper[4] = {};
  for (int axis = 0; axis < 3; ++axis) {
    Grow(box.lower[axis], box.upper[axis], lower[axis], upper[axis]);
  }
  return {.lower = Load4(lower), .upper = Load4(upper)};
}

Box4 BoxAround(const Float4 (&vertex)[3]) {
  Box4 box;
  for (const Float4 v : vertex) box.Include(v, v);
  return box;
}

// Whether no triangle takes a closer look.
struct Plainness {
  bool is_plain = true;

  void Include(const Plainness& more) { is_plain &= more.is_plain; }
};

class MeshLeaves {
 public:
  MeshLeaves(const std::vector<FloatMesh>& meshes, Tree<float>& tree)
      : meshes_(meshes), blocks_(tree.of(PrimitiveKind::kTriangle)) {}

  // Writes a leaf's triangles; returns the box around them.
  Box4 Refit(std::uint32_t leaf, Plainness& found) {
    const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
    float* const to = blocks_.fields.data() + std::size_t{9} * first;
    Box4 bounds;
    for (std::uint32_t i = 0; i < count; ++i) {
      Float4 vertex[3];
      Load(blocks_.id.data()[first + i], vertex);
      found.is_plain &= HasPlainArea(vertex);
      for (std::uint32_t k = 0; k < 3; ++k) {
        bounds.Include(vertex[k], vertex[k]);
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          to[(3 * k + axis) * count + i] = vertex[k][axis];
        }
      }
    }
    return Grown(bounds);
  }

  // Around a leaf's triangles, each of them grown.
  Box4 ExactBox(std::uint32_t leaf) const {
    Box4 box;
    for (std::uint32_t i = 0; i < LeafCount(leaf); ++i) {
      Float4 vertex[3];
      Load(blocks_.id.data()[LeafFirst(leaf) + i], vertex);
      box.Include(Grown(BoxAround(vertex)));
    }
    return box;
  }

 private:
  void Load(std::uint32_t id, Float4 (&vertex)[3]) const {
    const FloatMesh* mesh = meshes_.data();
    if (meshes_.size() > 1) {
      mesh = &*std::prev(
          std::upper_bound(meshes_.begin(), meshes_.end(), id,
                           [](std::uint32_t i, const FloatMesh& one) { return i < one.first; }));
    }
    const std::uint32_t* const index = mesh->indices.data() + std::size_t{3} * (id - mesh->first);
    for (int k = 0; k < 3; ++k) {
      vertex[k] = VertexAt(mesh->vertices, std::size_t{3} * index[k]);
    }
  }

  const std::vector<FloatMesh>& meshes_;
  PrimitiveBlocks<float>& blocks_;
};

// What triangles reach along one axis, each of them grown: of leaves' boxes, which may be larger,
// only those are looked into that could reach further.
class ReachFinder {
 public:
  ReachFinder(const Tree<float>& tree, const MeshLeaves& leaves)
      : nodes_(tree.nodes.data()), leaves_(leaves) {}

  // The lowest of bound `row` of the nodes: below 3 a lower one, else an upper one times -1.
  float Lowest(int row) const {
    float best = std::numeric_limits<float>::infinity();
    Look(0, row, best);
    return best;
  }

 private:
  void Look(std::uint32_t index, int row, float& best) const {
    const TreeNode& node = nodes_[index];
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      const float bound = node.bounds[row][slot];
      const std::uint32_t child = node.child[slot];
      if (child == kNoChild || !((row < 3 ? bound : -bound) < best)) continue;
      if (!IsLeaf(child)) {
        Look(child, row, best);
        continue;
      }
      const Box4 box = leaves_.ExactBox(child);
      best = std::min(best, row < 3 ? box.lower[row] : -box.upper[row - 3]);
    }
  }

  const TreeNode* nodes_;
  const MeshLeaves& leaves_;
};

}  // namespace

bool AreModerate(const std::vector<FloatMesh>& meshes) {
  return std::all_of(meshes.begin(), meshes.end(), [](const FloatMesh& mesh) {
    const auto below = static_cast<std::int32_t>(
        std::min<std::size_t>(mesh.vertices.size() / 3, std::numeric_limits<std::int32_t>::max()));
    const bool has_numbers = AllSound(mesh.vertices, [](Float4 v) {
      return Int4{v > Set4(-kModerate)} & Int4{v < Set4(kModerate)};
    });
    return has_numbers && AllSound(mesh.indices, [&](Float4 v) {
             Int4 index;
             std::memcpy(&index, &v, sizeof(index));
             return Int4{index >= Int4{}} & Int4{index < Int4{below, below, below, below}};
           });
  });
}

bool RefitMeshes(const std::vector<FloatMesh>& meshes, Tree<float>& tree) {
  MeshLeaves leaves(meshes, tree);
  const auto fit_leaf = [&](std::uint32_t leaf, Plainness& found) {
    return leaves.Refit(leaf, found);
  };
  Plainness whole;
  RefitNodes(tree.node_count, tree.nodes.data(), fit_leaf, whole);
  if (!whole.is_plain) return false;
  Box4 all;
  const ReachFinder reach(tree, leaves);
  for (int axis = 0; axis < 3; ++axis) {
    all.lower[axis] = reach.Lowest(axis);
    all.upper[axis] = -reach.Lowest(3 + axis);
  }
  tree.SetBounds(all, all);
  return true;
}

}  // namespace sheaf::bvh
