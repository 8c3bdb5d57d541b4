// The constants of random numbers, for src/scalar/draw_sample.h and simd/draw_samples.cc.
#ifndef SHEAF_SIMD_SAMPLE_TERMS_H_
#define SHEAF_SIMD_SAMPLE_TERMS_H_

#include <cstdint>
#include <numbers>

namespace sheaf {

template <typename Real>
inline constexpr Real kInversePi = static_cast<Real>(std::numbers::inv_pi);

// What a sample is drawn for: each use has numbers of its own. Lights follow one another from
// kLightDimension on.
inline constexpr std::uint32_t kLensDimension = 0;
inline constexpr std::uint32_t kGlossDimension = 1;
inline constexpr std::uint32_t kLobeDimension = 2;
inline constexpr std::uint32_t kDiffuseDimension = 3;
inline constexpr std::uint32_t kLightDimension = 16;

// By ChildKind. Told apart from its siblings, a child has other numbers than its parent.
inline constexpr std::uint32_t kChildSeeds[] = {0x68e31da4u, 0xb5297a4du, 0x1b56c4e9u};

// An integer hash of low bias: Wellons, "Hash Prospector" (2018), x ^= x >> a; x *= m; and so on.
inline constexpr int kHashShifts[] = {16, 15, 16};
inline constexpr std::uint32_t kHashFactors[] = {0x7feb352du, 0x846ca68bu};

// Owen scrambling of bits in reversed order, by Laine and Karras' method with better constants:
// Vegdahl, "Building a Better LK Hash" (2021).
inline constexpr std::uint32_t kScrambleFactors[] = {0x3d20adeau, 0x05526c56u, 0x53a22864u};

// Seeds of the two coordinates, from that of the order of points.
inline constexpr std::uint32_t kSeedOfU = 0x2c1b3c6du, kSeedOfV = 0x297a2d39u;

// Bits at even places, in even pairs, quads, bytes and halves.
inline constexpr std::uint32_t kEvenBits[] = {0x55555555u, 0x33333333u, 0x0f0f0f0fu, 0x00ff00ffu,
                                              0x0000ffffu};

}  // namespace sheaf

#endif  // SHEAF_SIMD_SAMPLE_TERMS_H_
