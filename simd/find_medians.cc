#include "simd/find_medians.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/find_medians.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// As scalar::MedianOfSix, network and all.
template <typename Real>
void FindMediansLanes(const Real* numbers, std::ptrdiff_t step, std::uint32_t count,
                      Real* medians) {
  const Lanes<Real> d;
  using V = hn::Vec<Lanes<Real>>;
  const auto order = [](V& low, V& high) SHEAF_LAMBDA {
    const V least = hn::Min(low, high);
    high = hn::Max(low, high);
    low = least;
  };
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const auto load = [&](std::ptrdiff_t k)
                          SHEAF_LAMBDA { return hn::LoadU(d, numbers + i + k * step); };
    V v0 = load(0), v1 = load(1), v2 = load(2), v3 = load(3), v4 = load(4), v5 = load(5);
    order(v0, v1);
    order(v2, v3);
    order(v4, v5);
    order(v0, v2);
    order(v0, v4);
    order(v3, v5);
    order(v1, v5);
    order(v1, v2);
    order(v3, v4);
    order(v1, v3);
    order(v2, v4);
    hn::StoreU(hn::Mul(hn::Add(v2, v3), hn::Set(d, Real(0.5))), d, medians + i);
  }
}
SHEAF_NAME_KERNELS(FindMedians);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(FindMedians);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
