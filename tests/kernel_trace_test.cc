// The tracing kernels against src/scalar, bit by bit, on every target.
#include <bit>
#include <cstring>

#include "random_scene.h"
#include "simd/trace_closest.h"
#include "simd/trace_occluded.h"
#include "src/scalar/trace.h"
#include "targets.h"

namespace sheaf {
namespace {

template <typename Real>
bool SameBits(Real a, Real b) {
  return std::memcmp(&a, &b, sizeof(Real)) == 0;
}

// Rays in the arrays that a caller would hand in, `offset` elements into them.
template <typename Real>
struct RayBatch {
  std::uint32_t offset, count;
  RayStream<Real> rays;
  AlignedArray<Real> t_min, t_max;

  RayBatch(const std::vector<scalar::Ray<Real>>& from, std::uint32_t at)
      : offset(at), count(static_cast<std::uint32_t>(from.size())) {
    rays.Allocate(count + offset);
    t_min.Allocate(StreamCapacity(count + offset));
    t_max.Allocate(StreamCapacity(count + offset));
    const auto out = rays.output(offset);
    for (std::uint32_t i = 0; i < count; ++i) {
      out.origin_x[i] = from[i].origin.x;
      out.origin_y[i] = from[i].origin.y;
      out.origin_z[i] = from[i].origin.z;
      out.direction_x[i] = from[i].direction.x;
      out.direction_y[i] = from[i].direction.y;
      out.direction_z[i] = from[i].direction.z;
      out.source[i] = from[i].source;
      t_min[offset + i] = from[i].t_min;
      t_max[offset + i] = from[i].t_max;
    }
  }

  RayView<Real> view() {
    RayView<Real> view;
    auto out = rays.output(offset);
    ForEachField(view, out, [](auto& to, auto from) { to = from; });
    return view;
  }
  RayIntervals<Real> intervals() const { return {t_min.data() + offset, t_max.data() + offset}; }
};

template <typename Real>
void CheckTraces(const CompiledScene<Real>& scene, const std::vector<scalar::Ray<Real>>& rays,
                 std::uint32_t offset) {
  RayBatch<Real> batch(rays, offset);
  HitStream<Real> hits;
  hits.Allocate(batch.count);
  AlignedArray<std::uint32_t> occluded;
  occluded.Allocate(StreamCapacity(batch.count));
  const GeometryView<Real> geometry = scene.geometry();
  simd::TraceClosest(geometry, batch.view(), batch.intervals(), batch.count, hits.output());
  simd::TraceOccluded(geometry, batch.view(), batch.intervals(), batch.count, occluded.data());
  const auto got = hits.view();
  std::uint32_t wrong_hits = 0, wrong_shadows = 0;
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    const scalar::Hit<Real> want = scalar::TraceClosest(geometry, rays[i]);
    // The interval of a missing ray may be NaN, whose bits are nobody's promise.
    const bool same_t = SameBits(got.t[i], want.t) || (got.t[i] != got.t[i] && want.t != want.t);
    wrong_hits += !(same_t && SameBits(got.u[i], want.u) && SameBits(got.v[i], want.v) &&
                    got.primitive[i] == want.primitive);
    wrong_shadows += occluded[i] != (scalar::TraceOccluded(geometry, rays[i]) ? 1u : 0u);
  }
  CHECK(wrong_hits == 0);
  CHECK(wrong_shadows == 0);
}

template <typename Real>
std::vector<scalar::Ray<Real>> RandomRays(Random& random, std::uint32_t count,
                                          std::uint32_t primitives) {
  std::vector<scalar::Ray<Real>> rays;
  for (std::uint32_t i = 0; i < count; ++i) rays.push_back(RandomRay<Real>(random, primitives));
  return rays;
}

TEST_CASE_TEMPLATE("every count and offset traces as the scalar specification", Real, float,
                   double) {
  ForEachTarget([](const std::string&) {
    Random random(1);
    const CompiledScene<Real> scene = CompileScene<Real>(RandomScene(random, 12));
    const auto primitives = static_cast<std::uint32_t>(scene.primitives.size());
    for (std::uint32_t count = 1; count <= 2 * kMaxLanes + 1; ++count) {
      for (std::uint32_t offset = 0; offset < 4; ++offset) {
        CheckTraces(scene, RandomRays<Real>(random, count, primitives), offset);
      }
    }
  });
}

TEST_CASE_TEMPLATE("random scenes trace as the scalar specification", Real, float, double) {
  ForEachTarget([](const std::string&) {
    Random random(2);
    for (int round = 0; round < 40; ++round) {
      const CompiledScene<Real> scene = CompileScene<Real>(RandomScene(random, round));
      const auto primitives = static_cast<std::uint32_t>(scene.primitives.size());
      CheckTraces(scene, RandomRays<Real>(random, 512, primitives), 0);
    }
  });
}

// Rays that graze spheres far away, where a float test misjudges: the screen must keep them.
TEST_CASE_TEMPLATE("rays near tangency at any distance trace as the scalar specification", Real,
                   float, double) {
  ForEachTarget([](const std::string&) {
    Random random(3);
    std::uint32_t hits = 0;
    for (double distance = 1; distance <= 1e7; distance *= 10) {
      Scene scene;
      scene.materials.push_back({});
      scene.objects.push_back({"", Sphere{UniformPoint(random, -1, 1), 1.0}, 0});
      const CompiledScene<Real> compiled = CompileScene<Real>(scene);
      const Sphere& sphere = std::get<Sphere>(scene.objects[0].shape);
      std::vector<scalar::Ray<Real>> rays;
      for (int i = 0; i < 1000; ++i) {
        const auto axis = scalar::Normalize(scalar::Vec3<double>{
            Uniform(random, -1, 1), Uniform(random, -1, 1), Uniform(random, -1, 1)});
        const auto side =
            scalar::Normalize(scalar::Cross(axis, scalar::Vec3<double>{0.3, -0.5, 0.8}));
        const scalar::Vec3<double> center{sphere.center.x, sphere.center.y, sphere.center.z};
        const auto origin = center + axis * (1 + distance);
        const auto target = center + side * (1 + Uniform(random, -1e-6, 1e-6));
        rays.push_back({origin.To<Real>(), (target - origin).template To<Real>()});
        hits += scalar::TraceOccluded(compiled.geometry(), rays.back());
      }
      CheckTraces(compiled, rays, 0);
    }
    CHECK(hits > 1000);
    CHECK(hits < 7000);
  });
}

TEST_CASE("a miss is t_max, no primitive and no parameters") {
  ForEachTarget([](const std::string&) {
    const CompiledScene<float> scene = CompileScene<float>(Scene{});
    const std::vector<scalar::Ray<float>> rays(5, {{0, 0, 0}, {0, 0, 1}, kNoPrimitive, 0.0f, 7.0f});
    RayBatch<float> batch(rays, 0);
    HitStream<float> hits;
    hits.Allocate(5);
    simd::TraceClosest(scene.geometry(), batch.view(), batch.intervals(), 5, hits.output());
    for (int i = 0; i < 5; ++i) {
      CHECK(hits.view().t[i] == 7.0f);
      CHECK(hits.view().primitive[i] == kNoPrimitive);
      CHECK(hits.view().u[i] == 0.0f);
    }
  });
}

}  // namespace
}  // namespace sheaf
