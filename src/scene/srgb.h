// The sRGB transfer curve (IEC 61966-2-1) with the same bits on every machine.
//
// std::pow differs between C libraries in the last place, which would leak into pictures; these two
// use + - * / and sqrt only, which IEEE 754 fixes to the bit (compile with -ffp-contract=off).
#ifndef SHEAF_SCENE_SRGB_H_
#define SHEAF_SCENE_SRGB_H_

namespace sheaf {

// Both map 0 to 0 and 1 to 1, are within a few ulp of the exact curve on [0, 1e12], extend it above
// 1 by the same formula and below 0 by its linear piece; NaN stays NaN, infinity infinity.
double SrgbDecode(double encoded);  // to linear light
double SrgbEncode(double linear);

}  // namespace sheaf

#endif  // SHEAF_SCENE_SRGB_H_
