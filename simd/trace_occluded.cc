#include "simd/trace_occluded.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/trace_occluded.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <typename Real>
struct OcclusionOutput {
  static constexpr Query kQuery = Query::kOccluded;
  std::uint32_t* occluded;

  // Holds the ids of what was hit until Finish.
  HWY_INLINE HitSlots<Real> Slots(std::uint32_t i, Real* t_best, Real* /*det*/) const {
    return {t_best, nullptr, nullptr, nullptr, occluded + i};
  }
  template <class D>
  HWY_INLINE void Clear(D d, std::uint32_t i, Real* /*det*/) const {
    StoreIds(d, hn::Set(IdLanes<D>(), kNoPrimitive), occluded + i);
  }
  template <class D>
  HWY_INLINE void Finish(D d, std::uint32_t i, const Real* /*t_best*/, const Real* /*det*/) const {
    StoreWhether(d, i, LoadIds(d, occluded + i));
  }

  // Rays [i, i + lanes).
  HWY_INLINE void Store(const Packet<Real>& packet, std::uint32_t i) const {
    const Lanes<Real> d;
    StoreWhether(d, i, LoadIds(d, packet.id));
  }

  HWY_INLINE void Scatter(const Packet<Real>& packet, const std::uint32_t* positions,
                          std::uint32_t n) const {
    for (std::uint32_t lane = 0; lane < n; ++lane) {
      occluded[positions[lane]] = packet.id[lane] != kNoPrimitive ? 1 : 0;
    }
  }

  template <class D, class VI>
  HWY_INLINE void StoreWhether(D d, std::uint32_t i, VI id) const {
    const IdLanes<D> di;
    using Id = hn::TFromD<IdLanes<D>>;
    const auto hit = hn::Ne(id, hn::Set(di, kNoPrimitive));
    StoreIds(d, hn::IfThenElseZero(hit, hn::Set(di, Id{1})), occluded + i);
  }
};

template <typename Real>
void TraceOccludedLanes(const TreeView<Real>& tree, const RayView<Real>& rays,
                        const RayIntervals<Real>& intervals, std::uint32_t count,
                        Coherence coherence, std::uint32_t* occluded) {
  const OcclusionOutput<Real> output{occluded};
  BeamStack<Real> stack;
  TraceBatch(Batch<OcclusionOutput<Real>, Real>{tree, rays, intervals, count, output, stack},
             coherence);
}

SHEAF_NAME_KERNELS(TraceOccluded);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(TraceOccluded);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
