// The kinds of primitives: their arrays, their names, and loops over all of them.
//
// A new kind is an enumerator, its arrays, a member of GeometryView and a line in ForEachKind and
// in WithKind. What holds for any kind goes through these two loops.
#ifndef SHEAF_SIMD_PRIMITIVES_H_
#define SHEAF_SIMD_PRIMITIVES_H_

#include <cstddef>
#include <cstdint>

namespace sheaf {

// In the order in which a tree keeps them.
enum class PrimitiveKind : std::uint32_t { kTriangle, kSphere, kDisk };
inline constexpr std::uint32_t kKindCount = 3;
inline constexpr std::uint32_t kMaxFields = 9;  // of a primitive of any kind

constexpr std::size_t IndexOf(PrimitiveKind kind) { return static_cast<std::size_t>(kind); }

// Arrays of a kind name their fields; ForEachField calls f(field) for those that a ray is tested
// against, in the order in which a tree keeps them. With a NaN among these a primitive is never
// hit.

template <typename Real>
struct TriangleArrays {
  using Number = Real;
  static constexpr PrimitiveKind kKind = PrimitiveKind::kTriangle;
  static constexpr const char* kName = "triangle";
  static constexpr std::uint32_t kFieldCount = 9;

  std::uint32_t count;
  const Real* vertex[3][3];  // [vertex][axis]; NaN: never hit (stands for zero area)
  const Real* uv[3][2];      // [vertex][u or v]; null where no material asks for coordinates
  const Real* uv2[3][2];     // the second set; null where no texture of a mesh asks for it
  // Null where no mesh has them. A normal of 0, or a mean of 0, stands for the face's own; a colour
  // of 1 for none. Normals have any length and either side.
  const Real* normal[3][3];  // [vertex][axis]
  const Real* colour[3][3];  // [vertex][channel]
  const Real* alpha[3][1];   // [vertex][0]; null where no material asks for them
  const std::uint32_t* id;

  template <typename Self, typename F>
  static constexpr void ForEachField(Self& self, F f) {
    for (auto& vertex : self.vertex) {
      for (auto& coordinate : vertex) f(coordinate);
    }
  }
};

template <typename Real>
struct SphereArrays {
  using Number = Real;
  static constexpr PrimitiveKind kKind = PrimitiveKind::kSphere;
  static constexpr const char* kName = "sphere";
  static constexpr std::uint32_t kFieldCount = 4;

  std::uint32_t count;
  const Real *center_x, *center_y, *center_z;
  const Real* radius;  // NaN: never hit (stands for radius 0)
  const std::uint32_t* id;

  template <typename Self, typename F>
  static constexpr void ForEachField(Self& self, F f) {
    f(self.center_x), f(self.center_y), f(self.center_z), f(self.radius);
  }
};

template <typename Real>
struct DiskArrays {
  using Number = Real;
  static constexpr PrimitiveKind kKind = PrimitiveKind::kDisk;
  static constexpr const char* kName = "disk";
  static constexpr std::uint32_t kFieldCount = 7;

  std::uint32_t count;
  const Real *center_x, *center_y, *center_z;
  const Real* radius;  // NaN: never hit (stands for radius 0 and for a normal of 0)
  const Real *normal_x, *normal_y, *normal_z;  // of the front, of any length
  const std::uint32_t* id;

  template <typename Self, typename F>
  static constexpr void ForEachField(Self& self, F f) {
    f(self.center_x), f(self.center_y), f(self.center_z), f(self.radius);
    f(self.normal_x), f(self.normal_y), f(self.normal_z);
  }
};

// All kinds share one range of ids.
template <typename Real>
struct GeometryView {
  SphereArrays<Real> spheres;
  TriangleArrays<Real> triangles;
  DiskArrays<Real> disks;
};

// Calls f(arrays) for each kind, in the order of the enumerators.
template <typename View, typename F>
constexpr void ForEachKind(View& geometry, F f) {
  f(geometry.triangles);
  f(geometry.spheres);
  f(geometry.disks);
}

// Calls f(arrays) with empty arrays of a kind, for their type.
template <typename Real, typename F>
constexpr auto WithKind(PrimitiveKind kind, F f) {
  switch (kind) {
    case PrimitiveKind::kTriangle:
      return f(TriangleArrays<Real>{});
    case PrimitiveKind::kSphere:
      return f(SphereArrays<Real>{});
    case PrimitiveKind::kDisk:
      break;
  }
  return f(DiskArrays<Real>{});
}

constexpr const char* NameOf(PrimitiveKind kind) {
  return WithKind<float>(kind, [](auto arrays) { return decltype(arrays)::kName; });
}
constexpr std::uint32_t FieldCountOf(PrimitiveKind kind) {
  return WithKind<float>(kind, [](auto arrays) { return decltype(arrays)::kFieldCount; });
}

// A number a kind.
template <typename Count>
struct CountsByKind {
  Count of[kKindCount] = {};

  constexpr Count& operator[](PrimitiveKind kind) { return of[IndexOf(kind)]; }
  constexpr Count operator[](PrimitiveKind kind) const { return of[IndexOf(kind)]; }
  constexpr Count total() const {
    Count sum = 0;
    for (const Count count : of) sum += count;
    return sum;
  }
  constexpr CountsByKind& operator+=(const CountsByKind& other) {
    for (std::size_t k = 0; k < kKindCount; ++k) of[k] += other.of[k];
    return *this;
  }
  constexpr CountsByKind& operator-=(const CountsByKind& other) {
    for (std::size_t k = 0; k < kKindCount; ++k) of[k] -= other.of[k];
    return *this;
  }
};
using PrimitiveCounts = CountsByKind<std::uint32_t>;

constexpr PrimitiveCounts Narrow(const CountsByKind<std::uint64_t>& counts) {
  PrimitiveCounts narrow;
  for (std::size_t k = 0; k < kKindCount; ++k) {
    narrow.of[k] = static_cast<std::uint32_t>(counts.of[k]);
  }
  return narrow;
}

// Which primitive: its kind and its index into the kind's arrays, in a word.
inline constexpr std::uint32_t kIndexBits = 26;
inline constexpr std::uint32_t kMaxTreePrimitives = 1u << kIndexBits;  // of each kind
inline constexpr std::uint32_t kKindMask = 3;
static_assert(kKindCount <= kKindMask + 1);

constexpr std::uint32_t MakePlace(PrimitiveKind kind, std::uint32_t index) {
  return static_cast<std::uint32_t>(kind) << kIndexBits | index;
}
constexpr PrimitiveKind KindOf(std::uint32_t place) {
  return static_cast<PrimitiveKind>(place >> kIndexBits & kKindMask);
}
constexpr std::uint32_t IndexIn(std::uint32_t place) { return place & (kMaxTreePrimitives - 1); }

}  // namespace sheaf

#endif  // SHEAF_SIMD_PRIMITIVES_H_
