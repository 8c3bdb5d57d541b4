#include "src/lab/object_at.h"

#include "simd/query.h"
#include "simd/shading.h"
#include "src/render/compile_scene.h"
#include "src/render/place_scene.h"
#include "src/scalar/camera_ray.h"
#include "src/scalar/trace.h"

namespace sheaf {
namespace {

stress::Ray RayOf(const ScenePlacement& placement, const Camera& camera, int width, int height,
                  int x, int y) {
  const CameraData<float> lens = CompileCamera<float>(camera, width, height, placement);
  return scalar::PinholeRay(lens, static_cast<float>(x), static_cast<float>(y), 0.5f, 0.5f);
}

Vec3d ToVec(const Vec3<float>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace

PixelRay RayAt(const Scene& scene, const Camera& camera, int width, int height, int x, int y) {
  const ScenePlacement placement = PlaceScene(scene, camera);
  const stress::Ray ray = RayOf(placement, camera, width, height, x, y);
  return {ray, ToVec(ray.origin) / placement.scale + placement.origin, ToVec(ray.direction)};
}

std::optional<std::uint32_t> ObjectAt(const Scene& scene, const Camera& camera, int width,
                                      int height, int x, int y) {
  const ScenePlacement placement = PlaceScene(scene, camera);
  const CompiledScene<float> compiled = CompileScene<float>(scene, placement);
  const stress::Ray ray = RayOf(placement, camera, width, height, x, y);
  const scalar::Hit<float> hit = scalar::TraceClosest(compiled.geometry(), ray);
  if (hit.primitive == kNoPrimitive) return std::nullopt;
  return compiled.objects.object_of_primitive[hit.primitive];
}

}  // namespace sheaf
