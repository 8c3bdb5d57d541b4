// tan and cos from + - * / alone: libm's differs between platforms, and a camera's angle reaches
// every pixel.
#ifndef SHEAF_CORE_STRICT_TAN_H_
#define SHEAF_CORE_STRICT_TAN_H_

namespace sheaf {

// tan(degrees) for degrees in (0, 90), to a relative error of 1e-14 up to 45 degrees; beyond, that
// grows with the tangent itself.
double StrictTanDegrees(double degrees);

// cos(degrees) for degrees in [0, 90], to an absolute error of 1e-14.
double StrictCosDegrees(double degrees);

}  // namespace sheaf

#endif  // SHEAF_CORE_STRICT_TAN_H_
