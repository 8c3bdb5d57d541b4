// The library's geometries at the edges of what users give them: sizes, giants, odd rays, and rays
// that go on from a hit.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "sheaf/geometry.h"
#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {
namespace {

// Rays as the library takes them, and what it finds.
struct Trace {
  std::vector<float> ray[6], t_min, t, u, v;
  std::vector<std::uint32_t> primitive, source;

  void Add(const Ray& from) {
    for (int axis = 0; axis < 3; ++axis) {
      ray[axis].push_back(from.origin[axis]);
      ray[3 + axis].push_back(from.direction[axis]);
    }
    t_min.push_back(from.t_min);
    source.push_back(from.source);
  }
  std::size_t count() const { return t_min.size(); }
  RayArrays rays() const {
    return {ray[0].data(), ray[1].data(), ray[2].data(), ray[3].data(),
            ray[4].data(), ray[5].data(), source.data()};
  }
  HitArrays hits() {
    for (auto* numbers : {&t, &u, &v}) numbers->resize(count());
    primitive.resize(count());
    return {.t = t.data(), .primitive = primitive.data(), .u = u.data(), .v = v.data()};
  }
  void Run(const Geometry& geometry, Target target) {
    TraceOptions options;
    options.interval.t_min = t_min.data();
    options.target = target;
    TraceClosest(geometry, rays(), count(), hits(), options).value();
  }
};

// A hilly square of so many triangles to the side, twice, from 0 to `side` along x and z.
Shapes Hills(std::uint32_t side) {
  Shapes hills;
  for (std::uint32_t j = 0; j <= side; ++j) {
    for (std::uint32_t i = 0; i <= side; ++i) {
      const float height = static_cast<float>((i * 7 + j * 13) % 5) / 8;
      hills.AddVertex({static_cast<float>(i), height, static_cast<float>(j)});
    }
  }
  for (std::uint32_t j = 0; j < side; ++j) {
    for (std::uint32_t i = 0; i < side; ++i) {
      const std::uint32_t at = j * (side + 1) + i;
      hills.AddTriangle(at, at + 1, at + side + 2);
      hills.AddTriangle(at, at + side + 2, at + side + 1);
    }
  }
  return hills;
}

std::vector<Ray> RaysFromAbove(float side, int count) {
  Random random(3);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const float x = random.In(0, side), z = random.In(0, side);
    const Vec slant = random.InBox(1);
    rays.push_back({{x, 5, z}, {slant.x, -1, slant.z}});
  }
  return rays;
}

double BestSeconds(const Geometry& geometry, const std::vector<Ray>& rays) {
  Trace trace;
  for (const Ray& ray : rays) trace.Add(ray);
  double best = kInfinity;
  for (int i = 0; i < 5; ++i) {
    const auto from = std::chrono::steady_clock::now();
    trace.Run(geometry, Target());
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
    best = std::min(best, took.count());
  }
  return best;
}

}  // namespace

void AnySize(Report& report) {
  for (int power = -126; power <= 126; ++power) {
    const float s = std::ldexp(1.0f, power);
    Shapes shapes;
    shapes.AddTriangle({-s, -s, 0}, {s, -s, 0}, {0, s, 0});
    const Result<Geometry> geometry = Geometry::Build(InputOf(shapes));
    report.Expect(geometry.ok(), "no geometry");
    if (!geometry) return;
    Trace trace;
    for (int i = 0; i < 20; ++i) trace.Add({{s / 8, -s / 4, -s}, {0, 0, s}});
    ForEachTarget(report, [&](Target target) {
      trace.Run(geometry.value(), target);
      for (std::size_t i = 0; i < trace.count(); ++i) {
        report.Expect(trace.primitive[i] == 0 && trace.t[i] == 1,
                      fmt::format("2^{} large, and not hit", power));
      }
    });
  }
}

void GiantsAndOddRays(Report& report) {
  constexpr std::uint32_t kSide = 100;
  const Shapes hills = Hills(kSide);
  Shapes under_sky = hills;
  under_sky.AddSphere({0, 0, 0}, 1e12f);
  const std::vector<Ray> plain = RaysFromAbove(kSide, 2000);
  std::vector<Ray> behind = plain, tiny = plain, parallel = plain;
  for (Ray& ray : behind) ray.t_min = -1e-4f;
  for (Ray& ray : tiny) ray.direction = ray.direction * 1e-21f;
  for (Ray& ray : parallel) ray.direction = {0, -1, 0};
  const auto build = [](const Shapes& shapes) { return Geometry::Build(InputOf(shapes)); };
  const Result<Geometry> open = build(hills), closed = build(under_sky);
  report.Expect(open.ok() && closed.ok(), "no geometry");
  if (!open || !closed) return;
  const double usual = BestSeconds(open.value(), plain);
  // Where every primitive is tested it is a hundred times.
  const auto expect_fast = [&](const char* what, const Geometry& geometry,
                               const std::vector<Ray>& rays) {
    const double ratio = BestSeconds(geometry, rays) / usual;
    report.Expect(ratio < 10, fmt::format("{}: {:.0f} times as long", what, ratio));
  };
  expect_fast("t_min < 0", open.value(), behind);
  expect_fast("directions of 1e-21", open.value(), tiny);
  expect_fast("a sky of 1e12", closed.value(), plain);
  expect_fast("parallel rays from anywhere", open.value(), parallel);
  expect_fast("parallel rays under the sky", closed.value(), parallel);
  for (const std::vector<Ray>& rays : {plain, behind, tiny, parallel}) {
    const std::vector<Ray> few(rays.begin(), rays.begin() + 100);
    for (const Hit& hit : TraceEverywhere(report, under_sky, few)) {
      report.Expect(IsHit(hit), "a miss under the sky");
    }
  }
}

void GoingOn(Report& report) {
  // Whole numbers, so that all four corners lie in one plane, which runs through no axis.
  const Vec corner = {307, -211, 503}, side = {589, 31, -97}, other = {-41, 611, 203};
  Shapes slanted;
  slanted.AddQuad(corner, corner + side, corner + side + other, corner + other);
  const Result<Geometry> geometry = Geometry::Build(InputOf(slanted));
  report.Expect(geometry.ok(), "no geometry");
  if (!geometry) return;
  const Vec normal = Normalize(Cross(side, other)), slant = Normalize(side) * 0.7f;
  const Vec in = slant - normal, back = slant + normal;
  Trace down;
  for (int i = 1; i < 2000; ++i) {
    const Vec on_diagonal = corner + (side + other) * (static_cast<float>(i) / 2000);
    down.Add({on_diagonal - in * 31.7f, in});
  }
  const std::size_t n = down.count();
  ForEachTarget(report, [&](Target target) {
    down.Run(geometry.value(), target);
    std::vector<float> number[6];
    for (auto& list : number) list.resize(n);
    HitPointArrays points;
    points.back = {number[0].data(), number[1].data(), number[2].data()};
    points.front = {number[3].data(), number[4].data(), number[5].data()};
    FindHitPoints(geometry.value(), down.rays(), down.hits(), n, points, target).value();
    // Without a source: it is the place that keeps a ray off.
    Trace through, mirrored;
    for (std::size_t i = 0; i < n; ++i) {
      report.Expect(down.primitive[i] < 2, "a ray at the diagonal misses");
      through.Add({{number[0][i], number[1][i], number[2][i]}, in});
      mirrored.Add({{number[3][i], number[4][i], number[5][i]}, back});
    }
    for (Trace* on : {&through, &mirrored}) {
      on->Run(geometry.value(), target);
      const auto missed = std::count(on->primitive.begin(), on->primitive.end(), kNoPrimitive);
      report.Expect(missed == static_cast<std::ptrdiff_t>(n),
                    fmt::format("{} of {} rays meet the plane that they {}",
                                static_cast<std::ptrdiff_t>(n) - missed, n,
                                on == &through ? "went through" : "are mirrored by"));
    }
  });
}

}  // namespace sheaf::stress
