#include "src/core/strict_tan.h"

namespace sheaf {

double StrictTanDegrees(double degrees) {
  constexpr double kRadiansPerDegree = 0.017453292519943295769;
  // Past 45 degrees the complement keeps the series short and the doublings well conditioned.
  if (degrees > 45) return 1 / StrictTanDegrees(90 - degrees);
  const double x = degrees * kRadiansPerDegree / 4;  // at most pi/16
  const double x2 = x * x;
  // Taylor's sine and cosine, by Horner's rule; the terms left out are below 1e-19.
  double sine = 0, cosine = 0;
  for (int n = 15; n >= 3; n -= 2) sine = x2 / ((n - 1) * n) * (1 - sine);
  for (int n = 16; n >= 2; n -= 2) cosine = x2 / ((n - 1) * n) * (1 - cosine);
  double t = x * (1 - sine) / (1 - cosine);
  for (int doubling = 0; doubling < 2; ++doubling) t = 2 * t / (1 - t * t);
  return t;
}

double StrictCosDegrees(double degrees) {
  if (degrees == 90) return 0;  // quarter turns are exact
  const double t = StrictTanDegrees(degrees / 2);
  return (1 - t * t) / (1 + t * t);
}

}  // namespace sheaf
