// What cases that trace rays share: random numbers, simple shapes, rays at them, and what the rays
// must meet.
#ifndef SHEAF_LAB_RAY_CASES_H_
#define SHEAF_LAB_RAY_CASES_H_

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "src/lab/probe.h"
#include "src/lab/stress.h"

namespace sheaf::stress {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Uniform directions and points; the same on every machine, as long as no two of them are drawn in
// one expression whose order is the compiler's.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  // In [low, high).
  float In(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f;
  }
  Vec InBox(float reach) { return {In(-reach, reach), In(-reach, reach), In(-reach, reach)}; }
  Vec Direction() {
    for (;;) {
      const Vec v = InBox(1);
      const float square = Dot(v, v);
      if (square > 0.01f && square <= 1) return Normalize(v);
    }
  }

 private:
  std::mt19937 engine_;
};

Shapes UnitSphere();
Shapes UnitTriangle();
void AddRandomTriangle(Random& random, Shapes& shapes, float size);

inline Ray Towards(Vec origin, Vec target) { return {origin, target - origin}; }
// From `origin` to every vertex and the middle of every edge.
std::vector<Ray> AimAtEdges(const Shapes& shapes, Vec origin);

void ExpectAllHit(Report& report, const Shapes& shapes, const std::vector<Ray>& rays);
void ExpectAllMiss(Report& report, const Shapes& shapes, const std::vector<Ray>& rays);
double UlpsOff(float t, double exact);
// The primitive that one ray must find, and its t to within `ulps` units in the last place.
void ExpectHit(Report& report, const Shapes& shapes, const Ray& ray, std::uint32_t primitive,
               double t, double ulps);

}  // namespace sheaf::stress

#endif  // SHEAF_LAB_RAY_CASES_H_
