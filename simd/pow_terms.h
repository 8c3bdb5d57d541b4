// The coefficients of pow, shared by its scalar specification and its kernel.
//
// log2(m) = s * sum kLog[i] s^(2 (count - 1 - i)), s = (m - 1) / (m + 1), |s| <= 0.1716: the series
// of 2/ln 2 artanh(s). 2^f = sum kExp[i] f^(count - 1 - i), |f| <= 1/2: Taylor's. Both are stored
// for Horner's rule. Truncation for float: 1.3e-12 of log2 (y = p log2 x >= -150 makes that 1.3e-10
// of the result) and 2e-10 of 2^f, against half a float ULP of 6e-8. For double both are below its
// rounding.
#ifndef SHEAF_SIMD_POW_TERMS_H_
#define SHEAF_SIMD_POW_TERMS_H_

#include <cstdint>

namespace sheaf {

// 2^52 + k holds the integer k >= 0 in its low bits: integers become doubles without an integer
// unit.
inline constexpr double kTwo52 = 4503599627370496.0;
inline constexpr std::uint64_t kTwo52Bits = 0x4330000000000000u;
// Adding and subtracting 1.5 * 2^52 rounds to the nearest integer, and leaves it in the low bits.
inline constexpr double kRoundToInteger = 6755399441055744.0;
inline constexpr std::uint64_t kMantissaMask = 0x000fffffffffffffu;
inline constexpr std::uint64_t kSqrtHalfBits = 0x3fe6a09e667f3bcdu;  // sqrt(1/2) as a double
inline constexpr std::uint64_t kExponentBias = 1024;  // keeps the shifted exponent positive

// x below this counts as 0: it is far below every float, and normal in double.
inline constexpr double kPowTiny = 0x1p-1000;
// 2^y below this is 0 in float, and still a normal double.
inline constexpr double kPowLowest = -1000.0;

template <typename Real>
struct PowTerms;

template <>
struct PowTerms<float> {
  static constexpr double kLog[] = {0.22195308321368667, 0.2623081892525388, 0.3205988979753252,
                                    0.4121985831111324,  0.5770780163555853, 0.9617966939259756,
                                    2.8853900817779268};
  static constexpr double kExp[] = {
      1.321548679014431e-06, 1.5252733804059841e-05, 0.0001540353039338161,
      0.0013333558146428443, 0.009618129107628477,   0.05550410866482158,
      0.24022650695910072,   0.6931471805599453,     1.0};
};

template <>
struct PowTerms<double> {
  static constexpr double kLog[] = {0.12545174268599682, 0.1373995277037108,  0.15186263588304877,
                                    0.16972882833987804, 0.19235933878519512, 0.22195308321368667,
                                    0.2623081892525388,  0.3205988979753252,  0.4121985831111324,
                                    0.5770780163555853,  0.9617966939259756,  2.8853900817779268};
  static constexpr double kExp[] = {1.3691488853904128e-12, 2.5678435993488206e-11,
                                    4.4455382718708116e-10, 7.054911620801123e-09,
                                    1.01780860092397e-07,   1.321548679014431e-06,
                                    1.5252733804059841e-05, 0.0001540353039338161,
                                    0.0013333558146428443,  0.009618129107628477,
                                    0.05550410866482158,    0.24022650695910072,
                                    0.6931471805599453,     1.0};
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_POW_TERMS_H_
