// Fresnel's split near the critical angle and at extreme indices.
#include <fmt/format.h>

#include <cmath>

#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"
#include "src/scalar/spawn.h"

namespace sheaf::stress {

void CriticalAngle(Report& report) {
  for (const float ior : {1.1f, 1.333f, 1.5f, 2.4f}) {
    // cos of the critical angle, and its neighbours by ULPs.
    float cosine = static_cast<float>(std::sqrt(1 - 1 / (static_cast<double>(ior) * ior)));
    for (int i = 0; i < 8; ++i) cosine = std::nextafter(cosine, 0.0f);
    for (int i = 0; i < 17; ++i, cosine = std::nextafter(cosine, 1.0f)) {
      const long double c = cosine, n = ior;
      const long double k = 1 - n * n * (1 - c * c);
      const auto split = scalar::FresnelSplit(ior, cosine);
      report.Expect(split.is_total == !(k > 0),
                    fmt::format("ior {:a}, cosine {:a}: total is {}", ior, cosine, split.is_total));
    }
  }
}

void ExtremeIors(Report& report) {
  Random random(44);
  for (const float ior : {1e-3f, 0.5f, 1.0f, 1e3f}) {
    for (int i = 0; i < 1000; ++i) {
      const float cosine = random.In(0, 1);
      for (const float eta : {ior, 1 / ior}) {
        const auto split = scalar::FresnelSplit(eta, cosine);
        const bool sound = split.reflectance >= 0 && split.reflectance <= 1 && split.cos_t >= 0 &&
                           split.cos_t <= 1;
        report.Expect(sound, fmt::format("eta {:a}, cosine {:a}", eta, cosine));
        const bool lets_through = split.reflectance == 0 && split.cos_t == cosine;
        if (eta == 1) report.Expect(lets_through, fmt::format("ior 1 bends at {:a}", cosine));
      }
    }
  }
}

}  // namespace sheaf::stress
