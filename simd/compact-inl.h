// Compaction: storing some lanes of a vector without gaps.
//
// Highway 1.0.3's Compress copies its table to the stack on every call when g++ 12 compiles it for
// targets below AVX-512 (128 words; a third of a frame). There, a table of our own and one look-up
// a vector serve all fields.
#if defined(SHEAF_SIMD_COMPACT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_COMPACT_INL_H_
#undef SHEAF_SIMD_COMPACT_INL_H_
#else
#define SHEAF_SIMD_COMPACT_INL_H_
#endif

#include "simd/compact_table.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <class D>
HWY_INLINE std::uint32_t CountLanes(D d, hn::Mask<D> lanes) {
  return static_cast<std::uint32_t>(hn::CountTrue(d, lanes));
}

#if HWY_MAX_BYTES <= 32

// How the lanes of `kept` move to the front: to be passed to CompactStore for each field.
template <class D>
HWY_INLINE auto CompactOrder(D d, hn::Mask<D> kept) {
  static_assert(HWY_MAX_BYTES / sizeof(float) <= 8, "kCompactTable has eight lanes");
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, kept, bits);
  const hn::Rebind<std::uint8_t, D> d8;
  const hn::Rebind<std::int32_t, D> d32;
  const auto lanes = hn::PromoteTo(d32, hn::LoadU(d8, kCompactTable.lane[bits[0]].data()));
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::IndicesFromVec(d, lanes);
  } else {
    return hn::IndicesFromVec(d, hn::PromoteTo(hn::RebindToSigned<D>(), lanes));
  }
}

template <class D, class Order>
HWY_INLINE hn::Vec<D> Compact(D /*d*/, hn::Vec<D> v, Order order) {
  return hn::TableLookupLanes(v, order);
}

#else

// AVX-512 and wide vectors compact by mask.
template <class D>
HWY_INLINE auto CompactOrder(D /*d*/, hn::Mask<D> kept) {
  return kept;
}

template <class D, class Order>
HWY_INLINE hn::Vec<D> Compact(D /*d*/, hn::Vec<D> v, Order order) {
  return hn::Compress(v, order);
}

#endif

// Stores the kept lanes, and rubbish up to a whole vector. StoreU, because a compress-store takes
// tens of nanoseconds on some processors (Zen 4).
template <class D, class Order>
HWY_INLINE void CompactStore(D d, hn::Vec<D> v, Order order, hn::TFromD<D>* to) {
  hn::StoreU(Compact(d, v, order), d, to);
}
template <class D, class Order>
HWY_INLINE void CompactStoreIds(D d, hn::Vec<IdLanes<D>> v, Order order, std::uint32_t* to) {
  StoreIds(d, hn::BitCast(IdLanes<D>(), Compact(d, hn::BitCast(d, v), order)), to);
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_COMPACT_INL_H_
