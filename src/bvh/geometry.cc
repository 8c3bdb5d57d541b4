#include "src/bvh/geometry.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/core/has_area.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kBlock = 1u << 14;  // primitives that are read by one task

// Some fields of `size` floats each, uninitialised: every element is written once, by all threads.
struct Fields {
  std::unique_ptr<float[]> data;
  std::size_t size;

  Fields(std::size_t fields, std::size_t n)
      : data(std::make_unique_for_overwrite<float[]>(fields * n)), size(n) {}
  float* operator[](std::size_t field) { return data.get() + field * size; }
};

bool IsFinite(const float* x, int count) {
  return std::all_of(x, x + count, [](float value) { return std::isfinite(value); });
}

std::string Name(std::uint32_t object, const char* kind, std::size_t index) {
  return "object " + std::to_string(object) + ", " + kind + " " + std::to_string(index);
}
Error Usage(std::string message) { return {ErrorKind::kUsage, std::move(message)}; }

// Makes *lowest the smaller of itself and value.
void LowerTo(std::atomic<std::size_t>& lowest, std::size_t value) {
  std::size_t seen = lowest.load();
  while (value < seen && !lowest.compare_exchange_weak(seen, value)) {
  }
}

// Calls read(first, end) over [0, count) in blocks, on `threads` threads. It returns the first
// element that is wrong, or `end`. Returns the lowest of all that are wrong, or `count`.
template <typename Read>
std::size_t ReadBlocks(std::size_t count, int threads, const Read& read) {
  std::atomic<std::size_t> lowest = count;
  ParallelFor(threads, (count + kBlock - 1) / kBlock, [&](int, std::uint64_t block) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    const std::size_t end = std::min(first + kBlock, count);
    const std::size_t wrong = read(first, end);
    if (wrong < end) LowerTo(lowest, wrong);
  });
  return lowest;
}

// The fields of one kind of all objects, with what a kernel asks for.
struct Gathered {
  Fields triangles, spheres;
  std::vector<std::uint32_t> triangle_id, sphere_id;
  std::atomic<std::uint32_t> never_hit = 0;
};

constexpr float kNever = std::numeric_limits<float>::quiet_NaN();

// Appends a mesh at triangle `first`; returns its first triangle that is wrong, or their number.
std::size_t GatherMesh(std::span<const float> vertices, std::span<const std::uint32_t> indices,
                       std::size_t first, int threads, Gathered& to) {
  const std::size_t vertex_count = vertices.size() / 3;
  return ReadBlocks(indices.size() / 3, threads, [&](std::size_t begin, std::size_t end) {
    std::uint32_t never_hit = 0;
    for (std::size_t i = begin; i < end; ++i) {
      float v[9];
      double exact[3][3];
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::size_t index = indices[3 * i + corner];
        if (index >= vertex_count) return i;
        std::copy_n(vertices.data() + 3 * index, 3, v + 3 * corner);
        std::copy_n(v + 3 * corner, 3, exact[corner]);
      }
      if (!IsFinite(v, 9)) return i;
      if (!HasArea(exact)) {
        v[0] = kNever;
        ++never_hit;
      }
      for (std::size_t k = 0; k < 9; ++k) to.triangles[k][first + i] = v[k];
    }
    to.never_hit += never_hit;
    return end;
  });
}

Error MeshError(std::uint32_t object, std::size_t triangle, std::span<const float> vertices,
                std::span<const std::uint32_t> indices) {
  for (std::size_t corner = 3 * triangle; corner < 3 * triangle + 3; ++corner) {
    if (indices[corner] >= vertices.size() / 3) {
      return Usage(Name(object, "triangle", triangle) + ": vertex " +
                   std::to_string(indices[corner]) + " of " + std::to_string(vertices.size() / 3));
    }
  }
  return Usage(Name(object, "triangle", triangle) + ": a coordinate is not finite");
}

std::size_t GatherSpheres(std::span<const float> spheres, std::size_t first, int threads,
                          Gathered& to) {
  return ReadBlocks(spheres.size() / 4, threads, [&](std::size_t begin, std::size_t end) {
    std::uint32_t never_hit = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const float* const sphere = spheres.data() + 4 * i;
      if (!IsFinite(sphere, 4) || sphere[3] < 0) return i;
      never_hit += sphere[3] == 0;
      for (std::size_t k = 0; k < 3; ++k) to.spheres[k][first + i] = sphere[k];
      to.spheres[3][first + i] = sphere[3] > 0 ? sphere[3] : kNever;
    }
    to.never_hit += never_hit;
    return end;
  });
}

Error SphereError(std::uint32_t object, std::size_t index, const float* sphere) {
  const char* const what = !IsFinite(sphere, 3)   ? ": a coordinate is not finite"
                           : !IsFinite(sphere, 4) ? ": the radius is not finite"
                                                  : ": the radius is negative";
  return Usage(Name(object, "sphere", index) + what);
}

GeometryView<float> ViewOf(Gathered& gathered) {
  GeometryView<float> view{};
  view.triangles.count = static_cast<std::uint32_t>(gathered.triangle_id.size());
  for (std::size_t k = 0; k < 9; ++k) view.triangles.vertex[k / 3][k % 3] = gathered.triangles[k];
  view.triangles.id = gathered.triangle_id.data();
  view.spheres = {static_cast<std::uint32_t>(gathered.sphere_id.size()),
                  gathered.spheres[0],
                  gathered.spheres[1],
                  gathered.spheres[2],
                  gathered.spheres[3],
                  gathered.sphere_id.data()};
  return view;
}

Error TooMany(std::size_t count, const char* kind) {
  return Usage(std::to_string(count) + " " + kind + ", at most " +
               std::to_string(kMaxTreePrimitives) + " are possible");
}

Error Indivisible(std::uint32_t object, std::size_t count, const char* what, int by) {
  return Usage("object " + std::to_string(object) + ": " + std::to_string(count) + " " + what +
               " do not divide by " + std::to_string(by));
}

}  // namespace

std::uint32_t GeometryInput::AddTriangles(std::span<const float> vertices,
                                          std::span<const std::uint32_t> indices) {
  objects_.push_back({true, vertices, indices});
  return static_cast<std::uint32_t>(objects_.size() - 1);
}

std::uint32_t GeometryInput::AddSpheres(std::span<const float> spheres) {
  objects_.push_back({false, spheres, {}});
  return static_cast<std::uint32_t>(objects_.size() - 1);
}

Result<Geometry> Geometry::Build(const GeometryInput& input, int threads) {
  threads = ThreadCount(threads);
  const auto& objects = input.objects_;
  std::size_t triangles = 0, spheres = 0;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const auto& [is_mesh, numbers, indices] = objects[i];
    if (is_mesh && numbers.size() % 3) {
      return Indivisible(i, numbers.size(), "vertex coordinates", 3);
    }
    if (is_mesh && indices.size() % 3) return Indivisible(i, indices.size(), "indices", 3);
    if (!is_mesh && numbers.size() % 4) return Indivisible(i, numbers.size(), "numbers", 4);
    (is_mesh ? triangles : spheres) += is_mesh ? indices.size() / 3 : numbers.size() / 4;
  }
  if (triangles > kMaxTreePrimitives) return TooMany(triangles, "triangles");
  if (spheres > kMaxTreePrimitives) return TooMany(spheres, "spheres");

  Geometry geometry;
  Gathered gathered{Fields(9, triangles), Fields(4, spheres), {}, {}};
  gathered.triangle_id.reserve(triangles);
  gathered.sphere_id.reserve(spheres);
  std::uint32_t next = 0;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const auto& [is_mesh, numbers, indices] = objects[i];
    auto& ids = is_mesh ? gathered.triangle_id : gathered.sphere_id;
    const std::size_t count = is_mesh ? indices.size() / 3 : numbers.size() / 4;
    const std::size_t wrong = is_mesh ? GatherMesh(numbers, indices, ids.size(), threads, gathered)
                                      : GatherSpheres(numbers, ids.size(), threads, gathered);
    if (wrong < count && is_mesh) return MeshError(i, wrong, numbers, indices);
    if (wrong < count) return SphereError(i, wrong, numbers.data() + 4 * wrong);
    geometry.first_.push_back(next);
    for (std::size_t k = 0; k < count; ++k) ids.push_back(next++);
  }
  geometry.first_.push_back(next);
  geometry.never_hit_ = gathered.never_hit;
  Result<Tree<float>> tree = BuildTree(ViewOf(gathered), threads);
  if (!tree) return tree.error();
  geometry.tree_ = std::move(tree).value();
  geometry.view_ = geometry.tree_.view();
  return geometry;
}

GeometryStatistics Geometry::statistics() const {
  GeometryStatistics statistics{};
  statistics.triangles = view_.triangle_count;
  statistics.spheres = view_.sphere_count;
  statistics.never_hit = never_hit_;
  statistics.nodes = view_.node_count;
  statistics.bytes = sizeof(*this) + tree_.bytes() + first_.capacity() * sizeof(first_[0]);
  // Every node comes before its children.
  std::vector<std::uint8_t> level(view_.node_count, 1);
  for (std::uint32_t i = 0; i < view_.node_count; ++i) {
    statistics.depth = std::max<std::uint32_t>(statistics.depth, level[i]);
    for (const std::uint32_t child : view_.nodes[i].child) {
      if (!IsLeaf(child)) level[child] = static_cast<std::uint8_t>(level[i] + 1);
      statistics.leaves += IsLeaf(child) && child != kNoChild;
    }
  }
  return statistics;
}

std::uint32_t Geometry::object_of(std::uint32_t primitive) const {
  // An object without primitives begins where the next one does, and is passed over.
  const auto after = std::upper_bound(first_.begin(), first_.end(), primitive);
  return static_cast<std::uint32_t>(after - first_.begin() - 1);
}

}  // namespace sheaf
