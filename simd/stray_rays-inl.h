// Strays: rays whose neighbours go another way. They are put aside and sorted by direction, so that
// packets of them share an octant and a dominant axis.
#if defined(SHEAF_SIMD_STRAY_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_STRAY_RAYS_INL_H_
#undef SHEAF_SIMD_STRAY_RAYS_INL_H_
#else
#define SHEAF_SIMD_STRAY_RAYS_INL_H_
#endif

#include <bit>

#include "simd/packet-inl.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// An octant and a dominant axis.
inline constexpr std::uint32_t kDirectionClasses = 8 * 4;  // one axis in four is none

struct StrayRays {
  static constexpr std::uint32_t kCapacity = 2048;

  std::uint32_t count = 0;
  std::uint32_t position[kCapacity];  // in the batch
  std::uint8_t direction_class[kCapacity];
};

// Puts the packet's open rays aside and returns true, unless all are of one class: then they are as
// well where they are. The packet's leaf terms are there; its first ray is at position `first`.
template <typename Real>
HWY_INLINE bool PutAside(const Packet<Real>& packet, std::uint32_t first, StrayRays& strays) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using Id = hn::TFromD<decltype(di)>;
  const std::uint32_t open = OpenLanes(packet);
  if (open == 0) return false;
  alignas(kAlignment) std::uint32_t classes[kPacketSize<Real>];
  const auto of_lane = hn::Or(hn::ShiftLeft<2>(Octants(d, packet)), LoadIds(d, packet.axis));
  StoreIds(d, of_lane, classes);
  const auto one = hn::Set(di, Id{classes[std::countr_zero(open)]});
  const std::uint32_t alike = MaskBits(d, hn::RebindMask(d, hn::Eq(of_lane, one)));
  if ((open & ~alike) == 0) return false;
  for (std::uint32_t rest = open; rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
    strays.position[strays.count] = first + lane;
    strays.direction_class[strays.count] = static_cast<std::uint8_t>(classes[lane]);
    ++strays.count;
  }
  return true;
}

// Positions by class, in their order within a class.
inline void SortByDirection(const StrayRays& strays, std::uint32_t* sorted) {
  std::uint32_t next[kDirectionClasses + 1] = {};
  for (std::uint32_t i = 0; i < strays.count; ++i) ++next[strays.direction_class[i] + 1];
  for (std::uint32_t k = 0; k < kDirectionClasses; ++k) next[k + 1] += next[k];
  for (std::uint32_t i = 0; i < strays.count; ++i) {
    sorted[next[strays.direction_class[i]]++] = strays.position[i];
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_STRAY_RAYS_INL_H_
