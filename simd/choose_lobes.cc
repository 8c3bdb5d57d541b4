#include "simd/choose_lobes.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/choose_lobes.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/children-inl.h"
#include "simd/dispatch.h"
#include "simd/material-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

template <class V>
HWY_INLINE V LargestOf(V x, V y, V z) {
  const V xy = hn::IfThenElse(hn::Gt(x, y), x, y);
  return hn::IfThenElse(hn::Gt(xy, z), xy, z);
}

template <typename Real>
void ChooseLobesLanes(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                      const PathView<Real>& parents, const SampleView<Real>& points,
                      Roulette roulette, std::uint32_t count, const SurfaceOutput<Real>& choices) {
  const Lanes<Real> d;
  const IdLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  const V zero = hn::Zero(d), one = hn::Set(d, Real(1));
  const bool transmits = (material.needs & kNeedsTransmission) != 0;
  const Real* const reflects[3] = {surfaces.reflect_r, surfaces.reflect_g, surfaces.reflect_b};
  const Real* const transmits_at[3] = {surfaces.transmit_r, surfaces.transmit_g,
                                       surfaces.transmit_b};
  Splits<Real> splits;
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    const std::uint32_t in_block = i % kBlock;
    if (in_block == 0) FillBlock(material, surfaces, i, std::min(kBlock, count - i), splits);
    const auto ids = hn::RebindMask(di, LanesBelow(d, i, count));
    const auto parent = hn::IfThenElseZero(ids, LoadIds(d, surfaces.ray + i));
    const auto throughput = [&](const Real* HWY_RESTRICT throughputs) HWY_ATTR {
      return throughputs ? GatherAt(d, throughputs, parent) : one;
    };
    const V throughput_r = throughput(parents.throughput_r);
    const V throughput_g = throughput(parents.throughput_g);
    const V throughput_b = throughput(parents.throughput_b);
    V reflectance = zero;
    auto is_total = AllLanes(d);
    if (transmits) {
      reflectance = hn::Load(d, splits.reflectance + in_block);
      is_total = hn::Lt(hn::Load(d, splits.cos_t + in_block), zero);
    }
    const auto transmit = [&](int channel) HWY_ATTR {
      return LoadTerm(d, material, material.transmit[channel], transmits_at[channel], i);
    };
    const auto reflect_at = [&](V parent_throughput, int channel) HWY_ATTR {
      const V own = LoadTerm(d, material, material.reflect[channel], reflects[channel], i);
      return hn::Mul(parent_throughput, hn::Add(own, hn::Mul(transmit(channel), reflectance)));
    };
    const auto refract_at = [&](V parent_throughput, int channel) HWY_ATTR {
      const V share = hn::Mul(transmit(channel), hn::Sub(one, reflectance));
      return hn::Mul(parent_throughput, hn::IfThenZeroElse(is_total, share));
    };
    V r = zero, g = zero, b = zero;
    LoadBaseColour(d, material, surfaces, i, r, g, b);
    const V kd = hn::IfThenElseZero(HasLocalLight(d, material, surfaces, i),
                                    LoadTerm(d, material, material.kd, surfaces.kd, i));
    const V reflect = LargestOf(reflect_at(throughput_r, 0), reflect_at(throughput_g, 1),
                                reflect_at(throughput_b, 2));
    const V refract = LargestOf(refract_at(throughput_r, 0), refract_at(throughput_g, 1),
                                refract_at(throughput_b, 2));
    const V diffuse =
        LargestOf(hn::Mul(throughput_r, hn::Mul(kd, r)), hn::Mul(throughput_g, hn::Mul(kd, g)),
                  hn::Mul(throughput_b, hn::Mul(kd, b)));
    const V through = hn::Add(reflect, refract), all = hn::Add(through, diffuse);
    V survival = one;
    if (roulette == Roulette::kOn) {
      const V least = hn::Set(d, kLeastSurvival<Real>);
      const V dim = hn::IfThenElse(hn::Gt(all, least), all, least);
      survival = hn::IfThenElse(hn::Lt(all, one), dim, one);
    }
    const V likely = hn::Div(hn::Mul(diffuse, survival), all);
    hn::StoreU(hn::IfThenElseZero(hn::Gt(all, zero), likely), d, choices.scatter + i);
    const V pick = hn::Div(hn::Mul(hn::LoadU(d, points.u + i), all), survival);
    const auto reflects_here = hn::Lt(pick, reflect);
    const auto goes_through = hn::AndNot(reflects_here, hn::Lt(pick, through));
    const auto scatters = hn::AndNot(hn::Or(reflects_here, goes_through), hn::Lt(pick, all));
    const auto store = [&](auto lanes, V lobe, Real* HWY_RESTRICT to) HWY_ATTR {
      const V share = hn::Div(all, hn::Mul(lobe, survival));
      hn::StoreU(hn::IfThenElseZero(lanes, share), d, to + i);
    };
    store(reflects_here, reflect, choices.choice_reflect);
    store(goes_through, refract, choices.choice_refract);
    store(scatters, diffuse, choices.choice_diffuse);
  }
}
SHEAF_NAME_KERNELS(ChooseLobes);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(ChooseLobes);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
