// What a picture shows at a place.
#ifndef SHEAF_LAB_OBJECT_AT_H_
#define SHEAF_LAB_OBJECT_AT_H_

#include <cstdint>
#include <optional>

#include "sheaf/scene.h"
#include "src/lab/stress.h"

namespace sheaf {

// The ray through the middle of a pixel: as it is traced, and in the scene's own coordinates.
struct PixelRay {
  stress::Ray computed;
  Vec3d origin, direction;  // of unit length
};
PixelRay RayAt(const Scene& scene, const Camera& camera, int width, int height, int x, int y);

// Index of the object that the middle of pixel (x, y) of a width x height picture shows; nothing
// for the background. Takes as long as a ray takes to try every primitive.
std::optional<std::uint32_t> ObjectAt(const Scene& scene, const Camera& camera, int width,
                                      int height, int x, int y);

}  // namespace sheaf

#endif  // SHEAF_LAB_OBJECT_AT_H_
