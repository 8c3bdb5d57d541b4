// Turns a Scene into the flat arrays that rays read.
#ifndef SHEAF_RENDER_COMPILE_SCENE_H_
#define SHEAF_RENDER_COMPILE_SCENE_H_

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "simd/shading.h"
#include "src/render/build_mip_chain.h"
#include "src/render/compile_emitters.h"
#include "src/render/compile_geometry.h"
#include "src/render/compile_gloss.h"
#include "src/render/place_scene.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// Owns what a FrameView shows, all but the camera and the samples.
template <typename Real>
struct CompiledScene {
  CompiledGeometry<Real> objects;
  std::vector<MaterialData<Real>> materials;
  GlossTables<Real> gloss;  // that the materials read
  std::vector<TextureData<Real>> textures;
  std::vector<std::shared_ptr<const Image>> images;  // that the textures show
  // Of images that are seen through Filter::kMip, which textures share.
  std::map<std::pair<const Image*, Transfer>, MipChain> chains;
  std::vector<Real> decode[2];  // by Transfer, 256 each; empty where no texture has it
  std::vector<LightData<Real>> lights;
  std::unique_ptr<EmitterTable<Real>>
      emitters;  // that one of the lights reads, where there are any
  Real background[3];
  EnvironmentData<Real> environment;
  std::shared_ptr<const FloatImage> environment_image;  // that the environment shows, or null

  GeometryView<Real> geometry() const { return objects.data.arrays.view(); }
};

// The ambient light of a scene: its own, or what all around it gives on average.
Colour AmbientLightOf(const Settings& settings);

// Without the tree: objects.data.BuildTree.
template <typename Real>
CompiledScene<Real> CompileScene(const Scene& scene, const ScenePlacement& placement = {},
                                 Integrator integrator = Integrator::kDistributed);

// The camera for a picture of width x height pixels, placed as the scene is.
template <typename Real>
CameraData<Real> CompileCamera(const Camera& camera, int width, int height,
                               const ScenePlacement& placement = {});

// The cone of a ray that stands for one of `samples_a_pixel` even parts of a pixel.
template <typename Real>
PixelCone<Real> CompileCone(const CameraData<Real>& camera, double samples_a_pixel);

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_SCENE_H_
