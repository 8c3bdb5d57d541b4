// Lane types and three-vectors that every kernel shares.
//
// x, y and z are separate vectors, because a struct cannot hold a vector of unknown size (SVE).
// Sums associate as in src/scalar/vec3.h; Mul and Add are never fused (-ffp-contract=off).
#if defined(SHEAF_SIMD_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_MATH_INL_H_
#undef SHEAF_SIMD_MATH_INL_H_
#else
#define SHEAF_SIMD_MATH_INL_H_
#endif

#include <cstdint>
#include <type_traits>

#include "hwy/highway.h"
#include "simd/arithmetic.h"
#include "simd/streams.h"

// A lambda in a hot loop: on the target, and inlined, which compilers do not always do unasked.
#ifndef SHEAF_LAMBDA
#define SHEAF_LAMBDA HWY_ATTR __attribute__((always_inline))
#endif

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <typename Real>
using Lanes = hn::CappedTag<Real, kMaxLanes>;

// What float cannot hold exactly enough is computed in double, half a vector at a time. `WideLanes`
// has those lanes and `NarrowLanes` as many of Real. For double, and where the arithmetic is fast,
// both are the whole vector of Real.
template <typename Real>
inline constexpr bool kHasWide = std::is_same_v<Real, float> && !kIsFast;
template <typename Real>
using WideLanes =
    std::conditional_t<kHasWide<Real>, hn::CappedTag<double, kMaxLanes / 2>, Lanes<Real>>;
template <typename Real>
using NarrowLanes = hn::Rebind<Real, WideLanes<Real>>;

HWY_INLINE hn::Vec<WideLanes<float>> Widen(hn::Vec<NarrowLanes<float>> v) {
#ifdef SHEAF_FAST
  return v;
#else
  return hn::PromoteTo(WideLanes<float>(), v);
#endif
}
HWY_INLINE hn::Vec<WideLanes<double>> Widen(hn::Vec<WideLanes<double>> v) { return v; }

template <typename Real, class V>
HWY_INLINE hn::Vec<NarrowLanes<Real>> Narrow(V v) {
  if constexpr (kHasWide<Real>) {
    const NarrowLanes<float> d;
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
    // There DemoteTo gives the largest float for what overflows, everywhere else infinity.
    double wide[kMaxLanes];
    float narrow[kMaxLanes];
    hn::StoreU(v, WideLanes<float>(), wide);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) narrow[i] = static_cast<float>(wide[i]);
    return hn::LoadU(d, narrow);
#else
    return hn::DemoteTo(d, v);
#endif
  } else {
    return v;
  }
}

template <class D>
HWY_INLINE std::uint32_t LaneCount(D d) {
  return static_cast<std::uint32_t>(hn::Lanes(d));
}

// Identifiers are 32 bit in memory and as wide as the lanes in registers.
template <class D>
using IdLanes = hn::RebindToUnsigned<D>;

template <class D>
HWY_INLINE hn::Vec<IdLanes<D>> LoadIds(D /*d*/, const std::uint32_t* ids) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::LoadU(IdLanes<D>(), ids);
  } else {
    return hn::PromoteTo(IdLanes<D>(), hn::LoadU(hn::Rebind<std::uint32_t, D>(), ids));
  }
}

template <class D, class V>
HWY_INLINE void StoreIds(D /*d*/, V v, std::uint32_t* ids) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    hn::StoreU(v, IdLanes<D>(), ids);
  } else {
    const hn::Rebind<std::uint32_t, D> d32;
    hn::StoreU(hn::TruncateTo(d32, v), d32, ids);
  }
}

// array[ids[lane]] for a whole vector of ids.
template <class D, class V>
HWY_INLINE hn::Vec<D> GatherAt(D d, const hn::TFromD<D>* HWY_RESTRICT array, V ids) {
  return hn::GatherIndex(d, array, hn::BitCast(hn::RebindToSigned<D>(), ids));
}

// Elements of arrays at the ids of one vector. Ids that follow one another, as those of
// neighbouring rays mostly do, are loaded as one piece; ids that are all the same, as those of what
// such rays hit, as one number.
enum class IdPattern { kRun, kSame, kAny };

// `ids` points at the ids of `lanes` lanes, of which the first `wanted` count.
HWY_INLINE IdPattern PatternOf(const std::uint32_t* ids, std::uint32_t lanes,
                               std::uint32_t wanted) {
  if (wanted < lanes) return IdPattern::kAny;
  std::uint32_t same = 1, run = 1;
  for (std::uint32_t lane = 1; lane < lanes; ++lane) {
    same &= ids[lane] == ids[0] ? 1u : 0u;
    run &= ids[lane] == ids[0] + lane ? 1u : 0u;
  }
  return same ? IdPattern::kSame : run ? IdPattern::kRun : IdPattern::kAny;
}

template <class D, class V>
HWY_INLINE hn::Vec<D> Fetch(D d, IdPattern pattern, const hn::TFromD<D>* HWY_RESTRICT array,
                            std::uint32_t first, V ids) {
  if (pattern == IdPattern::kRun) return hn::LoadU(d, array + first);
  if (pattern == IdPattern::kSame) return hn::Set(d, array[first]);
  return GatherAt(d, array, ids);
}

template <class D>
HWY_INLINE hn::Mask<D> NoLanes(D d) {
  return hn::MaskFromVec(hn::Zero(d));
}
template <class D>
HWY_INLINE hn::Mask<D> AllLanes(D d) {
  return hn::Eq(hn::Zero(d), hn::Zero(d));
}

// Bit i: lane i.
template <class D>
HWY_INLINE std::uint32_t MaskBits(D d, hn::Mask<D> mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0] | static_cast<std::uint32_t>(bits[1]) << 8;
}

template <class D>
HWY_INLINE hn::Mask<D> LanesFromBits(D d, std::uint32_t bits) {
  const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits),
                                 static_cast<std::uint8_t>(bits >> 8)};
  return hn::LoadMaskBits(d, bytes);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Dot(D /*d*/, V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

// |ax bx| + |ay by| + |az bz|
template <class D, class V = hn::Vec<D>>
HWY_INLINE V AbsDot(D /*d*/, V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Abs(hn::Mul(ax, bx)), hn::Abs(hn::Mul(ay, by))),
                 hn::Abs(hn::Mul(az, bz)));
}

// Fast arithmetic takes the processor's estimates of 1 / x and 1 / sqrt(x), of 12 bits on x86 and 8
// or more elsewhere, and refines them by Newton's method to 2 to 4 ULP. Both give NaN for 0.
#if HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
inline constexpr int kNewtonSteps = 1;
#else
inline constexpr int kNewtonSteps = 2;
#endif

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Divide(D d, V a, V b) {
  if constexpr (kIsFast) {
    V inverse = hn::ApproximateReciprocal(b);
    for (int i = 0; i < kNewtonSteps; ++i) {
      inverse = hn::Mul(inverse, hn::NegMulAdd(b, inverse, hn::Set(d, hn::TFromD<D>(2))));
    }
    return hn::Mul(a, inverse);
  } else {
    return hn::Div(a, b);
  }
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V FastInverseSqrt(D d, V x) {
  const V half = hn::Mul(x, hn::Set(d, hn::TFromD<D>(0.5)));
  V inverse = hn::ApproximateReciprocalSqrt(x);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const V error = hn::NegMulAdd(hn::Mul(half, inverse), inverse, hn::Set(d, hn::TFromD<D>(1.5)));
    inverse = hn::Mul(inverse, error);
  }
  return inverse;
}

// Divides the vector by its length.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void Normalize(D d, V& x, V& y, V& z) {
  const V squared = Dot(d, x, y, z, x, y, z);
  if constexpr (kIsFast) {
    const V scale = FastInverseSqrt(d, squared);
    x = hn::Mul(x, scale);
    y = hn::Mul(y, scale);
    z = hn::Mul(z, scale);
  } else {
    const V length = hn::Sqrt(squared);
    x = hn::Div(x, length);
    y = hn::Div(y, length);
    z = hn::Div(z, length);
  }
}

// NormalizeWide in src/scalar/vec3.h.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void NormalizeWide(D d, V& x, V& y, V& z) {
  if constexpr (kIsFast) return Normalize(d, x, y, z);
  const V scale = hn::Div(hn::Set(d, hn::TFromD<D>(1)), hn::Sqrt(Dot(d, x, y, z, x, y, z)));
  x = hn::Mul(x, scale);
  y = hn::Mul(y, scale);
  z = hn::Mul(z, scale);
}

// Lanes of a batch of `count` that the vector at `i` covers.
template <class D>
HWY_INLINE hn::Mask<D> LanesBelow(D d, std::uint32_t i, std::uint32_t count) {
  return hn::FirstN(d, count - i);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_MATH_INL_H_
