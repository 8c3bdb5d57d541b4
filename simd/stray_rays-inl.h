// Strays: rays whose neighbours go another way. They are set aside and sorted by direction, so that
// those of a packet share an octant and a dominant axis, and those of a crowd's list an octant.
#if defined(SHEAF_SIMD_STRAY_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SHEAF_SIMD_STRAY_RAYS_INL_H_
#undef SHEAF_SIMD_STRAY_RAYS_INL_H_
#else
#define SHEAF_SIMD_STRAY_RAYS_INL_H_
#endif

#include <algorithm>
#include <bit>

#include "simd/packet-inl.h"
#include "simd/streams.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

// Each octant with each dominant axis.
inline constexpr std::uint32_t kDirectionClasses = 8 * 4;  // one axis in four is none

struct StrayRays {
  // This lies on the stack, which has room for few. A crowd has arrays for many.
  static constexpr std::uint32_t kFew = 1024, kMany = 4096;
  // Rays from so many positions at most, so that 16 bits hold an offset.
  static constexpr std::uint32_t kSpan = 1u << 16;

  std::uint32_t count = 0;
  std::uint32_t first = 0;    // position in the batch that offsets count from
  std::uint32_t vectors = 0;  // of neighbours that were set aside
  std::uint32_t octants = 0;  // how many each vector's rays see, summed over the vectors
  std::uint32_t capacity = kFew;
  std::uint16_t* offset = few_offsets;
  std::uint8_t* direction_class = few_classes;
  std::uint16_t few_offsets[kFew];
  std::uint8_t few_classes[kFew];

  // Goes on in arrays of kMany.
  void MoveTo(std::uint16_t* offsets, std::uint8_t* classes) {
    std::copy_n(offset, count, offsets);
    std::copy_n(direction_class, count, classes);
    offset = offsets;
    direction_class = classes;
    capacity = kMany;
  }
};

// What became of a vector of rays.
enum class Company { kPacket, kStrays };

// Sets the rays [i, i + lanes) of a batch aside that can hit anything, before a packet is made of
// them. Not if all are of one class: then they make a good packet already.
template <typename Real>
HWY_INLINE Company PutAside(const RayView<Real>& rays, const RayIntervals<Real>& intervals,
                            std::uint32_t i, std::uint32_t count, StrayRays& strays) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using Id = hn::TFromD<decltype(di)>;
  const auto load = [&](const Real* field) SHEAF_LAMBDA { return hn::LoadU(d, field + i); };
  const auto dx = load(rays.direction_x), dy = load(rays.direction_y), dz = load(rays.direction_z);
  const auto traceable =
      IsTraceable(d, load(rays.origin_x), load(rays.origin_y), load(rays.origin_z), dx, dy, dz,
                  LoadTMin(d, intervals, i), LoadTMax(d, intervals, i));
  const std::uint32_t open = MaskBits(d, hn::And(traceable, LanesBelow(d, i, count)));
  // Rays that can hit nothing need a packet too: it writes that they miss.
  if (open != (1u << LaneCount(d)) - 1) return Company::kPacket;
  alignas(kAlignment) std::uint32_t classes[kPacketSize<Real>];
  const auto of_lane =
      hn::Or(hn::ShiftLeft<2>(Octants(d, dx, dy, dz)), DominantAxis(d, dx, dy, dz));
  StoreIds(d, of_lane, classes);
  const auto one = hn::Set(di, Id{classes[0]});
  if (hn::AllTrue(d, hn::RebindMask(d, hn::Eq(of_lane, one)))) return Company::kPacket;
  if (strays.count == 0) strays.first = i;
  std::uint32_t octants = 0;
  for (std::uint32_t lane = 0; lane < LaneCount(d); ++lane) {
    strays.offset[strays.count] = static_cast<std::uint16_t>(i + lane - strays.first);
    strays.direction_class[strays.count] = static_cast<std::uint8_t>(classes[lane]);
    octants |= 1u << (classes[lane] >> 2);
    ++strays.count;
  }
  ++strays.vectors;
  strays.octants += static_cast<std::uint32_t>(std::popcount(octants));
  return Company::kStrays;
}

// Writes the positions sorted by class; within a class they keep their order.
inline void SortByDirection(const StrayRays& strays, std::uint32_t* sorted) {
  std::uint32_t next[kDirectionClasses + 1] = {};
  for (std::uint32_t i = 0; i < strays.count; ++i) ++next[strays.direction_class[i] + 1];
  for (std::uint32_t k = 0; k < kDirectionClasses; ++k) next[k + 1] += next[k];
  for (std::uint32_t i = 0; i < strays.count; ++i) {
    sorted[next[strays.direction_class[i]]++] = strays.first + strays.offset[i];
  }
}

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SHEAF_SIMD_STRAY_RAYS_INL_H_
