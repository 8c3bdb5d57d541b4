// Turns a Scene into the flat arrays that rays read.
#ifndef SHEAF_RENDER_COMPILE_SCENE_H_
#define SHEAF_RENDER_COMPILE_SCENE_H_

#include <memory>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "simd/shading.h"
#include "simd/tree.h"
#include "src/core/aligned_array.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Owns what a FrameView shows, all but the camera and the samples. Primitive ids follow the order
// of the scene's objects; a quad is two triangles.
template <typename Real>
struct CompiledScene {
  AlignedArray<Real> sphere_center[3], sphere_radius;
  AlignedArray<std::uint32_t> sphere_id;
  AlignedArray<Real> triangle_vertex[3][3];
  // Empty where no material has coordinates, no mesh normals, no mesh colours.
  AlignedArray<Real> triangle_uv[3][2], triangle_normal[3][3], triangle_colour[3][3];
  AlignedArray<std::uint32_t> triangle_id;
  std::uint32_t sphere_count = 0, triangle_count = 0;
  std::vector<PrimitiveInfo> primitives;
  std::vector<std::uint32_t> object_of_primitive;
  std::vector<MaterialData<Real>> materials;
  std::vector<TextureData<Real>> textures;
  std::vector<std::shared_ptr<const Image>> images;  // that the textures show
  std::vector<Real> decode[2];  // by Transfer, 256 each; empty where no texture has it
  std::vector<LightData<Real>> lights;
  Real background[3];

  GeometryView<Real> geometry() const;
};

// Spheres of radius 0 and triangles without area are kept, as NaN, and never hit.
template <typename Real>
CompiledScene<Real> CompileScene(const Scene& scene);

// The camera for a picture of width x height pixels.
template <typename Real>
CameraData<Real> CompileCamera(const Camera& camera, int width, int height);

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_SCENE_H_
