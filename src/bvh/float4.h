// Four floats at once, the fourth idle, as plain C++ with the vectors of GCC and clang: what the
// builder needs on any target and no more. Kernels use Highway instead.
#ifndef SHEAF_BVH_FLOAT4_H_
#define SHEAF_BVH_FLOAT4_H_

#include <cstdint>
#include <cstring>
#include <limits>

namespace sheaf::bvh {

using Float4 [[gnu::vector_size(16)]] = float;
using Int4 [[gnu::vector_size(16)]] = std::int32_t;

inline Float4 Load4(const float* from) {
  Float4 v;
  std::memcpy(&v, from, sizeof(v));
  return v;
}
inline Float4 Set4(float x) { return Float4{x, x, x, x}; }
// Both return b where a is NaN.
inline Float4 Min(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 Max(Float4 a, Float4 b) { return a > b ? a : b; }

struct Box4 {
  Float4 lower = Set4(std::numeric_limits<float>::infinity());
  Float4 upper = Set4(-std::numeric_limits<float>::infinity());

  void Include(Float4 low, Float4 high) {
    lower = Min(low, lower);
    upper = Max(high, upper);
  }
  void Include(const Box4& box) { Include(box.lower, box.upper); }
};

// Half the surface of a box whose extents are scaled; scaled so that the largest in sight is about
// 1, no area overflows or vanishes, whatever the scene's units.
inline float HalfArea(const Box4& box, float scale) {
  const Float4 d = (box.upper - box.lower) * scale;
  return d[0] * (d[1] + d[2]) + d[1] * d[2];
}

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_FLOAT4_H_
