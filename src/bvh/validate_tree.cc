#include "src/bvh/validate_tree.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

#include "src/bvh/primitive_box.h"

namespace sheaf {
namespace {

using bvh::BoxState;
using bvh::PrimitiveBox;

struct Bounds {
  float lower[3], upper[3];

  // False for a NaN.
  bool Contains(const float* low, const float* high) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (!(lower[axis] <= low[axis] && high[axis] <= upper[axis])) return false;
    }
    return true;
  }
};

Bounds BoundsOf(const TreeNode& node, std::uint32_t slot) {
  Bounds bounds;
  for (int axis = 0; axis < 3; ++axis) {
    bounds.lower[axis] = node.bounds[axis][slot];
    bounds.upper[axis] = node.bounds[3 + axis][slot];
  }
  return bounds;
}

std::string At(std::uint32_t node, std::uint32_t slot) {
  return "node " + std::to_string(node) + ", child " + std::to_string(slot) + ": ";
}

// The primitives of one kind as the tree and as the input have them.
template <typename Real>
struct Primitives {
  PrimitiveKind kind;
  const char* name;
  std::uint32_t field_count;
  const Real* fields[kMaxFields];
  const std::uint32_t* input_id;
  std::uint32_t input_count;
  BlockView<Real> blocks;

  std::vector<std::uint32_t> by_id;   // positions in the input, sorted by id
  std::vector<std::uint8_t> is_used;  // by position in the input

  void Prepare() {
    by_id.resize(input_count);
    for (std::uint32_t i = 0; i < input_count; ++i) by_id[i] = i;
    std::sort(by_id.begin(), by_id.end(),
              [&](std::uint32_t a, std::uint32_t b) { return input_id[a] < input_id[b]; });
    is_used.assign(input_count, 0);
  }

  // Position in the input of a primitive id, or input_count.
  std::uint32_t Find(std::uint32_t primitive) const {
    const auto found = std::lower_bound(
        by_id.begin(), by_id.end(), primitive,
        [&](std::uint32_t position, std::uint32_t value) { return input_id[position] < value; });
    if (found == by_id.end() || input_id[*found] != primitive) return input_count;
    return *found;
  }
};

template <typename Real>
class Validator {
 public:
  Validator(const TreeView<Real>& tree, const GeometryView<Real>& geometry)
      : tree_(tree), geometry_(geometry) {
    ForEachKind(geometry, [&](const auto& arrays) {
      Primitives<Real>& kind = kinds_[IndexOf(arrays.kKind)];
      kind.kind = arrays.kKind;
      kind.name = arrays.kName;
      arrays.ForEachField(arrays,
                          [&](const Real* field) { kind.fields[kind.field_count++] = field; });
      kind.input_id = arrays.id;
      kind.input_count = arrays.count;
      kind.blocks = tree.of(arrays.kKind);
      kind.Prepare();
    });
  }

  std::string FindDefect() {
    if (tree_.node_count > 0) {
      level_.assign(tree_.node_count, 0);
      level_[0] = 1;
      pending_.push_back(0);
    }
    while (!pending_.empty()) {
      const std::uint32_t node = pending_.back();
      pending_.pop_back();
      if (std::string defect = CheckNode(node); !defect.empty()) return defect;
    }
    for (std::uint32_t i = 0; i < tree_.node_count; ++i) {
      if (level_[i] == 0) return "node " + std::to_string(i) + " is no node's child";
    }
    for (const Primitives<Real>& kind : kinds_) {
      if (std::string defect = CheckComplete(kind); !defect.empty()) return defect;
    }
    return "";
  }

 private:
  std::string CheckNode(std::uint32_t index) {
    const TreeNode& node = tree_.nodes[index];
    if (std::string defect = CheckOrder(index); !defect.empty()) return defect;
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      const std::uint32_t child = node.child[slot];
      const Bounds bounds = BoundsOf(node, slot);
      if (child == kNoChild) {
        constexpr float kMax = std::numeric_limits<float>::max();
        const float low[3] = {kMax, kMax, kMax}, high[3] = {-kMax, -kMax, -kMax};
        if (std::memcmp(bounds.lower, low, sizeof(low)) != 0 ||
            std::memcmp(bounds.upper, high, sizeof(high)) != 0) {
          return At(index, slot) + "an absent child has a box";
        }
        continue;
      }
      const Bounds whole = {{tree_.lower[0], tree_.lower[1], tree_.lower[2]},
                            {tree_.upper[0], tree_.upper[1], tree_.upper[2]}};
      // A box that holds a giant is as large as boxes can be.
      const bool has_giant = bounds.upper[0] == kMaxBoxCoordinate;
      if (index == 0 && !has_giant && !whole.Contains(bounds.lower, bounds.upper)) {
        return At(index, slot) + "the box leaves the tree's";
      }
      std::string defect =
          IsLeaf(child) ? CheckLeaf(child, bounds) : CheckInner(index, child, bounds);
      if (!defect.empty()) return At(index, slot) + defect;
    }
    return "";
  }

  std::string CheckOrder(std::uint32_t index) const {
    const TreeNode& node = tree_.nodes[index];
    for (const std::uint32_t order : node.order) {
      std::uint32_t seen = 0;
      const char* defect = nullptr;
      for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
        const std::uint32_t slot = order >> (4 * i) & 15u;
        if (slot >= kTreeWidth || (seen >> slot & 1)) {
          defect = " has an order that is no permutation";
          break;
        }
        seen |= 1u << slot;
        const std::uint32_t before = i == 0 ? slot : order >> (4 * i - 4) & 15u;
        if (node.child[slot] != kNoChild && node.child[before] == kNoChild) {
          defect = " has an order with an absent child before a present one";
        }
      }
      if (defect) return "node " + std::to_string(index) + defect;
    }
    return "";
  }

  std::string CheckInner(std::uint32_t parent, std::uint32_t child, const Bounds& bounds) {
    if (child >= tree_.node_count) return "no node " + std::to_string(child);
    if (level_[child] != 0) return "node " + std::to_string(child) + " is a child twice";
    level_[child] = static_cast<std::uint8_t>(level_[parent] + 1);
    if (level_[child] > kMaxTreeDepth) return "too deep";
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      if (tree_.nodes[child].child[slot] == kNoChild) continue;
      const Bounds below = BoundsOf(tree_.nodes[child], slot);
      if (!bounds.Contains(below.lower, below.upper)) {
        return "the box does not contain that of child " + std::to_string(slot) + " of node " +
               std::to_string(child);
      }
    }
    pending_.push_back(child);
    return "";
  }

  std::string CheckLeaf(std::uint32_t leaf, const Bounds& bounds) {
    if (IndexOf(LeafKind(leaf)) >= kKindCount) return "a leaf of no kind";
    Primitives<Real>& kind = kinds_[IndexOf(LeafKind(leaf))];
    const std::uint32_t first = LeafFirst(leaf), count = LeafCount(leaf);
    if (first + count > kind.blocks.count) {
      return std::string("a leaf beyond the last ") + kind.name;
    }
    const Real* const block = kind.blocks.fields + std::size_t{first} * kind.field_count;
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t id = kind.blocks.id[first + i];
      const std::string name = std::string(kind.name) + " " + std::to_string(id);
      const std::uint32_t input = kind.Find(id);
      if (input == kind.input_count) return "no " + name;
      if (kind.is_used[input]++) return name + " is there twice";
      for (std::uint32_t k = 0; k < kind.field_count; ++k) {
        const Real* const stored = block + std::size_t{k} * count + i;
        if (std::memcmp(stored, kind.fields[k] + input, sizeof(Real)) != 0) {
          return name + " has another field " + std::to_string(k);
        }
      }
      PrimitiveBox box;
      if (BoxOf(kind, input, box) != BoxState::kFinite) return name + " is not finite";
      if (IsGiant(box)) box = bvh::GiantBox(box.tag);
      if (!bounds.Contains(box.lower, box.upper)) return "the box does not contain " + name;
    }
    return "";
  }

  std::string CheckComplete(const Primitives<Real>& kind) const {
    std::uint32_t used = 0;
    for (std::uint32_t i = 0; i < kind.input_count; ++i) {
      PrimitiveBox box;
      used += kind.is_used[i];
      if (!kind.is_used[i] && BoxOf(kind, i, box) != BoxState::kNever) {
        return std::string(kind.name) + " " + std::to_string(kind.input_id[i]) + " is missing";
      }
    }
    if (used == kind.blocks.count) return "";
    return "a count of " + std::to_string(kind.blocks.count) + ", but " + std::to_string(used) +
           " " + kind.name + "s in leaves";
  }

  BoxState BoxOf(const Primitives<Real>& kind, std::uint32_t input, PrimitiveBox& box) const {
    return bvh::MakeBox(geometry_, MakePlace(kind.kind, input), box);
  }

  TreeView<Real> tree_;
  GeometryView<Real> geometry_;
  Primitives<Real> kinds_[kKindCount] = {};
  std::vector<std::uint8_t> level_;  // of each node; 0: not reached
  std::vector<std::uint32_t> pending_;
};

}  // namespace

template <typename Real>
std::string FindTreeDefect(const TreeView<Real>& tree, const GeometryView<Real>& geometry) {
  return Validator<Real>(tree, geometry).FindDefect();
}

template std::string FindTreeDefect(const TreeView<float>&, const GeometryView<float>&);
template std::string FindTreeDefect(const TreeView<double>&, const GeometryView<double>&);

}  // namespace sheaf
