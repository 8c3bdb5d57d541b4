// The random numbers of distributed ray tracing: a function of pixel, sample and use alone.
//
// Points are Sobol's (0,2)-sequence, in an order and scrambled after Owen by hashes of the seed:
// Burley, "Practical Hash-based Owen Scrambling" (JCGT 9(4), 2020). Any power of two of consecutive
// samples of a pixel fills all elementary intervals evenly. Integers alone, so that every target
// has the same bits.
#ifndef SHEAF_SCALAR_DRAW_SAMPLE_H_
#define SHEAF_SCALAR_DRAW_SAMPLE_H_

#include <cstdint>
#include <type_traits>

#include "simd/sample_terms.h"
#include "simd/shading.h"

namespace sheaf::scalar {

constexpr std::uint32_t Hash(std::uint32_t x) {
  x ^= x >> kHashShifts[0];
  x *= kHashFactors[0];
  x ^= x >> kHashShifts[1];
  x *= kHashFactors[1];
  return x ^ (x >> kHashShifts[2]);
}

// Of what a pixel, counted in the whole picture, shows.
constexpr std::uint32_t PixelSeed(std::uint32_t x, std::uint32_t y) { return Hash(x + Hash(y)); }

// Of a ray that a surface sends on.
constexpr std::uint32_t ChildSeed(std::uint32_t parent, ChildKind kind) {
  return Hash(parent ^ kChildSeeds[static_cast<std::size_t>(kind)]);
}

constexpr std::uint32_t ReverseBits(std::uint32_t x) {
  for (int i = 0; i < 5; ++i) {
    const int shift = 1 << i;
    x = ((x >> shift) & kEvenBits[i]) | ((x & kEvenBits[i]) << shift);
  }
  return x;
}

// Each bit is flipped by a hash of those below it. Those below are, in reversed order, those above:
// this is Owen's scrambling of the reversed number.
constexpr std::uint32_t Scramble(std::uint32_t x, std::uint32_t seed) {
  x ^= x * kScrambleFactors[0];
  x += seed;
  x *= (seed >> 16) | 1;
  x ^= x * kScrambleFactors[1];
  return x ^ (x * kScrambleFactors[2]);
}

// The second coordinate of Sobol's point in reversed order: its matrix is Pascal's triangle, bit i
// of the result the parity of those bits j of the index whose places hold i's as a set of bits.
constexpr std::uint32_t PascalProduct(std::uint32_t index) {
  for (int i = 0; i < 5; ++i) index ^= (index >> (1 << i)) & kEvenBits[i];
  return index;
}

// Exact, in [0, 1).
template <typename Real>
constexpr Real UnitOf(std::uint32_t bits) {
  if constexpr (std::is_same_v<Real, float>) return static_cast<float>(bits >> 8) * 0x1p-24f;
  return static_cast<Real>(bits >> 1) * static_cast<Real>(0x1p-31);
}

// A point of the unit square. The middle stands for all of what is not distributed.
template <typename Real>
struct SamplePoint {
  Real u = Real(0.5), v = Real(0.5);
};

// `index` counts the samples of a pixel, `dimension` is what the point is for.
template <typename Real>
constexpr SamplePoint<Real> DrawSample(std::uint32_t seed, std::uint32_t index,
                                       std::uint32_t dimension) {
  const std::uint32_t order = Hash(seed + dimension * kHashFactors[0]);
  const std::uint32_t shuffled = ReverseBits(Scramble(ReverseBits(index), order));
  const std::uint32_t u = Scramble(shuffled, Hash(order ^ kSeedOfU));
  const std::uint32_t v = Scramble(PascalProduct(shuffled), Hash(order ^ kSeedOfV));
  return {UnitOf<Real>(ReverseBits(u)), UnitOf<Real>(ReverseBits(v))};
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_DRAW_SAMPLE_H_
