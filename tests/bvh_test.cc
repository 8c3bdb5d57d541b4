// The tree: sound over every scene, however degenerate; the same on any number of threads.
#include <doctest/doctest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/bvh/validate_tree.h"

namespace sheaf {
namespace {

// Threads that the tests ask for run, on any number of cores.
const oneapi::tbb::global_control kThreads(oneapi::tbb::global_control::max_allowed_parallelism, 4);

// Primitives in exactly as much memory as they take.
template <typename Real>
struct Primitives {
  std::vector<Real> triangle[9], sphere[4];
  std::vector<std::uint32_t> triangle_id, sphere_id;

  void AddTriangle(const std::vector<double>& v) {
    for (std::size_t k = 0; k < 9; ++k) triangle[k].push_back(static_cast<Real>(v[k]));
    triangle_id.push_back(NextId());
  }
  void AddSphere(double x, double y, double z, double radius) {
    const double v[4] = {x, y, z, radius};
    for (std::size_t k = 0; k < 4; ++k) sphere[k].push_back(static_cast<Real>(v[k]));
    sphere_id.push_back(NextId());
  }
  std::uint32_t NextId() const {
    return static_cast<std::uint32_t>(triangle_id.size() + sphere_id.size());
  }

  GeometryView<Real> view() const {
    GeometryView<Real> view{};
    view.triangles.count = static_cast<std::uint32_t>(triangle_id.size());
    for (std::size_t k = 0; k < 9; ++k) view.triangles.vertex[k / 3][k % 3] = triangle[k].data();
    view.triangles.id = triangle_id.data();
    view.spheres = {static_cast<std::uint32_t>(sphere_id.size()),
                    sphere[0].data(),
                    sphere[1].data(),
                    sphere[2].data(),
                    sphere[3].data(),
                    sphere_id.data()};
    return view;
  }
};

// A triangle and a sphere of extent `size` around a point, in turn.
template <typename Real>
void AddRandom(Random& random, const Vec3d& at, double size, Primitives<Real>& to) {
  if (random() % 2) return to.AddSphere(at.x, at.y, at.z, size);
  std::vector<double> v;
  for (int corner = 0; corner < 3; ++corner) {
    const Vec3d p = at + UniformPoint(random, -size, size);
    v.insert(v.end(), {p.x, p.y, p.z});
  }
  to.AddTriangle(v);
}

template <typename Real>
Primitives<Real> RandomPrimitives(Random& random, int count, double extent, double size) {
  Primitives<Real> primitives;
  for (int i = 0; i < count; ++i) {
    AddRandom(random, UniformPoint(random, -extent, extent), size, primitives);
  }
  return primitives;
}

template <typename Real>
Primitives<Real> SameTriangles(int count) {
  Primitives<Real> primitives;
  for (int i = 0; i < count; ++i) primitives.AddTriangle({0, 0, 0, 1, 0, 0, 0, 1, 0});
  return primitives;
}

template <typename Tree>
auto& TrianglesOf(Tree& tree) {
  return tree.of(PrimitiveKind::kTriangle);
}
template <typename Tree>
auto& SpheresOf(Tree& tree) {
  return tree.of(PrimitiveKind::kSphere);
}

template <typename Real>
std::uint32_t DepthOf(const Tree<Real>& tree) {
  std::vector<std::uint32_t> level(tree.node_count, 1);
  std::uint32_t depth = 0;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    depth = std::max(depth, level[i]);
    for (const std::uint32_t child : tree.nodes[i].child) {
      if (!IsLeaf(child)) level[child] = level[i] + 1;
    }
  }
  return depth;
}

std::uint32_t LeavesOf(const TreeNode& node) {
  std::uint32_t leaves = 0;
  for (const std::uint32_t child : node.child) leaves += IsLeaf(child) && child != kNoChild;
  return leaves;
}

template <typename Real>
Tree<Real> SoundTree(const GeometryView<Real>& geometry, int threads = 1) {
  Result<Tree<Real>> built = BuildTree(geometry, threads);
  REQUIRE(built.ok());
  CHECK(FindTreeDefect(built.value().view(), geometry) == "");
  return std::move(built).value();
}

template <typename T>
bool SameBytes(const AlignedArray<T>& a, const AlignedArray<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

template <typename Real>
void CheckSameTree(const Tree<Real>& a, const Tree<Real>& b) {
  CHECK(a.node_count == b.node_count);
  CHECK(SameBytes(a.nodes, b.nodes));
  for (std::size_t k = 0; k < kKindCount; ++k) {
    CHECK(SameBytes(a.blocks[k].fields, b.blocks[k].fields));
    CHECK(SameBytes(a.blocks[k].id, b.blocks[k].id));
  }
  CHECK(std::memcmp(a.lower, b.lower, sizeof(a.lower)) == 0);
  CHECK(std::memcmp(a.upper, b.upper, sizeof(a.upper)) == 0);
}

TEST_CASE_TEMPLATE("random scenes make sound trees", Real, float, double) {
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    const int count = round < 30 ? round : round * round;
    const CompiledScene<Real> scene = CompileScene<Real>(RandomScene(random, count));
    SoundTree(scene.geometry());
  }
}

TEST_CASE_TEMPLATE("the tree does not depend on the number of threads", Real, float, double) {
  Random random(2);
  // Large enough that ranges are binned, split and built side by side; some -0 and some left out.
  Primitives<Real> primitives = RandomPrimitives<Real>(random, 200'000, 1, 0.01);
  for (std::size_t i = 0; i < primitives.triangle_id.size(); i += 7) {
    primitives.triangle[i % 9][i] = i % 2 ? Real(0) : -Real(0);
  }
  for (std::size_t i = 0; i < primitives.sphere_id.size(); i += 1001) {
    primitives.sphere[3][i] = std::numeric_limits<Real>::quiet_NaN();
  }
  const GeometryView<Real> geometry = primitives.view();
  const Tree<Real> tree = SoundTree(geometry);
  CHECK(SpheresOf(tree).count < geometry.spheres.count);
  for (const int threads : {2, 4, 0}) {
    const Result<Tree<Real>> other = BuildTree(geometry, threads);
    REQUIRE(other.ok());
    CheckSameTree(tree, other.value());
  }
}

TEST_CASE_TEMPLATE("few primitives are one leaf of each kind", Real, float, double) {
  Random random(3);
  Primitives<Real> primitives;
  const Tree<Real> empty = SoundTree(primitives.view());
  CHECK(empty.node_count == 0);
  CHECK(empty.lower[0] > empty.upper[0]);
  for (std::uint32_t triangles = 0; triangles <= 9; ++triangles) {
    primitives = {};
    for (std::uint32_t i = 0; i < triangles; ++i) {
      const double x = Uniform(random, -1, 1);
      primitives.AddTriangle({x, 0, 0, x, 1, 0, x, 0, 1});
    }
    for (std::uint32_t spheres = 0; spheres <= 9; ++spheres) {
      CAPTURE(triangles);
      CAPTURE(spheres);
      const Tree<Real> tree = SoundTree(primitives.view());
      if (triangles + spheres > 0 && triangles <= 8 && spheres <= 8) {
        CHECK(tree.node_count == 1);
        CHECK(LeavesOf(tree.nodes[0]) == (triangles > 0) + (spheres > 0));
      }
      primitives.AddSphere(Uniform(random, -1, 1), 0, 0, 0.1);
    }
  }
}

TEST_CASE_TEMPLATE("primitives that no box tells apart", Real, float, double) {
  const Tree<Real> same = SoundTree(SameTriangles<Real>(100'000).view());
  CHECK(DepthOf(same) <= 10);
  // Concentric spheres: equal centers, different sizes; triangles without extent among them.
  Primitives<Real> concentric;
  for (int i = 1; i <= 5000; ++i) {
    concentric.AddSphere(1, 2, 3, i);
    concentric.AddTriangle({1, 2, 3, 1, 2, 3, 1, 2, 3});
  }
  CHECK(DepthOf(SoundTree(concentric.view())) <= 10);
  // All on one line, so that every area is 0.
  Primitives<Real> line;
  for (int i = 0; i < 1000; ++i) line.AddTriangle({0, 0, i + 0.0, 0, 0, i + 1.0, 0, 0, i + 2.0});
  CHECK(DepthOf(SoundTree(line.view())) <= 8);
}

TEST_CASE_TEMPLATE("any scale", Real, float, double) {
  Random random(4);
  for (const double scale : {1e-45, 1e-42, 1e-38, 1e-30, 1e-20, 1e15, 1e19, 1e30, 1e37, 3e38}) {
    CAPTURE(scale);
    SoundTree(RandomPrimitives<Real>(random, 2000, scale, scale * 0.1).view());
    SoundTree(RandomPrimitives<Real>(random, 300, scale, 0).view());
  }
  // Tiny beside huge, and far from the origin.
  Primitives<Real> mixed = RandomPrimitives<Real>(random, 500, 1e-38, 1e-40);
  for (int i = 0; i < 500; ++i) AddRandom(random, UniformPoint(random, 0, 1e30), 1e28, mixed);
  for (int i = 0; i < 500; ++i) AddRandom(random, {1e7, 1e7, 1e7}, 1e-3, mixed);
  mixed.AddSphere(1e30, 1e-30, 0, 1e-10);
  SoundTree(mixed.view());
}

TEST_CASE("doubles beyond the range of float") {
  Random random(5);
  SoundTree(RandomPrimitives<double>(random, 1000, 1e300, 1e299).view());
  SoundTree(RandomPrimitives<double>(random, 1000, 1, 1e-300).view());
}

TEST_CASE_TEMPLATE("trees that would be deep", Real, float, double) {
  // Sizes and places in geometric progression: a split by area peels off one primitive at a time.
  for (const double ratio : {0.5, 0.9, 0.99}) {
    Primitives<Real> primitives;
    double at = 1e30;
    for (int i = 0; i < 20'000; ++i) {
      if (i % 3) {
        primitives.AddSphere(at, at, at, at * 0.4);
      } else {
        primitives.AddTriangle({at, 0, 0, at * 1.2, at, 0, at, 0, at});
      }
      at *= ratio;
    }
    CHECK(DepthOf(SoundTree(primitives.view())) <= kMaxTreeDepth);
  }
}

// Overlapping spheres, each a hundredth smaller and nearer to one point, none of them a giant:
// splits by area alone make more than 18 levels of these.
TEST_CASE_TEMPLATE("from a certain depth on, splits halve", Real, float, double) {
  Primitives<Real> primitives;
  double at = 1e11;
  for (int i = 0; i < 12'500; ++i) {
    primitives.AddSphere(at, at, at, at);
    at *= 0.99;
  }
  const std::uint32_t depth = DepthOf(SoundTree(primitives.view()));
  CHECK(depth >= 12);
  CHECK(depth <= 18);
}

TEST_CASE_TEMPLATE("NaN is left out, infinity refused", Real, float, double) {
  Random random(6);
  constexpr Real kNaN = std::numeric_limits<Real>::quiet_NaN();
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  for (int round = 0; round < 30; ++round) {
    const Primitives<Real> sound = RandomPrimitives<Real>(random, 50, 1, 0.1);
    Primitives<Real> primitives = sound;
    const std::size_t t = random() % sound.triangle_id.size(),
                      s = random() % sound.sphere_id.size();
    Real& number = round % 2 ? primitives.triangle[round % 9][t] : primitives.sphere[round % 4][s];
    number = kNaN;
    const Tree<Real> tree = SoundTree(primitives.view());
    CHECK(TrianglesOf(tree).count + SpheresOf(tree).count == 49);
    number = round % 4 < 2 ? kInfinity : -kInfinity;
    const Result<Tree<Real>> refused = BuildTree(primitives.view());
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().kind == ErrorKind::kUsage);
    CHECK(refused.error().message.find("infinite") != std::string::npos);
  }
  Primitives<Real> never = SameTriangles<Real>(10);
  for (Real& x : never.triangle[0]) x = kNaN;
  CHECK(SoundTree(never.view()).node_count == 0);
  // Too many are refused before anything is read.
  GeometryView<Real> many = never.view();
  many.triangles.count = kMaxTreePrimitives + 1;
  CHECK_FALSE(BuildTree(many).ok());
  many = never.view();
  many.spheres.count = kMaxTreePrimitives + 1;
  CHECK_FALSE(BuildTree(many).ok());
}

TEST_CASE_TEMPLATE("children are met from front to back", Real, float, double) {
  Random random(7);
  const Primitives<Real> primitives = RandomPrimitives<Real>(random, 5000, 1, 0.01);
  const Tree<Real> tree = SoundTree(primitives.view());
  std::uint32_t wrong = 0;
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    const TreeNode& node = tree.nodes[i];
    for (std::uint32_t octant = 0; octant < 8; ++octant) {
      double last = -std::numeric_limits<double>::infinity();
      for (std::uint32_t k = 0; k < kTreeWidth; ++k) {
        const std::uint32_t slot = node.order[octant] >> (4 * k) & 15u;
        if (node.child[slot] == kNoChild) break;
        double along = 0;
        for (std::uint32_t axis = 0; axis < 3; ++axis) {
          const double sum = static_cast<double>(node.bounds[axis][slot]) +
                             static_cast<double>(node.bounds[3 + axis][slot]);
          along += octant >> axis & 1 ? -sum : sum;
        }
        wrong += along < last - 1e-5;
        last = along;
      }
    }
  }
  CHECK(wrong == 0);
}

// ---- The validator ----

struct Planted {
  const char* defect;  // what must be said
  void (*plant)(Tree<float>& tree);
};

// The first child of any node for which `is_wanted` holds.
template <typename F>
std::pair<std::uint32_t, std::uint32_t> FindChild(const Tree<float>& tree, const F& is_wanted) {
  for (std::uint32_t i = 0; i < tree.node_count; ++i) {
    for (std::uint32_t slot = 0; slot < kTreeWidth; ++slot) {
      if (is_wanted(tree.nodes[i].child[slot])) return {i, slot};
    }
  }
  FAIL("no such child");
  return {};
}

bool IsPresentLeaf(std::uint32_t child) { return IsLeaf(child) && child != kNoChild; }

void ExpectFound(std::span<const Planted> planted) {
  Random random(8);
  const Primitives<float> primitives = RandomPrimitives<float>(random, 3000, 1, 0.02);
  const GeometryView<float> geometry = primitives.view();
  for (const Planted& entry : planted) {
    Tree<float> tree = SoundTree(geometry);
    const std::string defect = entry.defect;
    entry.plant(tree);
    const std::string found = FindTreeDefect(tree.view(), geometry);
    CAPTURE(defect);
    CAPTURE(found);
    CHECK(found.find(defect) != std::string::npos);
  }
}

TEST_CASE("planted defects of primitives and children are found") {
  const Planted planted[] = {
      {"missing", [](Tree<float>& tree) { tree.node_count = 0; }},
      {"is there twice",
       [](Tree<float>& tree) { TrianglesOf(tree).id[5] = TrianglesOf(tree).id[4]; }},
      {"no triangle", [](Tree<float>& tree) { TrianglesOf(tree).id[5] = 1u << 30; }},
      {"no triangle", [](Tree<float>& tree) { TrianglesOf(tree).id[5] = SpheresOf(tree).id[5]; }},
      {"another field", [](Tree<float>& tree) { TrianglesOf(tree).fields[100] += 1; }},
      {"another field",
       [](Tree<float>& tree) { SpheresOf(tree).fields[100] = -SpheresOf(tree).fields[100]; }},
      {"is a child twice",
       [](Tree<float>& tree) {
         std::uint32_t* const child = tree.nodes[0].child;
         REQUIRE_FALSE((IsLeaf(child[0]) || IsLeaf(child[1])));
         child[1] = child[0];
       }},
      {"is a child twice",
       [](Tree<float>& tree) {
         // A cycle.
         const auto inner = [](std::uint32_t child) { return !IsLeaf(child); };
         const auto [node, slot] = FindChild(tree, inner);
         tree.nodes[node].child[slot] = 0;
       }},
      {"no node",
       [](Tree<float>& tree) {
         const auto inner = [](std::uint32_t child) { return !IsLeaf(child); };
         const auto [node, slot] = FindChild(tree, inner);
         tree.nodes[node].child[slot] = tree.node_count;
       }},
      {"a leaf beyond the last", [](Tree<float>& tree) {
         const auto [node, slot] = FindChild(tree, IsPresentLeaf);
         tree.nodes[node].child[slot] =
             MakeLeaf(PrimitiveKind::kTriangle, TrianglesOf(tree).count - 1, kMaxLeafSize);
       }}};
  ExpectFound(planted);
}

TEST_CASE("planted defects of boxes, orders and counts are found") {
  const Planted planted[] = {
      {"does not contain",
       [](Tree<float>& tree) {
         const auto [node, slot] = FindChild(tree, IsPresentLeaf);
         float& upper = tree.nodes[node].bounds[3][slot];
         upper = std::nextafter(upper, -1e9f);
       }},
      {"does not contain",
       [](Tree<float>& tree) {
         const auto [node, slot] = FindChild(tree, IsPresentLeaf);
         tree.nodes[node].bounds[1][slot] = std::numeric_limits<float>::quiet_NaN();
       }},
      {"does not contain that of child",
       [](Tree<float>& tree) {
         const auto inner = [](std::uint32_t child) { return !IsLeaf(child); };
         const auto [node, slot] = FindChild(tree, inner);
         float& lower = tree.nodes[node].bounds[2][slot];
         lower = std::nextafter(lower, 1e9f);
       }},
      {"leaves the tree's", [](Tree<float>& tree) { tree.upper[1] -= 1e-3f; }},
      {"no permutation",
       [](Tree<float>& tree) { tree.nodes[tree.node_count / 2].order[3] = 0x76543211; }},
      {"absent child before",
       [](Tree<float>& tree) {
         const auto [node, slot] =
             FindChild(tree, [](std::uint32_t child) { return child == kNoChild; });
         std::uint32_t& order = tree.nodes[node].order[6];
         order = (order & 0x0fffffffu) << 4 | order >> 28;
       }},
      {"absent child has a box",
       [](Tree<float>& tree) {
         const auto [node, slot] =
             FindChild(tree, [](std::uint32_t child) { return child == kNoChild; });
         tree.nodes[node].bounds[0][slot] = 0;
       }},
      {"is missing",
       [](Tree<float>& tree) {
         const auto [node, slot] = FindChild(tree, [](std::uint32_t child) {
           return IsPresentLeaf(child) && LeafCount(child) == 1;
         });
         tree.nodes[node].child[slot] = kNoChild;
         tree.nodes[node].order[0] = 0x76543210;
         for (std::uint32_t axis = 0; axis < 3; ++axis) {
           tree.nodes[node].bounds[axis][slot] = std::numeric_limits<float>::max();
           tree.nodes[node].bounds[3 + axis][slot] = -std::numeric_limits<float>::max();
         }
         // Orders with the absent ones last.
         std::uint32_t order = 0, at = 0;
         for (int present = 1; present >= 0; --present) {
           for (std::uint32_t i = 0; i < kTreeWidth; ++i) {
             if ((tree.nodes[node].child[i] != kNoChild) == (present == 1)) order |= i << 4 * at++;
           }
         }
         for (std::uint32_t& o : tree.nodes[node].order) o = order;
       }},
      {"but", [](Tree<float>& tree) { ++SpheresOf(tree).count; }},
      {"is no node's child", [](Tree<float>& tree) {
         AlignedArray<TreeNode> nodes;
         nodes.Allocate(tree.node_count + 1);
         std::memcpy(nodes.data(), tree.nodes.data(), tree.node_count * sizeof(TreeNode));
         tree.nodes = std::move(nodes);
         ++tree.node_count;
       }}};
  ExpectFound(planted);
}

TEST_CASE("a tree that is too deep is found") {
  const Primitives<float> primitives = SameTriangles<float>(1);
  Tree<float> tree = SoundTree(primitives.view());
  const TreeNode last = tree.nodes[0];
  for (std::uint32_t depth = kMaxTreeDepth; depth <= kMaxTreeDepth + 1; ++depth) {
    tree.nodes.Allocate(depth);
    tree.node_count = depth;
    for (std::uint32_t i = 0; i < depth; ++i) {
      tree.nodes[i] = last;
      if (i + 1 < depth) tree.nodes[i].child[0] = i + 1;
    }
    const std::string defect = FindTreeDefect(tree.view(), primitives.view());
    CHECK((defect == "") == (depth == kMaxTreeDepth));
  }
}

}  // namespace
}  // namespace sheaf
