// The oracle of the tests: geometry of float numbers in 113 bits.
//
// Long double does not suffice: at 10^6 radii b^2 - a c loses 40 bits to cancellation and near
// tangency 10 to 24 more, which of 64 would leave fewer than a float has.
#ifndef SHEAF_TESTS_EXACT_H_
#define SHEAF_TESTS_EXACT_H_

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "src/scalar/ray.h"

namespace sheaf {

using Exact = __float128;

// Two of Newton's steps take the 53 bits of the double root past 113.
inline Exact Sqrt(Exact x) {
  if (x <= 0) return 0;
  Exact root = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 2; ++i) root = (root + x / root) / 2;
  return root;
}

// g++ 12 widens a float that it still has as a double without rounding it first; through memory it
// cannot.
inline Vec3<float> Rounded(Vec3<double> v) {
  volatile float numbers[3] = {static_cast<float>(v.x), static_cast<float>(v.y),
                               static_cast<float>(v.z)};
  return {numbers[0], numbers[1], numbers[2]};
}

inline Exact Abs(Exact x) { return x < 0 ? -x : x; }

inline Vec3<Exact> Unit(Vec3<Exact> v) { return v * (1 / Sqrt(Dot(v, v))); }

// Error in units of the last place of a Real of the exact result's size.
template <typename Real>
double UlpsOff(Real got, Exact exact) {
  using Limits = std::numeric_limits<Real>;
  int exponent = 0;
  std::frexp(static_cast<double>(exact), &exponent);
  const double last = std::ldexp(1.0, std::max(exponent, Limits::min_exponent) - Limits::digits);
  return static_cast<double>(Abs(static_cast<Exact>(got) - exact)) / last;
}

struct ExactRoots {
  Exact near, far;
};

// What the line of a ray and a sphere have to do with each other, of the numbers as they stand.
struct ExactLine {
  Exact a, b, c;   // a t^2 - 2 b t + c = 0
  Exact l2;        // squared distance of the line from the centre
  Exact f_length;  // of the origin from the centre

  ExactLine(const scalar::Ray<float>& ray, Vec3<float> center, float radius) {
    const Vec3<Exact> f = ray.origin.To<Exact>() - center.To<Exact>();
    const Vec3<Exact> d = ray.direction.To<Exact>();
    const Exact r = radius, f2 = Dot(f, f);
    a = Dot(d, d), b = -Dot(f, d), c = f2 - r * r;
    l2 = f2 - b * b / a;
    f_length = Sqrt(f2);
  }
  std::optional<ExactRoots> Roots() const {
    const Exact discriminant = b * b - a * c;
    if (discriminant < 0) return std::nullopt;
    const Exact root = Sqrt(discriminant);
    // The root without cancellation first.
    const Exact q = b >= 0 ? b + root : b - root;
    if (b >= 0) return ExactRoots{c / q, q / a};
    return ExactRoots{q / a, c / q};
  }
};

// A ray and a triangle's plane.
struct ExactPlaneHit {
  Exact t;
  Vec3<Exact> point;
  Exact u, v;          // barycentric weights of the second and third vertex
  Vec3<Exact> normal;  // unit
  double cosine;       // of the ray with the normal, >= 0
  bool is_inside;      // edges included
};

inline ExactPlaneHit IntersectExactly(const scalar::Ray<float>& ray,
                                      const Vec3<float> (&vertex)[3]) {
  const Vec3<Exact> a = vertex[0].To<Exact>();
  const Vec3<Exact> ab = vertex[1].To<Exact>() - a, ac = vertex[2].To<Exact>() - a;
  const Vec3<Exact> n = Cross(ab, ac), normal = Unit(n);
  const Vec3<Exact> o = ray.origin.To<Exact>(), d = ray.direction.To<Exact>();
  const Exact t = Dot(n, a - o) / Dot(n, d);
  const Vec3<Exact> point = o + d * t;
  const Exact area = Dot(n, n);
  const Exact u = Dot(Cross(point - a, ac), n) / area, v = Dot(Cross(ab, point - a), n) / area;
  const double cosine = static_cast<double>(Abs(Dot(normal, Unit(d))));
  return {t, point, u, v, normal, cosine, u >= 0 && v >= 0 && u + v <= 1};
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_EXACT_H_
