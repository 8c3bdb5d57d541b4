#include "simd/draw_samples.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simd/draw_samples.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "simd/dispatch.h"
#include "simd/math-inl.h"
#include "simd/sample_terms.h"

HWY_BEFORE_NAMESPACE();
namespace sheaf::simd::HWY_NAMESPACE {

using BitLanes = hn::CappedTag<std::uint32_t, kMaxLanes>;
using Bits = hn::Vec<BitLanes>;

HWY_INLINE Bits SetBits(std::uint32_t bits) { return hn::Set(BitLanes(), bits); }

HWY_INLINE Bits Hash(Bits x) {
  x = hn::Xor(x, hn::ShiftRight<kHashShifts[0]>(x));
  x = hn::Mul(x, SetBits(kHashFactors[0]));
  x = hn::Xor(x, hn::ShiftRight<kHashShifts[1]>(x));
  x = hn::Mul(x, SetBits(kHashFactors[1]));
  return hn::Xor(x, hn::ShiftRight<kHashShifts[2]>(x));
}

template <int kStep>
HWY_INLINE Bits SwapNeighbours(Bits x) {
  const Bits even = SetBits(kEvenBits[kStep]);
  return hn::Or(hn::And(hn::ShiftRight<(1 << kStep)>(x), even),
                hn::ShiftLeft<(1 << kStep)>(hn::And(x, even)));
}
HWY_INLINE Bits ReverseBits(Bits x) {
  return SwapNeighbours<4>(
      SwapNeighbours<3>(SwapNeighbours<2>(SwapNeighbours<1>(SwapNeighbours<0>(x)))));
}

HWY_INLINE Bits Scramble(Bits x, Bits seed) {
  x = hn::Xor(x, hn::Mul(x, SetBits(kScrambleFactors[0])));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), SetBits(1)));
  x = hn::Xor(x, hn::Mul(x, SetBits(kScrambleFactors[1])));
  return hn::Xor(x, hn::Mul(x, SetBits(kScrambleFactors[2])));
}

template <int kStep>
HWY_INLINE Bits PascalStep(Bits x) {
  return hn::Xor(x, hn::And(hn::ShiftRight<(1 << kStep)>(x), SetBits(kEvenBits[kStep])));
}
HWY_INLINE Bits PascalProduct(Bits x) {
  return PascalStep<4>(PascalStep<3>(PascalStep<2>(PascalStep<1>(PascalStep<0>(x)))));
}

// Numbers below 2^31 are converted as signed ones, which every target can.
HWY_INLINE void StoreUnit(Bits bits, float* to) {
  const hn::RebindToSigned<BitLanes> di;
  const hn::RebindToFloat<BitLanes> df;
  const auto numbers = hn::ConvertTo(df, hn::BitCast(di, hn::ShiftRight<8>(bits)));
  hn::StoreU(hn::Mul(numbers, hn::Set(df, 0x1p-24f)), df, to);
}
HWY_INLINE void StoreUnit(Bits bits, double* to) {
  std::uint32_t numbers[kMaxLanes];
  hn::StoreU(bits, BitLanes(), numbers);
  for (std::size_t i = 0; i < hn::Lanes(BitLanes()); ++i) {
    to[i] = static_cast<double>(numbers[i] >> 1) * 0x1p-31;
  }
}

template <typename Real>
void DrawSamplesLanes(const std::uint32_t* seeds, std::uint32_t index, std::uint32_t dimension,
                      std::uint32_t count, const SampleOutput<Real>& points) {
  const Bits reversed_index = ReverseBits(SetBits(index));
  const Bits use = SetBits(dimension * kHashFactors[0]);
  for (std::uint32_t i = 0; i < count; i += LaneCount(BitLanes())) {
    const Bits order = Hash(hn::Add(hn::LoadU(BitLanes(), seeds + i), use));
    const Bits shuffled = ReverseBits(Scramble(reversed_index, order));
    const Bits u = Scramble(shuffled, Hash(hn::Xor(order, SetBits(kSeedOfU))));
    const Bits v = Scramble(PascalProduct(shuffled), Hash(hn::Xor(order, SetBits(kSeedOfV))));
    StoreUnit(ReverseBits(u), points.u + i);
    StoreUnit(ReverseBits(v), points.v + i);
  }
}
SHEAF_NAME_KERNELS(DrawSamples);

}  // namespace sheaf::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sheaf::simd {
SHEAF_EXPORT(DrawSamples);
}  // namespace sheaf::simd
#endif  // HWY_ONCE
