#include "simd/trace_closest.h"

// Highway compiles the file once a target: it includes itself through foreach_target.h.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/trace_closest.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE {

template <typename Real>
struct ClosestOutput {
  static constexpr Query kQuery = Query::kClosest;
  const RayIntervals<Real>& intervals;
  const HitOutput<Real>& hits;

  // Where the hits of rays [i, i + lanes) are kept until Finish, after Clear.
  HWY_INLINE HitSlots<Real> Slots(std::uint32_t i, Real* t_best, Real* det) const {
    return {t_best, hits.u + i, hits.v + i, det, hits.primitive + i};
  }
  template <class D>
  HWY_INLINE void Clear(D d, std::uint32_t i, Real* det) const {
    hn::Store(hn::Set(d, 1), d, det);
    hn::StoreU(hn::Zero(d), d, hits.u + i);
    hn::StoreU(hn::Zero(d), d, hits.v + i);
    StoreIds(d, hn::Set(IdLanes<D>(), kNoPrimitive), hits.primitive + i);
  }
  template <class D>
  HWY_INLINE void Finish(D d, std::uint32_t i, const Real* t_best, const Real* det) const {
    StoreSurfaceCoordinates(d, i, hn::LoadU(d, hits.u + i), hn::LoadU(d, hits.v + i),
                            hn::Load(d, det));
    StoreT(d, i, LoadIds(d, hits.primitive + i), hn::Load(d, t_best));
  }

  // Rays [i, i + lanes), once they are traced.
  HWY_INLINE void Store(const Packet<Real>& packet, std::uint32_t i) const {
    const Lanes<Real> d;
    const auto id = LoadIds(d, packet.id);
    StoreT(d, i, id, hn::Load(d, packet.t_best));
    StoreSurfaceCoordinates(d, i, hn::Load(d, packet.u), hn::Load(d, packet.v),
                            hn::Load(d, packet.det));
    StoreIds(d, id, hits.primitive + i);
  }

  // Traceable rays: t_best is t_max where one missed.
  HWY_INLINE void Scatter(const Packet<Real>& packet, const std::uint32_t* positions,
                          std::uint32_t n) const {
    const Lanes<Real> d;
    const auto det = hn::Load(d, packet.det);
    alignas(kAlignment) Real u[kPacketSize<Real>], v[kPacketSize<Real>];
    hn::Store(FinishSurfaceCoordinates(d, hn::Load(d, packet.u), det), d, u);
    hn::Store(FinishSurfaceCoordinates(d, hn::Load(d, packet.v), det), d, v);
    for (std::uint32_t lane = 0; lane < n; ++lane) {
      const std::uint32_t i = positions[lane];
      hits.t[i] = packet.t_best[lane];
      hits.u[i] = u[lane];
      hits.v[i] = v[lane];
      hits.primitive[i] = packet.id[lane];
    }
  }

  template <class D, class V>
  HWY_INLINE void StoreSurfaceCoordinates(D d, std::uint32_t i, V u, V v, V det) const {
    hn::StoreU(FinishSurfaceCoordinates(d, u, det), d, hits.u + i);
    hn::StoreU(FinishSurfaceCoordinates(d, v, det), d, hits.v + i);
  }
  template <class D, class VI, class V>
  HWY_INLINE void StoreT(D d, std::uint32_t i, VI id, V t) const {
    const auto missed = hn::RebindMask(d, hn::Eq(id, hn::Set(IdLanes<D>(), kNoPrimitive)));
    hn::StoreU(hn::IfThenElse(missed, LoadTMax(d, intervals, i), t), d, hits.t + i);
  }
};

template <typename Real>
void TraceClosestLanes(const TreeView<Real>& tree, const RayView<Real>& rays,
                       const RayIntervals<Real>& intervals, std::uint32_t count,
                       Coherence coherence, const HitOutput<Real>& hits) {
  const ClosestOutput<Real> output{intervals, hits};
  BeamStack<Real> stack;
  TraceBatch(Batch<ClosestOutput<Real>, Real>{tree, rays, intervals, count, output, stack},
             coherence);
}

SHEAF_NAME_KERNELS(TraceClosest);

}  // namespace sheaf::SHEAF_SIMD::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::SHEAF_SIMD {
SHEAF_EXPORT(TraceClosest);
}  // namespace sheaf::SHEAF_SIMD
#endif  // HWY_ONCE
