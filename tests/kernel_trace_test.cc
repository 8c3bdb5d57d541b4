// The tracing kernels against src/scalar, bit by bit, on every target.
#include <algorithm>
#include <cstring>
#include <glm/common.hpp>
#include <utility>

#include "expected_traces.h"

namespace sheaf {
namespace {

template <typename Real>
std::vector<scalar::Ray<Real>> RandomRays(Random& random, std::uint32_t count,
                                          std::uint32_t primitives) {
  std::vector<scalar::Ray<Real>> rays;
  for (std::uint32_t i = 0; i < count; ++i) rays.push_back(RandomRay<Real>(random, primitives));
  return rays;
}

TEST_CASE_TEMPLATE("every count and offset traces as the scalar specification", Real, float,
                   double) {
  Random random(1);
  const Scene scene = RandomScene(random, 12);
  for (std::uint32_t count = 1; count <= 2 * kMaxLanes + 1; ++count) {
    const Expected<Real> want(scene, RandomRays<Real>(random, count, 12));
    ForEachTarget([&](Target target) {
      for (std::uint32_t offset = 0; offset < 4; ++offset) {
        CheckTraces(target, want, offset, Coherence::kUnknown);
      }
    });
  }
}

TEST_CASE_TEMPLATE("random scenes trace as the scalar specification", Real, float, double) {
  Random random(2);
  for (int objects = 0; objects < 40; ++objects) {
    const auto count = static_cast<std::uint32_t>(objects);
    CheckEverywhere<Real>({RandomScene(random, objects), RandomRays<Real>(random, 512, count)});
  }
  CheckEverywhere<Real>({RandomScene(random, 3000), RandomRays<Real>(random, 6000, 3000)});
}

// Many small primitives around the origin, so that trees are deep and rays pass many of them.
Scene CrowdedScene(Random& random, int count) {
  Scene scene;
  scene.materials.push_back({});
  for (int i = 0; i < count; ++i) {
    const Vec3d at = UniformPoint(random, -4, 4);
    Object object;
    if (i % 3 == 0) {
      object.shape = Sphere{at, Uniform(random, 0.02, 0.2)};
    } else {
      object.shape = Triangle{
          {at, at + UniformPoint(random, -0.4, 0.4), at + UniformPoint(random, -0.4, 0.4)}};
    }
    scene.objects.push_back(object);
  }
  return scene;
}

TEST_CASE_TEMPLATE("rays of one origin trace as the scalar specification", Real, float, double) {
  Random random(3);
  std::uint32_t hits = 0;
  for (int round = 0; round < 12; ++round) {
    const Vec3d origin = UniformPoint(random, -6, 6) * (round % 4 == 0 ? 100.0 : 1.0);
    const Vec3d towards = UniformPoint(random, -1, 1) - origin;
    // From a few rays a leaf to many leaves a ray; the last look along an axis.
    const Vec3d middle = round < 9 ? towards : Vec3d(0, round == 9, round == 10 ? -1 : 1);
    const double spread = round % 3 == 0 ? 0.01 : 0.5;
    const Expected<Real> want(CrowdedScene(random, 1500),
                              GridRays<Real>(random, origin, middle, spread));
    hits += want.hit_count();
    CheckEverywhere(want);
  }
  CHECK(hits > 2000);
}

TEST_CASE_TEMPLATE("rays of one direction trace as the scalar specification", Real, float, double) {
  Random random(8);
  std::uint32_t hits = 0;
  for (int round = 0; round < 10; ++round) {
    // The last along an axis, with either sign of zero.
    const Vec3d towards =
        round < 7 ? UniformPoint(random, -1, 1) : Vec3d(0, round == 8 ? -2 : 2, 0);
    std::vector<scalar::Ray<Real>> rays =
        GridRays<Real>(random, Vec3d(0), Vec3d(0, 0, 1), round % 2 ? 0.5 : 6);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      scalar::Ray<Real>& ray = rays[i];
      const Vec3d at = UniformPoint(random, -0.01, 0.01) - 5.0 * towards;
      if (!scalar::IsFinite(ray.direction)) ray.direction = {};
      ray.origin = ray.direction + As<Real>(at);
      ray.direction = As<Real>(towards);
      if (round == 9 && i % 3 == 0) ray.direction.x = -ray.direction.x;
      if (i % 32 == 0) ray.t_max = static_cast<Real>(Uniform(random, 0, 6));
      if (i % 50 == 0) ray.direction.z = std::numeric_limits<Real>::infinity();
    }
    const Expected<Real> want(CrowdedScene(random, 1500), rays);
    hits += want.hit_count();
    CheckEverywhere(want);
  }
  CHECK(hits > 2000);
}

Scene Scaled(Scene scene, double scale) {
  for (Object& object : scene.objects) {
    if (Sphere* sphere = std::get_if<Sphere>(&object.shape)) {
      sphere->center *= scale;
      sphere->radius *= scale;
    } else {
      for (Vec3d& v : std::get<Triangle>(object.shape).vertices) v *= scale;
    }
  }
  return scene;
}

// Rays in the planes of triangles, through their vertices, along axes and box faces: where t is
// mostly rounding error and boxes are touched at their rims.
TEST_CASE_TEMPLATE("degenerate rays trace as the scalar specification", Real, float, double) {
  Random random(4);
  std::uint32_t hits = 0;
  for (int round = 0; round < 8; ++round) {
    Scene scene;
    scene.materials.push_back({});
    std::vector<scalar::Ray<Real>> rays;
    for (int i = 0; i < 200; ++i) {
      Vec3d v[3];
      for (Vec3d& p : v) p = UniformPoint(random, -4, 4);
      if (round % 2) {  // an integer grid: flat boxes that touch
        for (Vec3d& p : v) p = glm::round(p);
      }
      if (i % 4 == 0) v[2] = v[1] + UniformPoint(random, -1e-5, 1e-5);  // slivers
      scene.objects.push_back({"", Triangle{{v[0], v[1], v[2]}}, 0});
      for (int k = 0; k < 6; ++k) {
        const double a = Uniform(random, -0.2, 1.2);
        const Vec3d in_plane = v[0] + a * (v[1] - v[0]) + Uniform(random, 0, 1) * (v[2] - v[0]);
        const Vec3d out = k < 3 ? v[k] + (v[k] - v[(k + 1) % 3]) * Uniform(random, 0, 3)
                                : UniformPoint(random, -6, 6);
        Vec3d origin = out;
        const Vec3d target = k % 3 == 0 ? v[k / 3] : in_plane;
        if (k == 5) origin = target + Vec3d(0, 0, 5);
        if (k == 4) origin = target - Vec3d(3, 0, 0);
        scalar::Ray<Real> ray{As<Real>(origin), As<Real>(target) - As<Real>(origin)};
        if (k == 5) ray.direction = {round % 4 < 2 ? Real(0) : -Real(0), Real(0), Real(-1)};
        if (k == 4) ray.direction = {Real(1), Real(1e-9), Real(-1e-30)};
        rays.push_back(ray);
      }
    }
    const Expected<Real> want(scene, rays);
    hits += want.hit_count();
    CheckEverywhere(want);
  }
  CHECK(hits > 2000);
}

// A fan of rays in the plane of triangles, from one origin: a tile's packets must keep hits that
// rounding alone decides, up to the very t where they are.
TEST_CASE_TEMPLATE("a tile in the plane of triangles traces as the scalar specification", Real,
                   float, double) {
  Random random(9);
  const auto power = [&](double low, double high) { return std::exp2(Uniform(random, low, high)); };
  std::uint32_t hits = 0;
  for (int round = 0; round < 400; ++round) {
    const Vec3d origin = round % 3 ? UniformPoint(random, -1, 1) * power(-6, 6) : Vec3d(0);
    const Vec3d ahead = UniformPoint(random, -1, 1), aside = UniformPoint(random, -1, 1);
    Scene scene;
    scene.materials.push_back({});
    for (int i = 0; i < 6; ++i) {
      Vec3d v[3];
      for (Vec3d& p : v) {
        const double along = Uniform(random, 0.01, 1) * power(-8, 8);
        const double across = Uniform(random, -1, 1) * power(-12, 2);
        p = origin + along * ahead + across * aside;
      }
      scene.objects.push_back({"", Triangle{{v[0], v[1], v[2]}}, 0});
    }
    std::vector<scalar::Ray<Real>> rays;
    const double spread = power(-24, -2);
    for (int i = 0; i < 128; ++i) {
      const Vec3d direction = ahead + Uniform(random, -spread, spread) * aside;
      rays.push_back({As<Real>(origin), As<Real>(direction * power(-3, 3))});
    }
    Expected<Real> want(scene, rays);
    hits += want.hit_count();
    CheckEverywhere(want);
    for (std::size_t i = 0; i < rays.size(); ++i) rays[i].t_max = want.hits[i].t;
    CheckEverywhere<Real>({scene, rays});
  }
  CHECK(hits > 4000);
}

// Where t is denormal, and where it overflows to minus infinity in an interval without an end.
TEST_CASE("rays at the ends of the range of t trace as the scalar specification") {
  Scene near;
  near.materials.push_back({});
  const double z = 1.4 * 0x1p-83;
  near.objects.push_back({"", Triangle{{Vec3d(-1, -1, z), {1, -1, z}, {0, 1, z}}}, 0});
  const scalar::Ray<float> steep{
      {0, 0, 0}, {0x1p60f, 0x1p60f, 0x1p66f}, kNoPrimitive, 0x1p-149f, 0x1p-149f};
  const Expected<float> at_first(near, std::vector(64, steep));
  CHECK(at_first.hit_count() == 64);
  CheckEverywhere(at_first);

  Scene behind;
  behind.materials.push_back({});
  for (int i = 0; i < 40; ++i) {
    const double far = -1e20;
    behind.objects.push_back(
        {"", Triangle{{Vec3d(-1e20, -1e20, far), {1e20, -1e20, far}, {0, 1e20, far}}}, 0});
  }
  const float infinity = std::numeric_limits<float>::infinity();
  const scalar::Ray<float> slow{{0, 0, 0}, {0, 0, 1e-30f}, kNoPrimitive, -infinity, infinity};
  const Expected<float> never(behind, std::vector(64, slow));
  CHECK(never.hit_count() == 0);
  CheckEverywhere(never);
}

// Nothing under- or overflows where scales are far from 1: hits are those at scale 1, to the bit.
TEST_CASE_TEMPLATE("a scene scaled by a power of two has the same hits", Real, float, double) {
  Random random(10);
  const Scene scene = CrowdedScene(random, 600);
  std::vector<scalar::Ray<Real>> rays;
  for (int i = 0; i < 300; ++i) {
    const auto from = As<Real>(UniformPoint(random, -6, 6));
    rays.push_back({from, As<Real>(UniformPoint(random, -2, 2)) - from});
  }
  const CompiledScene<Real> compiled = CompileScene<Real>(scene);
  std::uint32_t hits = 0;
  for (const int power : {-45, -30, 20, 45}) {
    CAPTURE(power);
    const Real scale = std::ldexp(Real(1), power);
    const CompiledScene<Real> scaled = CompileScene<Real>(Scaled(scene, std::ldexp(1.0, power)));
    for (const scalar::Ray<Real>& ray : rays) {
      const auto hit = scalar::TraceClosest(compiled.geometry(), ray);
      scalar::Ray<Real> as_large = ray;
      as_large.origin = as_large.origin * scale;
      as_large.direction = as_large.direction * scale;
      CHECK(SameHit(scalar::TraceClosest(scaled.geometry(), as_large), hit));
      hits += hit.primitive != kNoPrimitive;
    }
  }
  CHECK(hits > 100);
}

// Beyond the limits of box tests: the same hits, only slower.
TEST_CASE_TEMPLATE("rays and scenes without scale trace as the scalar specification", Real, float,
                   double) {
  Random random(5);
  for (const double scale : {1e-25, 1e-12, 1.0, 1e10, 1e14, 1e18}) {
    CAPTURE(scale);
    const Scene scene = Scaled(CrowdedScene(random, 60), scale);
    std::vector<scalar::Ray<Real>> rays;
    for (const double length : {1e-30, 1e-20, 1.0, 1e17}) {
      for (int i = 0; i < 128; ++i) {
        const Vec3d from = UniformPoint(random, -6, 6), to = UniformPoint(random, -2, 2);
        rays.push_back({As<Real>(from * scale), As<Real>((to - from) * length)});
        rays.back().t_min = std::numeric_limits<Real>::denorm_min();
        if (i % 8 == 0) rays.back().t_min = Real(-1);
      }
    }
    const Expected<Real> want(scene, rays);
    CHECK(want.hit_count() > 10);
    CheckEverywhere(want);
  }
}

// Rays that graze spheres far away, where a float test misjudges: the screen must keep them.
TEST_CASE_TEMPLATE("rays near tangency at any distance trace as the scalar specification", Real,
                   float, double) {
  Random random(6);
  std::uint32_t hits = 0;
  for (double distance = 1; distance <= 1e7; distance *= 10) {
    Scene scene;
    scene.materials.push_back({});
    scene.objects.push_back({"", Sphere{UniformPoint(random, -1, 1), 1.0}, 0});
    const Sphere sphere = std::get<Sphere>(scene.objects[0].shape);
    // Others around it, so that there is a tree.
    for (int i = 0; i < 40; ++i) {
      scene.objects.push_back({"", Sphere{UniformPoint(random, 3, 9), 0.5}, 0});
    }
    std::vector<scalar::Ray<Real>> rays;
    for (int i = 0; i < 1000; ++i) {
      const auto axis = Normalize(
          Vec3<double>{Uniform(random, -1, 1), Uniform(random, -1, 1), Uniform(random, -1, 1)});
      const auto side = Normalize(Cross(axis, Vec3<double>{0.3, -0.5, 0.8}));
      const Vec3<double> center{sphere.center.x, sphere.center.y, sphere.center.z};
      const auto origin = center + axis * (1 + distance);
      const auto target = center + side * (1 + Uniform(random, -1e-6, 1e-6));
      rays.push_back({origin.To<Real>(), (target - origin).template To<Real>()});
    }
    const Expected<Real> want(scene, rays);
    hits += want.hit_count();
    CheckEverywhere(want);
  }
  CHECK(hits > 1000);
  CHECK(hits < 7000);
}

TEST_CASE("a miss is t_max, no primitive and no parameters") {
  const std::vector<scalar::Ray<float>> rays(5, {{0, 0, 0}, {0, 0, 1}, kNoPrimitive, 0.0f, 7.0f});
  Random random(7);
  for (const int objects : {0, 300}) {
    Scene scene = objects ? CrowdedScene(random, objects) : Scene{};
    for (Object& object : scene.objects) object.shape = Sphere{{20, 0, 0}, 1.0};
    const Expected<float> want(scene, rays);
    ForEachTarget([&](Target target) {
      RayBatch<float> batch(rays, 0);
      HitStream<float> hits;
      hits.Allocate(5);
      StrictKernels<float>(target.id())
          .trace_closest(want.tree.view(), batch.view(), batch.intervals(), 5, Coherence::kUnknown,
                         hits.output());
      for (int i = 0; i < 5; ++i) {
        CHECK(hits.view().t[i] == 7.0f);
        CHECK(hits.view().primitive[i] == kNoPrimitive);
        CHECK(hits.view().u[i] == 0.0f);
      }
    });
  }
}

}  // namespace
}  // namespace sheaf
