// Reduces a square of numbers row by row: as many rows as the target has lanes, each to one number.
// All rows together take twice as many shuffles as a single row takes lanes.
#if defined(SHEAF_SIMD_REDUCE_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_REDUCE_ROWS_INL_H_
#undef SHEAF_SIMD_REDUCE_ROWS_INL_H_
#else
#define SHEAF_SIMD_REDUCE_ROWS_INL_H_
#endif

#include <cstddef>

#include "simd/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

struct MinOp {
  template <class D, class V>
  static HWY_INLINE V Of(D /*d*/, V a, V b) {
    return hn::Min(a, b);
  }
  template <class D, class V>
  static HWY_INLINE V OfLanes(D d, V v) {
    return hn::MinOfLanes(d, v);
  }
};
struct MaxOp {
  template <class D, class V>
  static HWY_INLINE V Of(D /*d*/, V a, V b) {
    return hn::Max(a, b);
  }
  template <class D, class V>
  static HWY_INLINE V OfLanes(D d, V v) {
    return hn::MaxOfLanes(d, v);
  }
};

#if HWY_TARGET == HWY_SCALAR || HWY_HAVE_SCALABLE

// Lane k is row k reduced. Rows are not NaN.
template <class Op, class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> ReduceRows(D d, const Real (*rows)[kPacketSize<Real>]) {
  alignas(kAlignment) Real reduced[kPacketSize<Real>];
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) {
    reduced[k] = hn::GetLane(Op::OfLanes(d, hn::Load(d, rows[k])));
  }
  return hn::Load(d, reduced);
}

#else

// One block of 16 bytes, as many rows as it has lanes: lane i of the result's every block is what
// is left of row i in that block.
template <class Op, class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> ReduceInBlocks(D d, const Real (*rows)[kPacketSize<Real>]) {
  const auto merge = [&](const Real* a, const Real* b) SHEAF_LAMBDA {
    const auto x = hn::Load(d, a), y = hn::Load(d, b);
    return Op::Of(d, hn::InterleaveLower(d, x, y), hn::InterleaveUpper(d, x, y));
  };
  if constexpr (sizeof(Real) == 8) {
    return merge(rows[0], rows[1]);
  } else {
    const hn::Repartition<double, D> pairs;
    const auto x = hn::BitCast(pairs, merge(rows[0], rows[1]));
    const auto y = hn::BitCast(pairs, merge(rows[2], rows[3]));
    return Op::Of(d, hn::BitCast(d, hn::InterleaveLower(pairs, x, y)),
                  hn::BitCast(d, hn::InterleaveUpper(pairs, x, y)));
  }
}

// Lane k is row k reduced. Rows are not NaN.
template <class Op, class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> ReduceRows(D d, const Real (*rows)[kPacketSize<Real>]) {
  constexpr std::size_t kBlock = 16 / sizeof(Real);
  const auto block = [&](std::size_t i)
                         SHEAF_LAMBDA { return ReduceInBlocks<Op>(d, rows + i * kBlock); };
  const auto merge_halves = [&](auto x, auto y) SHEAF_LAMBDA {
    return Op::Of(d, hn::ConcatLowerLower(d, y, x), hn::ConcatUpperUpper(d, y, x));
  };
  if constexpr (kPacketSize<Real> == kBlock) {
    return block(0);
  } else if constexpr (kPacketSize<Real> == 2 * kBlock) {
    return merge_halves(block(0), block(1));
  } else {
    static_assert(kPacketSize<Real> == 4 * kBlock);
    const auto x = merge_halves(block(0), block(2)), y = merge_halves(block(1), block(3));
    return Op::Of(d, hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y), x),
                  hn::OddEvenBlocks(y, hn::SwapAdjacentBlocks(x)));
  }
}

#endif

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_REDUCE_ROWS_INL_H_
