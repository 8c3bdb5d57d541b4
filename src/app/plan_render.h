// What `sheaf render` does before the first ray: reads, chooses, and refuses what cannot be done.
#ifndef SHEAF_APP_PLAN_RENDER_H_
#define SHEAF_APP_PLAN_RENDER_H_

#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "src/app/frame_writer.h"
#include "src/app/open_scene.h"
#include "src/app/progress.h"
#include "src/app/render_request.h"

namespace sheaf {

struct RenderPlan {
  RenderRequest request;  // with what follows from the command line filled in
  ProgressStyle style = ProgressStyle::kNone;
  OpenedScene opened;  // at the first frame
  RenderOptions options;
  std::vector<Frame> frames;  // their cameras are those of `opened`
};

// Reads the scene and plans its pictures; warnings go to stderr. Fails where anything is known that
// speaks against the work.
Result<RenderPlan> PlanRender(const RenderRequest& given);

// The same for a process that renders areas of another's pictures: no frames, and no warnings,
// which that one gives.
Result<RenderPlan> PlanFollowing(const RenderRequest& given);

}  // namespace sheaf

#endif  // SHEAF_APP_PLAN_RENDER_H_
