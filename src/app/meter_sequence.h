// One exposure for all pictures of a sequence: metered anew at each frame, it would flicker.
#ifndef SHEAF_APP_METER_SEQUENCE_H_
#define SHEAF_APP_METER_SEQUENCE_H_

#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/frame_writer.h"
#include "src/app/render_request.h"

namespace sheaf {

// Where it is metered. Not the first frame of the run: parts of a sequence that are rendered apart
// fit together.
inline constexpr int kMeteredFrame = 0;

// Whether they are the frames of a sequence whose exposure is metered.
bool IsMeteredOnce(const RenderRequest& request, const Scene& scene,
                   const std::vector<Frame>& frames);

// Gives each frame the look of kMeteredFrame, at which the renderer's scene is, by its camera.
Status MeterSequence(const RenderRequest& request, const RenderOptions& options,
                     const Renderer& renderer, std::vector<Frame>* frames);

}  // namespace sheaf

#endif  // SHEAF_APP_METER_SEQUENCE_H_
