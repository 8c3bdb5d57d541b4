// From the spans of a GeometryInput to flat arrays, checked on the way.
#include <algorithm>
#include <atomic>
#include <string>
#include <utility>

#include "src/bvh/build_tree.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/primitive_rules.h"
#include "src/core/parallel.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kBlock = 1u << 14;  // primitives that are read by one task

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

// One object of a GeometryInput. A mesh is triangles by `indices`, anything else the fields of its
// primitives in turn.
struct InputObject {
  PrimitiveKind kind;
  std::span<const float> numbers;
  std::span<const std::uint32_t> indices;

  bool is_mesh() const { return kind == PrimitiveKind::kTriangle; }
  std::size_t primitive_count() const {
    return is_mesh() ? indices.size() / 3 : numbers.size() / FieldCountOf(kind);
  }

  // Copies the fields of a primitive; false where an index is out of range.
  bool Read(std::size_t primitive, float* fields) const {
    if (!is_mesh()) {
      const std::size_t count = FieldCountOf(kind);
      std::copy_n(numbers.data() + count * primitive, count, fields);
      return true;
    }
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t index = indices[3 * primitive + corner];
      if (index >= numbers.size() / 3) return false;
      std::copy_n(numbers.data() + 3 * index, 3, fields + 3 * corner);
    }
    return true;
  }

  // "" or which array is null, or does not divide.
  std::string ArrayFault() const {
    const auto is_null = [](const auto& span) { return span.data() == nullptr && !span.empty(); };
    if (is_null(numbers)) return is_mesh() ? "the vertices are null" : "the numbers are null";
    if (is_null(indices)) return "the indices are null";
    const auto fault = [](std::size_t count, const char* what, std::uint32_t by) {
      if (count % by == 0) return std::string();
      return std::to_string(count) + " " + what + " do not divide by " + std::to_string(by);
    };
    if (!is_mesh()) return fault(numbers.size(), "numbers", FieldCountOf(kind));
    const std::string of_vertices = fault(numbers.size(), "vertex coordinates", 3);
    if (!of_vertices.empty()) return of_vertices;
    if (indices.empty() && !numbers.empty()) return "vertices without indices";
    return fault(indices.size(), "indices", 3);
  }

  // What is wrong with a primitive that is.
  std::string PrimitiveFault(std::size_t primitive) const {
    float fields[kMaxFields];
    if (Read(primitive, fields)) {
      return WithKind<float>(
          kind, [&](auto arrays) { return std::string(bvh::Rules<arrays.kKind>::Fault(fields)); });
    }
    const std::size_t vertices = numbers.size() / 3;
    std::size_t corner = 3 * primitive;
    while (indices[corner] < vertices) ++corner;
    return "vertex " + std::to_string(indices[corner]) + " of " + std::to_string(vertices);
  }
};

// Puts the primitives of an object at `index` and `id` and after; returns the first that is wrong,
// or their number.
template <PrimitiveKind kKind>
std::size_t PutObject(const InputObject& object, std::uint32_t index, std::uint32_t id, int threads,
                      FlatInput& to) {
  std::atomic<std::uint32_t> never_hit = 0;
  const std::size_t wrong =
      ReadBlocks(object.primitive_count(), threads, [&](std::size_t begin, std::size_t end) {
        std::uint32_t never_hit_here = 0;
        for (std::size_t i = begin; i < end; ++i) {
          float fields[kMaxFields];
          if (!object.Read(i, fields) || *bvh::Rules<kKind>::Fault(fields)) return i;
          const auto offset = static_cast<std::uint32_t>(i);
          never_hit_here += !to.arrays.Put<kKind>(index + offset, id + offset, fields);
        }
        never_hit += never_hit_here;
        return end;
      });
  to.never_hit += never_hit;
  return wrong;
}

}  // namespace

Result<FlatInput> GeometryAccess::Flatten(const GeometryInput& input, int threads) {
  std::vector<InputObject> objects;
  CountsByKind<std::uint64_t> counts;
  for (const auto& [kind, numbers, indices] : input.objects_) {
    const InputObject& object =
        objects.emplace_back(InputObject{static_cast<PrimitiveKind>(kind), numbers, indices});
    if (const std::string fault = object.ArrayFault(); !fault.empty()) {
      return Usage("object " + std::to_string(objects.size() - 1) + ": " + fault);
    }
    counts[object.kind] += object.primitive_count();
  }
  if (const Status status = CheckCounts(counts); !status.ok()) return status.error();

  FlatInput flat;
  flat.arrays = GeometryArrays<float>(Narrow(counts));
  PrimitiveCounts next;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const InputObject& object = objects[i];
    const std::uint32_t id = next.total();
    flat.first.push_back(id);
    const std::size_t wrong = WithKind<float>(object.kind, [&](auto arrays) {
      return PutObject<arrays.kKind>(object, next[arrays.kKind], id, threads, flat);
    });
    if (wrong < object.primitive_count()) {
      return Usage(Name(i, NameOf(object.kind), wrong) + ": " + object.PrimitiveFault(wrong));
    }
    next[object.kind] += static_cast<std::uint32_t>(object.primitive_count());
  }
  flat.first.push_back(next.total());
  return flat;
}

}  // namespace sheaf
