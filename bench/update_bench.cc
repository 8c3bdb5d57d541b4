// Meshes whose vertices move: Geometry::Update and Build beside Embree's refit and build.
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "bench/embree_peer.h"
#include "bench/interleave.h"
#include "bench/make_scenes.h"
#include "sheaf/geometry.h"
#include "src/lab/rank_statistics.h"

namespace sheaf::bench {
namespace {

// A mesh that Embree keeps as one that moves: its own buffer, which is written and committed.
class EmbreeMesh {
 public:
  EmbreeMesh(RTCDevice device, const BenchScene& scene, RTCBuildQuality quality)
      : count_(scene.vertices.size()) {
    scene_ = rtcNewScene(device);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC);
    // Only a scene of low quality keeps a tree a mesh; others build everything at each commit.
    if (quality != RTC_BUILD_QUALITY_MEDIUM) {
      rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    }
    geometry_ = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry_, quality);
    vertices_ = static_cast<float*>(rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0,
                                                            RTC_FORMAT_FLOAT3, 12, count_ / 3));
    void* const indices = rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0,
                                                  RTC_FORMAT_UINT3, 12, scene.triangle_count());
    std::memcpy(indices, scene.indices.data(), scene.indices.size() * sizeof(std::uint32_t));
    std::memcpy(vertices_, scene.vertices.data(), count_ * sizeof(float));
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }
  ~EmbreeMesh() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }
  EmbreeMesh(const EmbreeMesh&) = delete;
  EmbreeMesh& operator=(const EmbreeMesh&) = delete;

  void Write(const std::vector<float>& vertices) {
    std::memcpy(vertices_, vertices.data(), count_ * sizeof(float));
  }
  void Commit() {
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

 private:
  std::size_t count_;
  RTCScene scene_;
  RTCGeometry geometry_;
  float* vertices_;
};

int Main(int argc, char** argv) {
  CLI::App app("Updates of meshes beside Embree", "update_bench");
  std::string name = "scan-1M";
  int threads = 1, repetitions = 9;
  app.add_option("--scene", name, "Of embree_bench's catalogue")->capture_default_str();
  app.add_option("--threads", threads)->capture_default_str();
  app.add_option("--repetitions", repetitions)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const SceneMaker* maker = nullptr;
  for (const SceneMaker& each : SceneCatalogue()) {
    if (each.name == name) maker = &each;
  }
  if (maker == nullptr) {
    fmt::print(stderr, "no scene is called {}\n", name);
    return 2;
  }
  const BenchScene scene = maker->make();
  std::vector<float> moved = scene.vertices;
  int step = 0;
  // Up and down by a hundredth, each place by another part of it.
  const auto move = [&] {
    ++step;
    for (std::size_t i = 0; i < moved.size(); ++i) {
      const double part = HashUnit(i / 300) * (step % 2 ? 0.01 : 0.005);
      moved[i] = scene.vertices[i] * (1 + static_cast<float>(part));
    }
  };
  const auto input = [&] {
    GeometryInput mesh;
    mesh.AddTriangles(moved, scene.indices);
    return mesh;
  };
  Geometry refit = Geometry::Build(input(), threads).value();
  UpdateOptions options;
  options.threads = threads;
  const EmbreeDevice device(threads);
  EmbreeMesh embree_refit(device.get(), scene, RTC_BUILD_QUALITY_REFIT);
  EmbreeMesh embree_low(device.get(), scene, RTC_BUILD_QUALITY_LOW);
  EmbreeMesh embree_built(device.get(), scene, RTC_BUILD_QUALITY_MEDIUM);
  bool is_refit = true;
  const auto embree = [&](EmbreeMesh& mesh) {
    return Contestant{[&mesh, &moved, &move] {
                        move();
                        mesh.Write(moved);
                      },
                      [&mesh] { mesh.Commit(); }};
  };
  const auto seconds = Interleave(
      {{move, [&] { is_refit &= refit.Update(input(), options).value() == Updated::kRefit; }},
       {move, [&] { (void)Geometry::Build(input(), threads).value(); }},
       embree(embree_refit),
       embree(embree_low),
       embree(embree_built)},
      repetitions);
  if (!is_refit) {
    fmt::print(stderr, "the tree was built anew\n");
    return 1;
  }
  const char* const names[] = {"Sheaf, update", "Sheaf, build", "Embree, refit", "Embree, low",
                               "Embree, build"};
  fmt::print("{}, {} triangles, {} threads\n", name, scene.triangle_count(), threads);
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    fmt::print("{:14} {:8.2f} ms, {:.2f} of Embree's refit\n", names[i], 1e3 * Median(seconds[i]),
               MedianRatio(seconds[i], seconds[2]));
  }
  return 0;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
