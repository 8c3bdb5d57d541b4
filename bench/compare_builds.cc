#include "bench/compare_builds.h"

#include <fmt/format.h>

#include <cstdlib>
#include <memory>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/interleave.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/bvh/build_tree.h"
#include "src/bvh/geometry_access.h"
#include "src/core/aligned_array.h"

namespace sheaf::bench {
namespace {

template <typename T>
const T& ValueOrExit(const Result<T>& result) {
  if (!result) {
    fmt::print(stderr, "embree_bench: {}\n", result.error().message);
    std::exit(EXIT_FAILURE);
  }
  return result.value();
}

}  // namespace

BuildComparison CompareBuilds(const BenchScene& scene, int repetitions) {
  GeometryInput input;
  if (scene.triangle_count() > 0) input.AddTriangles(scene.vertices, scene.indices);
  if (scene.sphere_count() > 0) input.AddSpheres(scene.spheres);
  const Result<FlatInput> flat = GeometryAccess::Flatten(input, 1);
  const GeometryView<float> arrays = ValueOrExit(flat).arrays.view();

  BuildComparison comparison{};
  comparison.scene = scene.name;
  comparison.primitives = scene.primitive_count();

  // What a build leaves behind is freed before the next contestant, outside of its time. So is the
  // device: while several live, Embree builds on as many threads as the largest has, and limits all
  // of oneTBB, on which Sheaf builds, to that.
  std::unique_ptr<EmbreeDevice> device;
  std::unique_ptr<EmbreeScene> embree;
  std::unique_ptr<Result<Geometry>> geometry;
  std::unique_ptr<Result<Tree<float>>> tree;
  auto clear = [&] {
    embree.reset();
    device.reset();
    geometry.reset();
    tree.reset();
  };
  auto prepare_embree = [&](int threads) {
    clear();
    device = std::make_unique<EmbreeDevice>(threads);
    embree = std::make_unique<EmbreeScene>(*device, scene, RTC_BUILD_QUALITY_MEDIUM);
  };
  std::vector<Contestant> contestants;
  for (const int threads : {1, 2}) {
    contestants.push_back({[&, threads] { prepare_embree(threads); }, [&] { embree->Commit(); }});
    contestants.push_back({clear, [&, threads] {
                             geometry = std::make_unique<Result<Geometry>>(
                                 Geometry::Build(input, threads));
                           }});
    contestants.push_back({clear, [&, threads] {
                             tree =
                                 std::make_unique<Result<Tree<float>>>(BuildTree(arrays, threads));
                           }});
  }
  Interleave(contestants, 1);  // pages touched, threads started
  const auto seconds = Interleave(contestants, repetitions);
  for (int i = 0; i < 2; ++i) {
    const auto* const of = &seconds[3 * i];
    comparison.times[i] = {i + 1, 1e3 * Median(of[0]), 1e3 * Median(of[1]), 1e3 * Median(of[2]),
                           MedianRatio(of[0], of[1])};
  }

  prepare_embree(1);
  embree->Commit();
  const double n = scene.primitive_count();
  comparison.embree_bytes_a_primitive = static_cast<double>(device->bytes_held()) / n;
  const Result<Geometry> built = Geometry::Build(input, 1);
  comparison.sheaf_bytes_a_primitive =
      static_cast<double>(ValueOrExit(built).statistics().bytes) / n;
  ValueOrExit(BuildTree(arrays, 1));
  return comparison;
}

}  // namespace sheaf::bench
