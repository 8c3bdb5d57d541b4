// The sRGB curve: against std::pow, against itself, and bit for bit against recorded values.
#include "src/scene/srgb.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace sheaf {
namespace {

double PowDecode(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }
double PowEncode(double x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
}

TEST_CASE("both directions agree with pow to a few ulp") {
  for (int i = 0; i <= 100000; ++i) {
    const double x = i / 100000.0;
    CHECK(std::abs(SrgbDecode(x) - PowDecode(x)) <= 2e-15 * PowDecode(x));
    CHECK(std::abs(SrgbEncode(x) - PowEncode(x)) <= 2e-15 * PowEncode(x));
  }
  // Here it is pow that drifts: its exponent, 2.4 rounded to double, is off by 9e-17.
  for (double x = 1.0; x < 1e12; x *= 1.37) {
    CHECK(std::abs(SrgbDecode(x) - PowDecode(x)) <= 1e-14 * PowDecode(x));
    CHECK(std::abs(SrgbEncode(x) - PowEncode(x)) <= 1e-14 * PowEncode(x));
  }
}

TEST_CASE("black, white and the 256 codes of an 8-bit picture survive a round trip") {
  CHECK(SrgbDecode(0.0) == 0.0);
  CHECK(SrgbEncode(0.0) == 0.0);
  CHECK(SrgbDecode(1.0) == 1.0);
  CHECK(SrgbEncode(1.0) == 1.0);
  for (int code = 0; code < 256; ++code) {
    CHECK(std::lround(255.0 * SrgbEncode(SrgbDecode(code / 255.0))) == code);
  }
}

TEST_CASE("the curve rises everywhere but at the standard's own seam") {
  double last_decoded = -1.0, last_encoded = -1.0;
  for (int i = 0; i <= 65535; ++i) {
    CHECK(SrgbDecode(i / 65535.0) > last_decoded);
    CHECK(SrgbEncode(i / 65535.0) > last_encoded);
    last_decoded = SrgbDecode(i / 65535.0);
    last_encoded = SrgbEncode(i / 65535.0);
  }
}

TEST_CASE("the bits are the same on every machine") {
  struct Row {
    double x, decoded, encoded;
  };
  constexpr Row kRows[] = {
      {0.05, 0x1.01f21b72f7fe2p-8, 0x1.fb7ed7dd47721p-3},
      {0.1, 0x1.486d8e075e9d5p-7, 0x1.65921e7d49882p-2},
      {0.25, 0x1.a0c6e3db0c475p-5, 0x1.12fe9ad44c001p-1},
      {0.5, 0x1.b65b3392f5354p-3, 0x1.7880b5e230e4fp-1},
      {0.735, 0x1.ff71f5f87fd81p-2, 0x1.bef74cde06fb6p-1},
      {0.9, 0x1.9327b41ed8677p-1, 0x1.e8ccc1ca52308p-1},
      {2.0, 0x1.3d0bcf0d210c1p+2, 0x1.5a6efcfd536cfp+0},
      {100.0, 0x1.b211459a702bep+15, 0x1.c87d081ca62f5p+2},
  };
  for (const Row& row : kRows) {
    CHECK(SrgbDecode(row.x) == row.decoded);
    CHECK(SrgbEncode(row.x) == row.encoded);
  }
}

TEST_CASE("what is not a colour comes out as it went in") {
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(std::isnan(SrgbDecode(std::nan(""))));
  CHECK(std::isnan(SrgbEncode(std::nan(""))));
  CHECK(SrgbDecode(inf) == inf);
  CHECK(SrgbEncode(inf) == inf);
  CHECK(SrgbDecode(-0.5) == -0.5 / 12.92);
  CHECK(SrgbEncode(-0.5) == -0.5 * 12.92);
}

}  // namespace
}  // namespace sheaf
