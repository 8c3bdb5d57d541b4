#include "src/scene/develop.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace sheaf {
namespace {

// Narkowicz 2015, "ACES Filmic Tone Mapping Curve": 0 to 0, 1 to 0.80, 6 and more to 1.
float BendFilmic(float light) {
  const auto x = static_cast<double>(light);
  if (!(x > 0)) return 0;
  // Infinity over infinity is no number.
  if (!(x < 1e6)) return 1;
  const double bent = (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  return static_cast<float>(std::min(bent, 1.0));
}

// What a grey card reflects of the light on it.
constexpr double kGrey = 0.18;

}  // namespace

double ExposureFactor(double ev) {
  const double whole = std::floor(ev);
  double rest = ev - whole, factor = 1, root = 2;
  while (rest > 0) {  // bit by bit: 2^(1/2), 2^(1/4), ...
    root = std::sqrt(root);
    rest = 2 * rest;
    if (rest < 1) continue;
    factor = factor * root;
    rest = rest - 1;
  }
  return std::ldexp(factor, static_cast<int>(whole));
}

void Develop(double ev, Tone tone, Film& film) {
  const auto factor = static_cast<float>(ExposureFactor(ev));
  for (float& value : film.rgb) {
    const float light = value * factor;
    value = tone == Tone::kFilmic ? BendFilmic(light) : light;
  }
}

double MeterExposure(const Film& film) {
  std::vector<double> luminances;
  for (std::size_t i = 0; i + 2 < film.rgb.size(); i += 3) {
    const double y = 0.2126 * static_cast<double>(film.rgb[i]) +
                     0.7152 * static_cast<double>(film.rgb[i + 1]) +
                     0.0722 * static_cast<double>(film.rgb[i + 2]);
    if (y > 0 && std::isfinite(y)) luminances.push_back(y);
  }
  if (luminances.empty()) return 0;
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  // By comparison with thirds of a stop, because logarithms differ between C libraries.
  const double wanted = kGrey / *middle;
  const double stop =
      std::clamp(std::floor(static_cast<double>(std::ilogb(wanted))), -kMaxEv, kMaxEv - 1);
  double ev = stop;
  for (const double third : {stop + 1 / 3.0, stop + 2 / 3.0}) {
    if (ExposureFactor(third) <= wanted) ev = third;
  }
  return ev;
}

}  // namespace sheaf
