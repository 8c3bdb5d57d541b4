#include "simd/sample_texture.h"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/sample_texture.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

// Indices of texels are 32 bit whatever the lanes are.
template <class D>
using IndexLanes = hn::Rebind<std::int32_t, D>;
template <class D>
using TexelLanes = hn::Rebind<std::uint32_t, D>;

// Of whole numbers.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<IndexLanes<D>> ToIndices(D /*d*/, V v) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::ConvertTo(IndexLanes<D>(), v);
  } else {
    return hn::DemoteTo(IndexLanes<D>(), v);
  }
}
template <class D, class VI>
HWY_INLINE hn::Vec<D> ToReals(D d, VI v) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::ConvertTo(d, v);
  } else {
    return hn::PromoteTo(d, v);
  }
}

template <class D, class VI>
HWY_INLINE hn::Vec<D> GatherReals(D d, const hn::TFromD<D>* HWY_RESTRICT array, VI indices) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::GatherIndex(d, array, indices);
  } else {
    return hn::GatherIndex(d, array, hn::PromoteTo(hn::RebindToSigned<D>(), indices));
  }
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V WrapCoordinate(D d, TextureWrap wrap, V x) {
  using Real = hn::TFromD<D>;
  const V one = hn::Set(d, Real(1)), two = hn::Set(d, Real(2));
  if (wrap == TextureWrap::kRepeat) return hn::Sub(x, hn::Floor(x));
  if (wrap == TextureWrap::kMirror) {
    const V within = hn::Sub(x, hn::Mul(two, hn::Floor(hn::Div(x, two))));
    return hn::IfThenElse(hn::Gt(within, one), hn::Sub(two, within), within);
  }
  return hn::IfThenElseZero(hn::Gt(x, hn::Zero(d)), hn::IfThenElse(hn::Lt(x, one), x, one));
}

template <class DI, class VI = hn::Vec<DI>>
HWY_INLINE VI WrapTexel(DI di, TextureWrap wrap, VI i, VI count) {
  const VI zero = hn::Zero(di), last = hn::Sub(count, hn::Set(di, 1));
  const bool repeats = wrap == TextureWrap::kRepeat;
  const VI above = hn::IfThenElse(hn::Gt(i, last), repeats ? zero : last, i);
  return hn::IfThenElse(hn::Lt(i, zero), repeats ? last : zero, above);
}

// The four texels around a vector of places, and the shares of the right and of the lower ones.
template <typename Real>
struct Corners {
  alignas(kAlignment) std::uint32_t texel[4][kMaxLanes];  // upper left and right, lower ones
  alignas(kAlignment) Real right[kMaxLanes], low[kMaxLanes];
};

// The texels of a vector of levels, of which level 0 lies elsewhere.
template <class D, class VI, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<TexelLanes<D>> FetchTexels(D /*d*/, const TextureData<Real>& texture, VI level,
                                              VI index) {
  const IndexLanes<D> di;
  const TexelLanes<D> du;
  const auto fine = hn::Eq(level, hn::Zero(di));
  if (hn::AllTrue(di, fine)) return hn::GatherIndex(du, texture.texels, index);
  const auto coarse = hn::GatherIndex(du, texture.coarse, hn::IfThenZeroElse(fine, index));
  if (hn::AllFalse(di, fine)) return coarse;
  const auto image = hn::GatherIndex(du, texture.texels, hn::IfThenElseZero(fine, index));
  return hn::IfThenElse(hn::RebindMask(du, fine), image, coarse);
}

// MixTexels of src/scalar/sample_texture.h, as far as the texels; (u, v) is wrapped.
template <class D, class VI, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void FindCorners(D d, const TextureData<Real>& texture, VI level, V u, V v,
                            Corners<Real>& corners) {
  const IndexLanes<D> di;
  const TexelLanes<D> du;
  const VI width = hn::GatherIndex(di, texture.levels.width, level);
  const VI height = hn::GatherIndex(di, texture.levels.height, level);
  const VI first = hn::GatherIndex(di, texture.levels.first, level);
  const V x = hn::Mul(u, ToReals(d, width)), y = hn::Mul(v, ToReals(d, height));
  const auto fetch = [&](VI column, VI row) SHEAF_LAMBDA {
    return FetchTexels(d, texture, level, hn::Add(hn::Add(first, hn::Mul(row, width)), column));
  };
  const auto column = [&](VI i) SHEAF_LAMBDA { return WrapTexel(di, texture.wrap_u, i, width); };
  const auto row = [&](VI i) SHEAF_LAMBDA { return WrapTexel(di, texture.wrap_v, i, height); };
  if (texture.filter == TextureFilter::kNearest) {
    const auto texel = fetch(column(ToIndices(d, hn::Floor(x))), row(ToIndices(d, hn::Floor(y))));
    hn::StoreU(texel, du, corners.texel[0]);
    return;
  }
  const V half = hn::Set(d, Real(0.5));
  const V from_x = hn::Sub(x, half), from_y = hn::Sub(y, half);
  const V left = hn::Floor(from_x), top = hn::Floor(from_y);
  hn::StoreU(hn::Sub(from_x, left), d, corners.right);
  hn::StoreU(hn::Sub(from_y, top), d, corners.low);
  const VI i = ToIndices(d, left), j = ToIndices(d, top), one = hn::Set(di, 1);
  const VI x0 = column(i), x1 = column(hn::Add(i, one));
  const VI y0 = row(j), y1 = row(hn::Add(j, one));
  hn::StoreU(fetch(x0, y0), du, corners.texel[0]);
  hn::StoreU(fetch(x1, y0), du, corners.texel[1]);
  hn::StoreU(fetch(x0, y1), du, corners.texel[2]);
  hn::StoreU(fetch(x1, y1), du, corners.texel[3]);
}

// A channel of the corners' texels, mixed. `channel` 3 is alpha.
template <class D, typename Real = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> MixCorners(D d, const TextureData<Real>& texture,
                                 const Corners<Real>& corners, int channel) {
  using V = hn::Vec<D>;
  const IndexLanes<D> di;
  const TexelLanes<D> du;
  const auto value = [&](int corner) SHEAF_LAMBDA -> V {
    const auto texel = hn::Load(du, corners.texel[corner]);
    const auto byte =
        hn::BitCast(di, hn::And(hn::ShiftRightSame(texel, 8 * channel), hn::Set(du, 255u)));
    if (channel == 3) return hn::Div(ToReals(d, byte), hn::Set(d, Real(255)));
    return GatherReals(d, texture.decode, byte);
  };
  if (texture.filter == TextureFilter::kNearest) return value(0);
  const auto mix = [](V a, V b, V share)
                       SHEAF_LAMBDA { return hn::Add(a, hn::Mul(hn::Sub(b, a), share)); };
  const V right = hn::Load(d, corners.right);
  return mix(mix(value(0), value(1), right), mix(value(2), value(3), right),
             hn::Load(d, corners.low));
}

// LevelsFor of src/scalar/sample_texture.h.
template <class D, class VI, class V = hn::Vec<D>, typename Real = hn::TFromD<D>>
HWY_INLINE void LevelsFor(D d, V s, Real coarsest, VI& level, V& share) {
  const hn::RebindToUnsigned<D> du;
  constexpr int kFractionBits = std::numeric_limits<Real>::digits - 1;
  const V one = hn::Set(d, Real(1)), most = hn::Set(d, coarsest);
  const V least = hn::IfThenElse(hn::Gt(s, one), s, one);
  const V clamped = hn::IfThenElse(hn::Lt(s, most), least, most);  // NaN is infinitely wide
  const auto bits = hn::BitCast(du, clamped), bits_of_one = hn::BitCast(du, one);
  const auto octave =
      hn::Sub(hn::ShiftRight<kFractionBits>(bits), hn::ShiftRight<kFractionBits>(bits_of_one));
  if constexpr (sizeof(Real) == 4) {
    level = hn::BitCast(IndexLanes<D>(), octave);
  } else {
    level = hn::BitCast(IndexLanes<D>(), hn::TruncateTo(TexelLanes<D>(), octave));
  }
  const auto fraction =
      hn::And(bits, hn::Set(du, (hn::TFromD<decltype(du)>{1} << kFractionBits) - 1));
  share = hn::Sub(hn::BitCast(d, hn::Or(fraction, bits_of_one)), one);
}

template <typename Real>
void SampleTextureLanes(const TextureData<Real>& texture, const SurfaceView<Real>& surfaces,
                        std::uint32_t count, const ChannelOutput<Real>& channels) {
  const Lanes<Real> d;
  const IndexLanes<Lanes<Real>> di;
  using V = hn::Vec<Lanes<Real>>;
  Real* const outputs[4] = {channels.r, channels.g, channels.b, channels.a};
  const bool is_second = texture.set == 1;
  const Real* const at_u = is_second ? surfaces.u2 : surfaces.u;
  const Real* const at_v = is_second ? surfaces.v2 : surfaces.v;
  const Real* const covered_u = is_second ? surfaces.footprint_u2 : surfaces.footprint_u;
  const Real* const covered_v = is_second ? surfaces.footprint_v2 : surfaces.footprint_v;
  Corners<Real> fine = {}, coarse = {};
  for (std::uint32_t i = 0; i < count; i += LaneCount(d)) {
    // Lanes past the count look at (0, 0).
    const auto lanes = LanesBelow(d, i, count);
    const auto load = [&](const Real* field) SHEAF_LAMBDA {
      return hn::IfThenElseZero(lanes, hn::LoadU(d, field + i));
    };
    V u = load(at_u), v = load(at_v);
    auto level = hn::Zero(di);
    V share = hn::Zero(d);
    if (texture.level_count > 1) {
      V width_u = load(covered_u), width_v = load(covered_v);
      if (texture.is_moved) {
        const auto widened = [&](const Real(&to)[3]) SHEAF_LAMBDA {
          return hn::Add(hn::Mul(hn::Abs(hn::Set(d, to[0])), width_u),
                         hn::Mul(hn::Abs(hn::Set(d, to[1])), width_v));
        };
        const V across = widened(texture.to_u);
        width_v = widened(texture.to_v);
        width_u = across;
      }
      const V across = hn::Mul(width_u, hn::Set(d, static_cast<Real>(texture.width)));
      const V down = hn::Mul(width_v, hn::Set(d, static_cast<Real>(texture.height)));
      LevelsFor(d, hn::IfThenElse(hn::Lt(across, down), down, across), texture.coarsest, level,
                share);
    }
    if (texture.is_moved) {
      const auto moved = [&](const Real(&to)[3]) SHEAF_LAMBDA {
        return hn::Add(hn::Add(hn::Mul(hn::Set(d, to[0]), u), hn::Mul(hn::Set(d, to[1]), v)),
                       hn::Set(d, to[2]));
      };
      const V across = moved(texture.to_u);
      v = moved(texture.to_v);
      u = across;
    }
    u = WrapCoordinate(d, texture.wrap_u, u);
    v = WrapCoordinate(d, texture.wrap_v, v);
    FindCorners(d, texture, level, u, v, fine);
    // Where nothing of the next level is mixed in it need not be looked at, nor be there.
    const bool is_mixed = !hn::AllTrue(d, hn::Eq(share, hn::Zero(d)));
    if (is_mixed) {
      const auto last = hn::Set(di, texture.level_count - 1);
      FindCorners(d, texture, hn::Min(hn::Add(level, hn::Set(di, 1)), last), u, v, coarse);
    }
    for (int channel = 0; channel < 4; ++channel) {
      if (!outputs[channel]) continue;
      V value = MixCorners(d, texture, fine, channel);
      if (is_mixed) {
        const V next = MixCorners(d, texture, coarse, channel);
        value = hn::Add(value, hn::Mul(hn::Sub(next, value), share));
      }
      hn::StoreU(value, d, outputs[channel] + i);
    }
  }
}
SHEAF_NAME_KERNELS(SampleTexture);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(SampleTexture);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
