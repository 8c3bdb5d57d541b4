// The coefficients of pow, shared by its scalar specification and its kernel.
//
// log2 m = s L(s^2) with s = (m - 1) / (m + 1), |s| <= 0.1716: 2/ln 2 artanh(s). 2^f = E(f), |f| <=
// 1/2. For float the polynomials have the least relative error of their degree (Remez): 2.7e-14 of
// log2 m (y = p log2 x >= -150 makes that 3e-12 of the result) and 4.7e-11 of 2^f, against half a
// float ULP of 3e-8. For double they are the series, whose truncation is below the rounding.
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

// Coefficients from the highest power down, two by two: a polynomial in x is evaluated by Horner's
// rule in x^2 over the pairs a x + b, which wait for nothing.
template <typename Real>
struct PowTerms;

template <>
struct PowTerms<float> {
  static constexpr double kLog[][2] = {{0.282899281459652, 0.31990575510624353},
                                       {0.4122092510534761, 0.5770779423768015},
                                       {0.9617966941133066, 2.88539008177785}};
  static constexpr double kExp[][2] = {{1.5196158527772698e-05, 0.00015466756251326735},
                                       {0.0013333935047106663, 0.009618038132306056},
                                       {0.05550410366001406, 0.24022651066559253},
                                       {0.6931471807045294, 1.0}};
};

template <>
struct PowTerms<double> {
  static constexpr double kLog[][2] = {
      {0.12545174268599682, 0.1373995277037108},  {0.15186263588304877, 0.16972882833987804},
      {0.19235933878519512, 0.22195308321368667}, {0.2623081892525388, 0.3205988979753252},
      {0.4121985831111324, 0.5770780163555853},   {0.9617966939259756, 2.8853900817779268}};
  static constexpr double kExp[][2] = {{1.3691488853904128e-12, 2.5678435993488206e-11},
                                       {4.4455382718708116e-10, 7.054911620801123e-09},
                                       {1.01780860092397e-07, 1.321548679014431e-06},
                                       {1.5252733804059841e-05, 0.0001540353039338161},
                                       {0.0013333558146428443, 0.009618129107628477},
                                       {0.05550410866482158, 0.24022650695910072},
                                       {0.6931471805599453, 1.0}};
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_POW_TERMS_H_
