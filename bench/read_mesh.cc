#include "bench/read_mesh.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <variant>
#include <vector>

#include "sheaf/formats.h"
#include "src/render/compile_scene.h"

namespace sheaf::bench {
namespace {

// The box around all that is finite: what cannot be hit is NaN.
struct Bounds {
  float lower[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
  float upper[3] = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};

  void Include(const float* point, float radius) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], point[axis] - radius);
      upper[axis] = std::max(upper[axis], point[axis] + radius);
    }
  }
};

void AddTriangles(const TriangleArrays<float>& triangles, BenchScene& scene, Bounds& bounds) {
  for (std::uint32_t i = 0; i < triangles.count; ++i) {
    float points[3][3];
    bool is_finite = true;
    for (int k = 0; k < 9; ++k) {
      points[k / 3][k % 3] = triangles.vertex[k / 3][k % 3][i];
      is_finite &= std::isfinite(points[k / 3][k % 3]);
    }
    if (!is_finite) continue;
    for (const auto& point : points) {
      scene.indices.push_back(static_cast<std::uint32_t>(scene.vertices.size() / 3));
      scene.vertices.insert(scene.vertices.end(), point, point + 3);
      bounds.Include(point, 0);
    }
  }
}

void AddSpheres(const SphereArrays<float>& spheres, BenchScene& scene, Bounds& bounds) {
  for (std::uint32_t i = 0; i < spheres.count; ++i) {
    float fields[4];
    float* next = fields;
    SphereArrays<float>::ForEachField(spheres, [&](const float* field) { *next++ = field[i]; });
    if (!std::isfinite(fields[3])) continue;
    scene.spheres.insert(scene.spheres.end(), fields, fields + 4);
    bounds.Include(fields, fields[3]);
  }
}

void Frame(const Bounds& bounds, BenchScene& scene) {
  float size = 0;
  for (int axis = 0; axis < 3; ++axis) {
    size = std::max(size, bounds.upper[axis] - bounds.lower[axis]);
  }
  constexpr float kEye[3] = {0.6f, 0.5f, 1.4f}, kLight[3] = {-0.8f, 1.6f, 1.2f};
  for (int axis = 0; axis < 3; ++axis) {
    const float middle = bounds.lower[axis] / 2 + bounds.upper[axis] / 2;
    scene.look_at[axis] = middle;
    scene.eye[axis] = middle + kEye[axis] * size;
    scene.light[axis] = middle + kLight[axis] * size;
    scene.up[axis] = axis == 1 ? 1.0f : 0.0f;
  }
  scene.fov = 50;
}

void LookThrough(const Camera& camera, BenchScene& scene) {
  const auto* perspective = std::get_if<Perspective>(&camera.projection);
  if (perspective == nullptr) return;
  for (int axis = 0; axis < 3; ++axis) {
    scene.eye[axis] = static_cast<float>(camera.eye[axis]);
    scene.look_at[axis] = static_cast<float>(camera.look_at[axis]);
    scene.up[axis] = static_cast<float>(camera.up[axis]);
  }
  scene.fov = static_cast<float>(perspective->fov_y);
}

}  // namespace

Result<BenchScene> ReadMesh(const std::string& path, MeshView view) {
  const Result<ReadSceneResult> read = ReadScene(path);
  if (!read) return read.error();
  const CompiledScene<float> compiled = CompileScene<float>(read.value().scene);
  BenchScene scene{};
  scene.name = std::filesystem::path(path).filename().string();
  Bounds bounds;
  const GeometryView<float> geometry = compiled.geometry();
  AddTriangles(geometry.triangles, scene, bounds);
  AddSpheres(geometry.spheres, scene, bounds);
  if (scene.primitive_count() == 0) {
    return Error{ErrorKind::kUsage, path + ": no triangles and no spheres that a ray can hit"};
  }
  Frame(bounds, scene);
  const std::vector<Camera>& cameras = read.value().scene.cameras;
  if (view == MeshView::kCamera && !cameras.empty()) LookThrough(cameras[0], scene);
  return scene;
}

}  // namespace sheaf::bench
