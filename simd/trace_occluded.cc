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
  std::uint32_t* occluded;

  // Rays [i, i + lanes).
  HWY_INLINE void Store(const Packet<Real>& packet, std::uint32_t i) const {
    const Lanes<Real> d;
    const IdLanes<Lanes<Real>> di;
    using Id = hn::TFromD<decltype(di)>;
    const auto hit = hn::Ne(LoadIds(d, packet.id), hn::Set(di, kNoPrimitive));
    StoreIds(d, hn::IfThenElseZero(hit, hn::Set(di, Id{1})), occluded + i);
  }

  HWY_INLINE void Scatter(const Packet<Real>& packet, const std::uint32_t* positions,
                          std::uint32_t n) const {
    for (std::uint32_t lane = 0; lane < n; ++lane) {
      occluded[positions[lane]] = packet.id[lane] != kNoPrimitive ? 1 : 0;
    }
  }
};

template <typename Real>
void TraceOccludedLanes(const TreeView<Real>& tree, const RayView<Real>& rays,
                        const RayIntervals<Real>& intervals, std::uint32_t count,
                        Coherence coherence, std::uint32_t* occluded) {
  TraceBatch<Query::kOccluded>(tree, rays, intervals, count, coherence,
                               OcclusionOutput<Real>{occluded});
}

SHEAF_NAME_KERNELS(TraceOccluded);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(TraceOccluded);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
