// Axes around directions: src/scalar/frame.h.
#if defined(SHEAF_SIMD_FRAME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_FRAME_INL_H_
#undef SHEAF_SIMD_FRAME_INL_H_
#else
#define SHEAF_SIMD_FRAME_INL_H_
#endif

#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// The axes x and y of the frame whose third is the unit vector (nx, ny, nz).
template <class D, class V = hn::Vec<D>>
HWY_INLINE void MakeFrame(D d, V nx, V ny, V nz, V& xx, V& xy, V& xz, V& yx, V& yy, V& yz) {
  const V one = hn::Set(d, hn::TFromD<D>(1));
  const V sign = hn::CopySign(one, nz);
  const V a = hn::Div(hn::Set(d, hn::TFromD<D>(-1)), hn::Add(sign, nz));
  const V b = hn::Mul(hn::Mul(nx, ny), a);
  xx = hn::Add(one, hn::Mul(sign, hn::Mul(hn::Mul(nx, nx), a)));
  xy = hn::Mul(sign, b);
  xz = hn::Neg(hn::Mul(sign, nx));
  yx = b;
  yy = hn::Add(sign, hn::Mul(hn::Mul(ny, ny), a));
  yz = hn::Neg(ny);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_FRAME_INL_H_
