// Cameras, the sample pattern and the tangent behind them, against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cfloat>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "simd/shading.h"
#include "src/core/strict_tan.h"
#include "src/render/sample_pattern.h"
#include "src/scalar/camera_ray.h"

namespace sheaf {
namespace {

using scalar::Ray;

double Length(Vec3<double> a) { return std::sqrt(Dot(a, a)); }
double Distance(Vec3<double> a, Vec3<double> b) { return Length(a - b); }

// The right-handed frame of a camera, by GLM.
struct Frame {
  Vec3<double> forward, right, up;

  explicit Frame(const Camera& camera) {
    const Vec3d f = glm::normalize(camera.look_at - camera.eye);
    const Vec3d r = glm::normalize(glm::cross(f, camera.up));
    forward = ToVec3(f), right = ToVec3(r), up = ToVec3(glm::cross(r, f));
  }
};

Camera RandomCamera(Random& random) {
  Camera camera;
  camera.eye = UniformPoint(random, -10, 10);
  camera.look_at = UniformPoint(random, -10, 10);
  camera.up = UniformPoint(random, -1, 1);
  return camera;
}

constexpr std::pair<int, int> kSizes[] = {{640, 480}, {1, 1}, {641, 479}, {16, 1000}, {3, 1}};

template <typename Real>
Ray<double> CameraRayAt(const CameraData<Real>& camera, double x, double y) {
  // Whole pixels and what is left in them, as the renderer counts.
  const double px = std::floor(x), py = std::floor(y);
  const Ray<Real> ray = scalar::CameraRay(camera, static_cast<Real>(px), static_cast<Real>(py),
                                          static_cast<Real>(x - px), static_cast<Real>(y - py));
  return {ray.origin.template To<double>(), ray.direction.template To<double>()};
}

template <typename Real>
constexpr double kTolerance = 1e-12;
template <>
constexpr double kTolerance<float> = 2e-6;

TEST_CASE_TEMPLATE("perspective: the centre looks at look_at, corners match the angle and aspect",
                   Real, float, double) {
  Random random(40);
  for (const double fov : {1.0, 30.0, 60.0, 90.0, 120.0, 170.0}) {
    for (const auto& [width, height] : kSizes) {
      Camera camera = RandomCamera(random);
      camera.projection = Perspective{fov};
      const Frame frame(camera);
      const auto data = CompileCamera<Real>(camera, width, height);
      const auto ray_at = [&](double x, double y) { return CameraRayAt(data, x, y); };

      const Ray<double> centre = ray_at(width / 2.0, height / 2.0);
      CHECK(Distance(centre.direction, frame.forward) < kTolerance<Real>);
      CHECK(Distance(centre.origin, ToVec3(camera.eye)) < 10 * kTolerance<Real>);

      // The angle is the picture's whole height, so the top edge is half of it up.
      const double half = std::tan(fov / 2 * std::numbers::pi / 180);
      const double aspect = static_cast<double>(width) / height;
      for (const double right : {-1.0, 1.0}) {
        for (const double up : {-1.0, 1.0}) {
          const Ray<double> corner = ray_at(width * (1 + right) / 2, height * (1 - up) / 2);
          const auto want = Normalize(frame.forward + frame.right * (right * half * aspect) +
                                      frame.up * (up * half));
          CHECK(Distance(corner.direction, want) < 2 * kTolerance<Real>);
          CHECK(Length(corner.direction) == doctest::Approx(1).epsilon(kTolerance<Real>));
        }
      }
    }
  }
}

TEST_CASE_TEMPLATE("orthographic: parallel rays across the picture's height", Real, float, double) {
  Random random(41);
  for (const auto& [width, height] : kSizes) {
    Camera camera = RandomCamera(random);
    camera.projection = Orthographic{3.0};
    const Frame frame(camera);
    const auto data = CompileCamera<Real>(camera, width, height);
    const double aspect = static_cast<double>(width) / height;
    for (const double right : {-1.0, 0.0, 1.0}) {
      for (const double up : {-1.0, 0.0, 1.0}) {
        const Ray<double> ray = CameraRayAt(data, width * (1 + right) / 2, height * (1 - up) / 2);
        const auto want =
            ToVec3(camera.eye) + frame.right * (right * 1.5 * aspect) + frame.up * (up * 1.5);
        CHECK(Distance(ray.origin, want) < 20 * kTolerance<Real>);
        CHECK(Distance(ray.direction, frame.forward) < kTolerance<Real>);
      }
    }
  }
}

TEST_CASE("x runs to the right and y down") {
  Camera camera;  // at the origin, toward -z, y up
  const auto data = CompileCamera<float>(camera, 20, 10);
  const auto pixel = [&](float x, float y) {
    return scalar::CameraRay(data, x, y, 0.5f, 0.5f).direction;
  };
  CHECK(pixel(0, 0).x < 0);
  CHECK(pixel(0, 0).y > 0);
  CHECK(pixel(19, 9).x > 0);
  CHECK(pixel(19, 9).y < 0);
  for (int i = 1; i < 10; ++i) {
    const auto now = static_cast<float>(i);
    CHECK(pixel(now, 5).x > pixel(now - 1, 5).x);
    CHECK(pixel(5, now).y < pixel(5, now - 1).y);
  }
  // Mirrored pixels see mirrored directions, to the bit.
  CHECK(pixel(3, 2).x == -pixel(16, 2).x);
  CHECK(pixel(3, 2).y == -pixel(3, 7).y);
}

TEST_CASE("one sample lies at the centre; more are distinct and stratified in x and y") {
  REQUIRE(SamplePattern(1).size() == 1);
  CHECK(SamplePattern(1)[0] == glm::dvec2(0.5, 0.5));
  for (const int count : {2, 3, 4, 5, 7, 8, 13, 16, 64, 100, 255, 256, 1024, 4096}) {
    CAPTURE(count);
    const auto points = SamplePattern(count);
    REQUIRE(points.size() == static_cast<std::size_t>(count));
    const int cells = static_cast<int>(std::bit_ceil(static_cast<unsigned>(count)));
    std::set<int> columns, rows;
    std::set<std::pair<float, float>> distinct;
    for (const glm::dvec2& p : points) {
      // The renderer rounds them to its own type.
      const auto x = static_cast<float>(p.x), y = static_cast<float>(p.y);
      CHECK((x >= 0 && x < 1 && y >= 0 && y < 1));
      distinct.insert({x, y});
      columns.insert(static_cast<int>(p.x * count));
      rows.insert(static_cast<int>(p.y * cells));
    }
    CHECK(distinct.size() == points.size());
    CHECK(columns.size() == points.size());
    CHECK(rows.size() == points.size());
    // Of a power of two every elementary box holds one: 2^k columns by count / 2^k rows.
    if (count != cells) continue;
    for (int wide = 1; wide <= count; wide *= 2) {
      const int high = count / wide;
      std::set<std::pair<int, int>> boxes;
      for (const glm::dvec2& p : points) {
        boxes.insert({static_cast<int>(p.x * wide), static_cast<int>(p.y * high)});
      }
      CHECK(boxes.size() == points.size());
    }
  }
}

TEST_CASE("the tangent is within 1e-14 of tanl, times itself past 45 degrees") {
  static_assert(LDBL_MANT_DIG >= 64);
  double worst = 0, worst_past_45 = 0, previous = 0;
  const auto judge = [&](double degrees) {
    const long double exact = std::tan(degrees * (std::numbers::pi_v<long double> / 180));
    const double got = StrictTanDegrees(degrees);
    const double off = static_cast<double>(std::abs(got - exact) / exact);
    if (degrees <= 45) worst = std::max(worst, off);
    if (degrees > 45) worst_past_45 = std::max(worst_past_45, off / static_cast<double>(exact));
    return got;
  };
  for (int i = 1; i < 900000; ++i) {
    const double got = judge(i / 1e4);
    REQUIRE(got > previous);
    previous = got;
  }
  for (double degrees = 1e-300; degrees < 1; degrees *= 7) judge(degrees);
  for (double rest = 1; rest > 1e-10; rest /= 3) judge(90 - rest);
  MESSAGE("relative error: ", worst, " to 45 degrees, ", worst_past_45,
          " times the tangent past it");
  CHECK(worst <= 1e-14);
  CHECK(worst_past_45 <= 1e-14);
  CHECK(StrictTanDegrees(45) == doctest::Approx(1).epsilon(1e-15));
}

}  // namespace
}  // namespace sheaf
