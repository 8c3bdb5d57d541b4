// A mesh whose vertices move, beside Embree in one process and in turn: refits and builds.
// docs/geometry.md says how to read the table.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/interleave.h"
#include "bench/make_scenes.h"
#include "sheaf/geometry.h"

namespace sheaf::bench {
namespace {

// One mesh whose tree Embree refits at each commit.
class EmbreeMesh {
 public:
  EmbreeMesh(const EmbreeDevice& device, const BenchScene& mesh, RTCBuildQuality scene_quality)
      : vertices_(mesh.vertices), scene_(rtcNewScene(device.get())) {
    vertices_.push_back(0);  // 16 bytes are read at every vertex
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(scene_, scene_quality);
    geometry_ = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry_, RTC_BUILD_QUALITY_REFIT);
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               vertices_.data(), 0, 3 * sizeof(float), mesh.vertices.size() / 3);
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.indices.data(), 0, 3 * sizeof(std::uint32_t),
                               mesh.triangle_count());
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;
  ~EmbreeMesh() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }

  // What a host that moves vertices in place has done before.
  void Move(const std::vector<float>& vertices) {
    std::copy(vertices.begin(), vertices.end(), vertices_.begin());
  }
  void Refit() {
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

 private:
  std::vector<float> vertices_;
  RTCScene scene_;
  RTCGeometry geometry_;
};

// The vertices at a moment of a wave that runs through the mesh.
std::vector<float> Wave(const std::vector<float>& vertices, float phase) {
  std::vector<float> moved = vertices;
  for (std::size_t i = 0; i < moved.size(); i += 3) {
    const float along = vertices[i] + 0.5f * vertices[i + 1];
    for (std::size_t k = 0; k < 3; ++k) moved[i + k] *= 1 + 0.1f * std::sin(5 * along + phase);
  }
  return moved;
}

void Compare(const BenchScene& mesh, int threads, int repetitions) {
  const EmbreeDevice device(threads);
  EmbreeMesh low(device, mesh, RTC_BUILD_QUALITY_LOW);
  EmbreeMesh medium(device, mesh, RTC_BUILD_QUALITY_MEDIUM);
  const std::array<std::vector<float>, 2> moved = {Wave(mesh.vertices, 0), Wave(mesh.vertices, 1)};
  std::array<GeometryInput, 2> inputs;
  for (std::size_t k = 0; k < 2; ++k) inputs[k].AddTriangles(moved[k], mesh.indices);
  Geometry geometry = Geometry::Build(inputs[0], threads).value();
  std::array<std::size_t, 3> turn = {};
  const UpdateOptions options{.threads = threads,
                              .rebuild_ratio = std::numeric_limits<double>::infinity()};
  const auto move = [&](EmbreeMesh& of, std::size_t k) { of.Move(moved[++turn[k] % 2]); };
  const std::vector<Contestant> contestants = {
      {[&] { move(low, 0); }, [&] { low.Refit(); }},
      {[&] { move(medium, 1); }, [&] { medium.Refit(); }},
      {[] {}, [&] { geometry.Update(inputs[++turn[2] % 2], options).value(); }},
      {[] {}, [&] { Geometry::Build(inputs[1], threads).value(); }},
  };
  Interleave(contestants, 1);  // pages touched, threads started
  const auto seconds = Interleave(contestants, repetitions);
  const std::size_t best = Median(seconds[0]) < Median(seconds[1]) ? 0 : 1;
  fmt::print("| {} | {} | {:.1f} / {:.1f} = **{:.2f}** | {:.1f} |\n", mesh.triangle_count(),
             threads, 1e3 * Median(seconds[best]), 1e3 * Median(seconds[2]),
             MedianRatio(seconds[best], seconds[2]), 1e3 * Median(seconds[3]));
}

int Main(int argc, char** argv) {
  std::uint32_t frequency = 224;
  int repetitions = 15;
  CLI::App app("Refits of a mesh beside Embree 3");
  app.add_option("--frequency", frequency, "of the mesh: 20 times its square triangles");
  app.add_option("--repetitions", repetitions);
  CLI11_PARSE(app, argc, argv);
  const BenchScene mesh = GeodesicSphere(frequency);
  fmt::print(
      "| triangles | threads | refit, ms: Embree / Sheaf = ratio | build, ms: Sheaf |\n"
      "|---|---|---|---|\n");
  for (const int threads : {1, 2}) Compare(mesh, threads, repetitions);
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
