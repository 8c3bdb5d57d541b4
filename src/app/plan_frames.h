// Which pictures `sheaf render` makes, where they go, and what speaks against it.
#ifndef SHEAF_APP_PLAN_FRAMES_H_
#define SHEAF_APP_PLAN_FRAMES_H_

#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/app/frame_writer.h"
#include "src/app/open_scene.h"
#include "src/app/render_request.h"

namespace sheaf {

// Finds what is wrong before the scene is read: first the command line, then where to write.
Status CheckCommandLine(const RenderRequest& request);

// The frames of the sequence that is asked for; nothing where it is none.
std::optional<FrameRange> SequenceOf(const RenderRequest& request);

// The options by which a scene is opened, or moved, for a frame of the sequence.
SceneOptions OptionsAt(const RenderRequest& request, int frame);

// All pictures: of a sequence frame by frame, and of each the chosen cameras. Their paths can be
// written, and none of `files` is among them.
Result<std::vector<Frame>> PlanFrames(const RenderRequest& request, const Scene& scene,
                                      const std::vector<std::string>& files);

}  // namespace sheaf

#endif  // SHEAF_APP_PLAN_FRAMES_H_
