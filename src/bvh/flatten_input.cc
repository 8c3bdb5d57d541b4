// From the spans of a GeometryInput to flat arrays, checked on the way.
#include <algorithm>
#include <atomic>
#include <limits>
#include <mutex>
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

// Floats or doubles, as they were given.
struct Numbers {
  std::span<const float> floats;
  std::span<const double> doubles;

  std::size_t size() const { return floats.size() + doubles.size(); }
  bool is_null() const { return size() > 0 && !floats.data() && !doubles.data(); }
  template <typename Real>
  void Copy(std::size_t first, std::size_t count, Real* to) const {
    const auto copy = [&](auto from) {
      for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<Real>(from[first + i]);
    };
    return doubles.empty() ? copy(floats) : copy(doubles);
  }
};

// One object of a GeometryInput. A mesh is triangles by `indices`, anything else the fields of its
// primitives in turn.
struct InputObject {
  PrimitiveKind kind;
  Numbers numbers, normals;
  std::span<const std::uint32_t> indices;

  bool is_mesh() const { return kind == PrimitiveKind::kTriangle; }
  std::size_t primitive_count() const {
    return is_mesh() ? indices.size() / 3 : numbers.size() / FieldCountOf(kind);
  }

  // Copies the fields of a primitive; false where an index is out of range.
  template <typename Real>
  bool Read(std::size_t primitive, Real* fields) const {
    if (is_mesh()) return ReadVertices(numbers, primitive, fields);
    const std::size_t count = FieldCountOf(kind);
    numbers.Copy(count * primitive, count, fields);
    return true;
  }
  // The normals of a triangle's vertices; 0 where there are none.
  template <typename Real>
  void ReadNormals(std::size_t primitive, Real* to) const {
    if (normals.size() == 0) return void(std::fill_n(to, 9, Real(0)));
    ReadVertices(normals, primitive, to);
  }

  // "" or which array is null, or does not divide.
  std::string ArrayFault() const {
    if (numbers.is_null()) return is_mesh() ? "the vertices are null" : "the numbers are null";
    if (indices.data() == nullptr && !indices.empty()) return "the indices are null";
    if (normals.is_null()) return "the normals are null";
    const auto fault = [](std::size_t count, const char* what, std::uint32_t by) {
      if (count % by == 0) return std::string();
      return std::to_string(count) + " " + what + " do not divide by " + std::to_string(by);
    };
    if (!is_mesh()) return fault(numbers.size(), "numbers", FieldCountOf(kind));
    const std::string of_vertices = fault(numbers.size(), "vertex coordinates", 3);
    if (!of_vertices.empty()) return of_vertices;
    if (indices.empty() && numbers.size() > 0) return "vertices without indices";
    if (normals.size() > 0 && normals.size() != numbers.size()) {
      return std::to_string(normals.size()) + " numbers of normals for " +
             std::to_string(numbers.size()) + " of vertices";
    }
    return fault(indices.size(), "indices", 3);
  }

  // What is wrong with a primitive that is.
  template <typename Real>
  std::string PrimitiveFault(std::size_t primitive) const {
    Real fields[kMaxFields];
    if (Read(primitive, fields)) {
      const char* const fault = WithKind<Real>(
          kind, [&](auto arrays) { return bvh::Rules<arrays.kKind>::Fault(fields); });
      return *fault ? fault : "a normal is not finite";
    }
    const std::size_t vertices = numbers.size() / 3;
    std::size_t corner = 3 * primitive;
    while (indices[corner] < vertices) ++corner;
    return "vertex " + std::to_string(indices[corner]) + " of " + std::to_string(vertices);
  }

 private:
  template <typename Real>
  bool ReadVertices(const Numbers& from, std::size_t primitive, Real* to) const {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::size_t index = indices[3 * primitive + corner];
      if (index >= from.size() / 3) return false;
      from.Copy(3 * index, 3, to + 3 * corner);
    }
    return true;
  }
};

// What is counted of the primitives of an object.
struct Tally {
  std::uint32_t never_hit = 0, skipped = 0;
  TriangleSizes sizes;
};

// Puts one primitive into the arrays; false where it is wrong.
template <PrimitiveKind kKind, typename Real>
bool PutPrimitive(const InputObject& object, std::size_t i, std::uint32_t index, std::uint32_t id,
                  NotFinite not_finite, GeometryArrays<Real>& arrays, Tally& tally) {
  constexpr bool kIsTriangle = kKind == PrimitiveKind::kTriangle;
  Real fields[kMaxFields], normals[9];
  if (!object.Read(i, fields)) return false;
  bool is_finite = bvh::AreFinite(fields, FieldCountOf(kKind));
  const bool has_normals = kIsTriangle && arrays.normal[0][0].size() > 0;
  if (has_normals) {
    object.ReadNormals(i, normals);
    is_finite &= bvh::AreFinite(normals, 9);
    for (std::size_t k = 0; k < 9; ++k) arrays.normal[k / 3][k % 3][index] = normals[k];
  }
  if (!is_finite) {
    if (not_finite == NotFinite::kRefused) return false;
    // Put then finds nothing to hit, whatever else there is.
    std::fill_n(fields, kMaxFields, std::numeric_limits<Real>::quiet_NaN());
    ++tally.skipped;
    arrays.template Put<kKind>(index, id, fields);
    return true;
  }
  if (*bvh::Rules<kKind>::Fault(fields)) return false;
  const bool is_hittable = arrays.template Put<kKind>(index, id, fields);
  tally.never_hit += !is_hittable;
  if constexpr (kIsTriangle) {
    if (!is_hittable) return true;
    double exact[3][3];
    bvh::Rules<kKind>::Widen(fields, exact);
    tally.sizes.Include(exact);
  }
  return true;
}

// Puts the primitives of an object at `index` and `id` and after; returns the first that is wrong,
// or their number.
template <PrimitiveKind kKind, typename Real>
std::size_t PutObject(const InputObject& object, std::uint32_t index, std::uint32_t id,
                      const BuildOptions& options, FlatInputOf<Real>& to) {
  std::mutex mutex;
  return ReadBlocks(object.primitive_count(), options.threads,
                    [&](std::size_t begin, std::size_t end) {
                      Tally tally;
                      for (std::size_t i = begin; i < end; ++i) {
                        const auto offset = static_cast<std::uint32_t>(i);
                        if (!PutPrimitive<kKind>(object, i, index + offset, id + offset,
                                                 options.not_finite, to.arrays, tally)) {
                          return i;
                        }
                      }
                      const std::lock_guard<std::mutex> lock(mutex);
                      to.never_hit += tally.never_hit;
                      to.skipped += tally.skipped;
                      to.sizes.Include(tally.sizes);
                      return end;
                    });
}

template <typename Real>
std::size_t PutAny(const InputObject& object, std::uint32_t index, std::uint32_t id,
                   const BuildOptions& options, FlatInputOf<Real>& to) {
  return WithKind<Real>(object.kind, [&](auto arrays) {
    return PutObject<arrays.kKind>(object, index, id, options, to);
  });
}

}  // namespace

template <typename Real>
Result<FlatInputOf<Real>> GeometryAccess::FlattenTo(const GeometryInput& input,
                                                    const BuildOptions& given) {
  BuildOptions options = given;
  options.threads = ThreadCount(given.threads);
  std::vector<InputObject> objects;
  CountsByKind<std::uint64_t> counts;
  VertexAttributes attributes;
  for (const auto& [kind, numbers, indices, normals] : input.objects_) {
    const InputObject& object = objects.emplace_back(InputObject{static_cast<PrimitiveKind>(kind),
                                                                 {numbers.floats, numbers.doubles},
                                                                 {normals.floats, normals.doubles},
                                                                 indices});
    if (const std::string fault = object.ArrayFault(); !fault.empty()) {
      return Usage("object " + std::to_string(objects.size() - 1) + ": " + fault);
    }
    counts[object.kind] += object.primitive_count();
    attributes.has_normals |= object.normals.size() > 0;
  }
  if (const Status status = CheckCounts(counts); !status.ok()) return status.error();

  FlatInputOf<Real> flat;
  flat.arrays = GeometryArrays<Real>(Narrow(counts), attributes);
  PrimitiveCounts next;
  for (std::uint32_t i = 0; i < objects.size(); ++i) {
    const InputObject& object = objects[i];
    const std::uint32_t id = next.total();
    flat.first.push_back(id);
    flat.first_triangle.push_back(next[PrimitiveKind::kTriangle]);
    flat.kind.push_back(object.kind);
    const std::size_t wrong = PutAny(object, next[object.kind], id, options, flat);
    if (wrong < object.primitive_count()) {
      return Usage(Name(i, NameOf(object.kind), wrong) + ": " + object.PrimitiveFault<Real>(wrong));
    }
    next[object.kind] += static_cast<std::uint32_t>(object.primitive_count());
  }
  flat.first.push_back(next.total());
  flat.first_triangle.push_back(next[PrimitiveKind::kTriangle]);
  return flat;
}

template Result<FlatInputOf<float>> GeometryAccess::FlattenTo(const GeometryInput&,
                                                              const BuildOptions&);
template Result<FlatInputOf<double>> GeometryAccess::FlattenTo(const GeometryInput&,
                                                               const BuildOptions&);

}  // namespace sheaf
