#include "src/lab/find_thin_walls.h"

#include <algorithm>

#include "simd/shading.h"
#include "src/core/vec3.h"
#include "src/render/compile_scene.h"
#include "src/render/place_scene.h"
#include "src/scalar/trace_tree.h"
#include "src/scalar/triangle.h"

namespace sheaf {
namespace {

using Vec = Vec3<double>;

// A ray starts an offset off the surface, and its position and its start are rounded.
constexpr double kTwoRoundings = 2 * kRoundoff<float>;

class WallFinder {
 public:
  WallFinder(const CompiledScene<double>& scene, double scale) : scene_(scene), scale_(scale) {}

  // Into the glass of primitive `id` from point `p` on it, against the unit normal `out`.
  void Look(std::uint32_t id, Vec p, Vec out, double offset) {
    const PrimitiveInfo& info = scene_.objects.primitives[id];
    // What alpha leaves out passes rays too, but bends none.
    if (!AnyPositive(scene_.materials[info.material].transmit)) return;
    if (info.index() >= scene_.objects.data.own[info.kind()]) return;  // a group's, elsewhere
    const double needed = (offset + kTwoRoundings) * AbsDot(out, p);
    scalar::Ray<double> ray{p, -out, id | kInsideBit};
    ray.t_max = needed;
    const auto hit = scalar::TraceClosest(scene_.objects.data.tree.view(), ray);
    if (hit.primitive == kNoPrimitive) return;
    const std::size_t object = scene_.objects.object_of_primitive[id];
    const ThinWall wall = {object, hit.t / scale_, needed / scale_};
    if (walls_.empty() || walls_.back().object != object) {
      walls_.push_back(wall);
    } else if (wall.thickness * walls_.back().needed < walls_.back().thickness * wall.needed) {
      walls_.back() = wall;
    }
  }

  std::vector<ThinWall> walls() const { return walls_; }

 private:
  const CompiledScene<double>& scene_;
  double scale_;
  std::vector<ThinWall> walls_;
};

}  // namespace

std::vector<ThinWall> FindThinWalls(const Scene& scene) {
  const auto transmits = [](const Material& m) {
    return m.transmit.r > 0 || m.transmit.g > 0 || m.transmit.b > 0;
  };
  if (std::none_of(scene.materials.begin(), scene.materials.end(), transmits)) return {};
  const ScenePlacement placement =
      scene.cameras.empty() ? ScenePlacement{} : PlaceScene(scene, scene.cameras[0]);
  CompiledScene<double> compiled = CompileScene<double>(scene, placement);
  if (!compiled.objects.data.BuildTree(0)) return {};
  WallFinder finder(compiled, placement.scale);
  const GeometryView<double> geometry = compiled.geometry();
  const TriangleArrays<double>& triangles = geometry.triangles;
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    const Vec a = scalar::TriangleVertex(triangles, i, 0),
              b = scalar::TriangleVertex(triangles, i, 1),
              c = scalar::TriangleVertex(triangles, i, 2);
    finder.Look(triangles.id[i], (a + b + c) * (1.0 / 3), Normalize(Cross(b - a, c - a)),
                kFoldRoundoffs<float>);
  }
  const SphereArrays<double>& spheres = geometry.spheres;
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    const Vec center = {spheres.center_x[i], spheres.center_y[i], spheres.center_z[i]};
    for (int k = 0; k < 27; ++k) {
      const Vec towards = {k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 - 1.0};
      if (Dot(towards, towards) == 0) continue;
      const Vec out = Normalize(towards);
      finder.Look(spheres.id[i], center + out * spheres.radius[i], out, kPositionRoundoffs<float>);
    }
  }
  const DiskArrays<double>& disks = geometry.disks;
  for (std::uint32_t i = 0; i < disks.count; ++i) {
    finder.Look(disks.id[i], {disks.center_x[i], disks.center_y[i], disks.center_z[i]},
                Normalize(Vec{disks.normal_x[i], disks.normal_y[i], disks.normal_z[i]}),
                kPositionRoundoffs<float>);
  }
  std::vector<ThinWall> walls = finder.walls();
  std::sort(walls.begin(), walls.end(),
            [](const ThinWall& a, const ThinWall& b) { return a.object < b.object; });
  return walls;
}

}  // namespace sheaf
