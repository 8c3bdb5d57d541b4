// A scene as rays read it, kept from picture to picture: trees, tables and small copies of images
// take longer than many a picture.
#ifndef SHEAF_RENDER_PREPARE_SCENE_H_
#define SHEAF_RENDER_PREPARE_SCENE_H_

#include <memory>
#include <mutex>
#include <tuple>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/render/compile_scene.h"
#include "src/render/place_scene.h"

namespace sheaf {

// Whether work that a scene does not need is left out. It changes no bit; tests see to that.
enum class Skips { kOn, kOff };

// A compiled scene with its trees, and what it was compiled for.
template <typename Real>
struct PreparedScene {
  CompiledScene<Real> compiled;
  ScenePlacement placement;
  Integrator integrator = Integrator::kWhitted;
  Skips skips = Skips::kOn;
  bool has_rounded_corners = false;  // by how near the eye is
};

// One scene's: of each arithmetic the last that was asked for.
class ScenePreparer {
 public:
  // The scene outlives this, and nothing changes it meanwhile.
  explicit ScenePreparer(const Scene& scene) : scene_(scene) {}

  const Scene& scene() const { return scene_; }

  // What Validate says of the scene. It is asked once.
  Status Check();

  // The scene as `camera` sees it; both are sound. Fails with kScene where it has too many
  // primitives. Any number of threads may call it: two that find nothing both make it.
  template <typename Real>
  Result<std::shared_ptr<const PreparedScene<Real>>> Prepare(const Camera& camera,
                                                             Integrator integrator, Skips skips,
                                                             int threads);

 private:
  template <typename Real>
  using Kept = std::shared_ptr<const PreparedScene<Real>>;

  const Scene& scene_;
  std::mutex mutex_;
  bool is_sound_ = false;
  std::tuple<Kept<float>, Kept<double>> kept_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_PREPARE_SCENE_H_
