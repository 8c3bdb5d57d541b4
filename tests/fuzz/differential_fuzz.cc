// A small scene and rays by the bytes: the baseline through the tree and every traversal of every
// target find what the specification finds by trying each primitive.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/target.h"
#include "simd/kernels.h"
#include "simd/query.h"
#include "src/bvh/build_tree.h"
#include "src/render/compile_scene.h"
#include "src/scalar/trace_tree.h"
#include "src/stream/stream.h"
#include "tests/bits.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace sheaf;
using fuzz::Input;

// Small multiples of a power of two meet at edges and vertices; others are anywhere.
class Numbers {
 public:
  explicit Numbers(Input& input) : input_(input), style_(input.Take<std::uint8_t>() % 3) {}

  double Take() {
    const double step = input_.Take<std::int8_t>();
    if (style_ == 0) return step / 32;
    if (style_ == 1) return step / 7 + input_.Take<std::int16_t>() * 1e-7;
    return step * (input_.Take<std::uint8_t>() % 2 ? 1e-4 : 1e4);
  }
  Vec3d TakePoint() {
    const double x = Take(), y = Take();
    return {x, y, Take()};
  }

 private:
  Input& input_;
  int style_;
};

Scene TakeScene(Input& input) {
  Scene scene;
  scene.materials.push_back({});
  std::vector<Vec3d> corners;  // that triangles share
  Numbers numbers(input);
  for (int i = 0; i < 8; ++i) corners.push_back(numbers.TakePoint());
  for (int left = input.Take<std::uint8_t>() % 24; left > 0; --left) {
    Object object;
    switch (input.Take<std::uint8_t>() % 4) {
      case 0:
        object.shape = Sphere{numbers.TakePoint(), std::abs(numbers.Take())};
        break;
      case 1:
        object.shape = Disk{numbers.TakePoint(), std::abs(numbers.Take()), numbers.TakePoint()};
        break;
      default: {
        Triangle triangle;
        for (Vec3d& vertex : triangle.vertices) vertex = corners[input.Take<std::uint8_t>() % 8];
        object.shape = triangle;
      }
    }
    scene.objects.push_back(object);
  }
  return scene;
}

std::vector<scalar::Ray<double>> TakeRays(Input& input) {
  std::vector<scalar::Ray<double>> rays(1 + input.Take<std::uint8_t>() % 70);
  Numbers numbers(input);
  const bool share_origin = input.Take<std::uint8_t>() % 2;
  const auto point = [&] {
    const Vec3d p = numbers.TakePoint();
    return Vec3<double>{p.x, p.y, p.z};
  };
  const Vec3<double> shared = point();
  for (scalar::Ray<double>& ray : rays) {
    ray.origin = share_origin ? shared : point();
    ray.direction = point();
    const std::uint8_t choice = input.Take<std::uint8_t>();
    if (choice < 16) ray.t_max = std::abs(numbers.Take());
    if (choice > 240) ray.t_min = numbers.Take();
    if (choice % 16 == 7) ray.source = choice / 16;
  }
  return rays;
}

template <typename Real>
bool SameHit(const scalar::Hit<Real>& a, const scalar::Hit<Real>& b) {
  const bool same_t = SameBits(a.t, b.t) || (a.t != a.t && b.t != b.t);
  return same_t && SameBits(a.u, b.u) && SameBits(a.v, b.v) && a.primitive == b.primitive;
}

template <typename Real>
void Compare(const Scene& scene, const std::vector<scalar::Ray<double>>& given) {
  const CompiledScene<Real> compiled = CompileScene<Real>(scene);
  const Result<Tree<Real>> tree = BuildTree<Real>(compiled.geometry());
  if (!tree) fuzz::Fail(tree.error().message);
  const auto count = static_cast<std::uint32_t>(given.size());
  RayStream<Real> rays;
  AlignedArray<Real> t_min, t_max;
  rays.Allocate(count);
  t_min.Allocate(StreamCapacity(count));
  t_max.Allocate(StreamCapacity(count));
  const RayOutput<Real> to = rays.output();
  std::vector<scalar::Hit<Real>> hits(count);
  std::vector<bool> occluded(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    scalar::Ray<Real> ray;
    ray.origin = given[i].origin.template To<Real>();
    ray.direction = given[i].direction.template To<Real>();
    ray.source = given[i].source;
    const bool is_bounded = given[i].t_max < 1e300;
    if (is_bounded) ray.t_max = static_cast<Real>(given[i].t_max);
    if (given[i].t_min != kDefaultTMin<double>) ray.t_min = static_cast<Real>(given[i].t_min);
    to.origin_x[i] = ray.origin.x, to.origin_y[i] = ray.origin.y, to.origin_z[i] = ray.origin.z;
    to.direction_x[i] = ray.direction.x;
    to.direction_y[i] = ray.direction.y;
    to.direction_z[i] = ray.direction.z;
    to.source[i] = ray.source;
    t_min[i] = ray.t_min, t_max[i] = ray.t_max;
    hits[i] = scalar::TraceClosest(compiled.geometry(), ray);
    occluded[i] = scalar::TraceOccluded(compiled.geometry(), ray);
    if (!SameHit(scalar::TraceClosest(tree.value().view(), ray), hits[i]) ||
        scalar::TraceOccluded(tree.value().view(), ray) != occluded[i]) {
      fuzz::Fail("the baseline through the tree, ray " + std::to_string(i));
    }
  }
  HitStream<Real> found;
  found.Allocate(count);
  AlignedArray<std::uint32_t> shadows;
  shadows.Allocate(StreamCapacity(count));
  for (const std::string& name : UsableTargets()) {
    const Kernels<Real> kernels = StrictKernels<Real>(Target::Named(name)->id());
    for (const Coherence hint : {Coherence::kUnknown, Coherence::kCommonOrigin,
                                 Coherence::kCoherent, Coherence::kIncoherent}) {
      const RayIntervals<Real> intervals = {t_min.data(), t_max.data()};
      kernels.trace_closest(tree.value().view(), rays.view(), intervals, count, hint,
                            found.output());
      kernels.trace_occluded(tree.value().view(), rays.view(), intervals, count, hint,
                             shadows.data());
      const auto got = found.view();
      for (std::uint32_t i = 0; i < count; ++i) {
        const scalar::Hit<Real> hit = {got.t[i], got.primitive[i], got.u[i], got.v[i]};
        if (SameHit(hit, hits[i]) && (shadows[i] != 0) == occluded[i]) continue;
        fuzz::Fail(name + ", hint " + std::to_string(static_cast<int>(hint)) + ", ray " +
                   std::to_string(i));
      }
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 16) return 0;
  Input input(data, size);
  const Scene scene = TakeScene(input);
  const std::vector<scalar::Ray<double>> rays = TakeRays(input);
  Compare<float>(scene, rays);
  Compare<double>(scene, rays);
  return 0;
}
