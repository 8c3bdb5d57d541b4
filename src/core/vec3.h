// Three-vectors whose every operation is one correctly rounded IEEE operation, in the order
// written.
//
// The order is part of the specification: the kernels in simd/ repeat it (simd/math-inl.h).
#ifndef SHEAF_CORE_VEC3_H_
#define SHEAF_CORE_VEC3_H_

#include <cmath>

// On functions that return an optional in an inner loop: left to themselves, compilers pass it
// through memory, where loading it whole after storing its parts stalls (a tenth of a scalar
// frame). The baseline is meant to be fast.
#define SHEAF_INLINE [[gnu::always_inline]] inline

namespace sheaf {

// The type in which a quantity is computed whose rounding error in Real would show.
template <typename Real>
struct WideOf {
  using Type = Real;
};
template <>
struct WideOf<float> {
  using Type = double;
};
template <typename Real>
using Wide = typename WideOf<Real>::Type;

template <typename Real>
struct Vec3 {
  Real x, y, z;

  template <typename Other>
  constexpr Vec3<Other> To() const {
    return {static_cast<Other>(x), static_cast<Other>(y), static_cast<Other>(z)};
  }
  constexpr Real operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

template <typename Real>
constexpr Vec3<Real> FromArray(const Real (&a)[3]) {
  return {a[0], a[1], a[2]};
}

template <typename Real>
constexpr Vec3<Real> operator+(Vec3<Real> a, Vec3<Real> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Real>
constexpr Vec3<Real> operator-(Vec3<Real> a, Vec3<Real> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Real>
constexpr Vec3<Real> operator-(Vec3<Real> a) {
  return {-a.x, -a.y, -a.z};
}
template <typename Real>
constexpr Vec3<Real> operator*(Vec3<Real> a, Real s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <typename Real>
constexpr Vec3<Real> operator/(Vec3<Real> a, Real s) {
  return {a.x / s, a.y / s, a.z / s};
}

template <typename Real>
constexpr Real Dot(Vec3<Real> a, Vec3<Real> b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

template <typename Real>
constexpr Vec3<Real> Cross(Vec3<Real> a, Vec3<Real> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// |a.x| |b.x| + |a.y| |b.y| + |a.z| |b.z|: the weight of a componentwise error `b` along `a`.
template <typename Real>
constexpr Real AbsDot(Vec3<Real> a, Vec3<Real> b) {
  return (std::abs(a.x * b.x) + std::abs(a.y * b.y)) + std::abs(a.z * b.z);
}

// Divides rather than multiplying by a reciprocal: 2.4 ULP instead of 2.7 (docs/numerics.md).
template <typename Real>
Vec3<Real> Normalize(Vec3<Real> a) {
  return a / std::sqrt(Dot(a, a));
}

// One division instead of three, where the result is rounded to a narrower type anyway.
template <typename Real>
Vec3<Real> NormalizeWide(Vec3<Real> a) {
  return a * (1 / std::sqrt(Dot(a, a)));
}

}  // namespace sheaf

#endif  // SHEAF_CORE_VEC3_H_
