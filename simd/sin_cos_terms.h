// The coefficients of sine and cosine, shared by their scalar specification and their kernel.
//
// Angles are counted in quarter turns, so that taking whole ones off is exact. What is left is at
// most half of one, x: sin = x S(x^2), cos = C(x^2), by their series. The terms left out are below
// 3e-9 of the sine and 2e-10 of the cosine for float, against half an ULP of 3e-8; below 2e-19 and
// 3e-18 for double.
#ifndef SHEAF_SIMD_SIN_COS_TERMS_H_
#define SHEAF_SIMD_SIN_COS_TERMS_H_

#include <cstdint>

namespace sheaf {

// From the highest power down.
template <typename Real>
struct SinCosTerms;

template <>
struct SinCosTerms<float> {
  // Adding and subtracting 1.5 * 2^23 rounds to the nearest integer, and leaves it in the low bits.
  static constexpr float kRoundToInteger = 12582912.0f;
  using Bits = std::uint32_t;
  static constexpr float kSin[] = {0.000160441185f, -0.00468175414f, 0.0796926262f, -0.645964098f,
                                   1.57079633f};
  static constexpr float kCos[] = {-2.52020424e-05f, 0.000919260275f, -0.0208634808f,
                                   0.253669508f,     -1.23370055f,    1.0f};
};

template <>
struct SinCosTerms<double> {
  static constexpr double kRoundToInteger = 6755399441055744.0;
  using Bits = std::uint64_t;
  static constexpr double kSin[] = {
      6.0669357311061955e-12, -6.688035109811468e-10, 5.692172921967927e-08,
      -3.598843235212085e-06, 0.00016044118478735983, -0.004681754135318688,
      0.07969262624616705,    -0.6459640975062463,    1.5707963267948966};
  static constexpr double kCos[] = {
      6.565963114979473e-11,   -6.386603083791852e-09, 4.710874778818172e-07,
      -2.5202042373060607e-05, 0.0009192602748394266,  -0.02086348076335296,
      0.25366950790104803,     -1.2337005501361697,    1.0};
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_SIN_COS_TERMS_H_
