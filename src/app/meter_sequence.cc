#include "src/app/meter_sequence.h"

#include <cstddef>
#include <map>

#include "src/app/choose_look.h"
#include "src/formats/picture.h"

namespace sheaf {

bool IsMeteredOnce(const RenderRequest& request, const Scene& scene,
                   const std::vector<Frame>& frames) {
  const Frame& first = frames.front();
  return first.number && IsMetered(request.look, scene.settings) &&
         !HoldsFloats(FormatPath(first.path, first.format));
}

Status MeterSequence(const RenderRequest& request, const RenderOptions& options,
                     const Renderer& renderer, std::vector<Frame>* frames) {
  std::map<std::size_t, Look> looks;  // by camera
  for (Frame& frame : *frames) {
    const auto [place, is_new] = looks.try_emplace(frame.camera_index);
    if (is_new) {
      const Camera& camera = renderer.scene().cameras[frame.camera_index];
      const Result<Look> look = ChooseLook(request.look, renderer, camera, options);
      if (!look) return look.error();
      place->second = look.value();
    }
    frame.look = place->second;
  }
  return Done{};
}

}  // namespace sheaf
