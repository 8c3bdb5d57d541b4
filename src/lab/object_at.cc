#include "src/lab/object_at.h"

#include "simd/query.h"
#include "simd/shading.h"
#include "src/render/compile_scene.h"
#include "src/render/place_scene.h"
#include "src/scalar/camera_ray.h"
#include "src/scalar/trace.h"

namespace sheaf {

std::optional<std::uint32_t> ObjectAt(const Scene& scene, const Camera& camera, int width,
                                      int height, int x, int y) {
  const ScenePlacement placement = PlaceScene(scene, camera);
  const CompiledScene<float> compiled = CompileScene<float>(scene, placement);
  const CameraData<float> lens = CompileCamera<float>(camera, width, height, placement);
  const scalar::Ray<float> ray =
      scalar::CameraRay(lens, static_cast<float>(x), static_cast<float>(y), 0.5f, 0.5f);
  const scalar::Hit<float> hit = scalar::TraceClosest(compiled.geometry(), ray);
  if (hit.primitive == kNoPrimitive) return std::nullopt;
  return compiled.objects.object_of_primitive[hit.primitive];
}

}  // namespace sheaf
