#include "src/app/follow_render.h"

#include <fmt/format.h>

#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "src/app/choose.h"
#include "src/app/interrupt.h"
#include "src/app/plan_frames.h"
#include "src/app/plan_render.h"
#include "src/cluster/follower.h"
#include "src/cluster/share_files.h"

namespace sheaf {
namespace {

class RenderFollower {
 public:
  // Opens the scene from the bytes that rank 0 has read.
  Status Open(const RenderRequest& request, SharedWork work) {
    if (work.options != request.work) {
      return Usage("was given other options than rank 0; only --target and --threads may differ");
    }
    ReadOnlyHeldFiles(std::move(work.files));
    Result<RenderPlan> planned = PlanFollowing(request);
    if (!planned) return planned.error();
    plan_ = std::move(planned).value();
    return Done{};
  }

  Result<FollowedFrame> Frame(const FrameOrder& order) {
    const RenderRequest& request = plan_.request;
    if (order.has_number && order.number != posed_) {
      const Status moved =
          PoseScene(request.scene, OptionsAt(request, order.number), &plan_.opened);
      if (!moved) return moved.error();
      posed_ = order.number;
    }
    const Scene& scene = plan_.opened.scene;
    FollowedFrame frame{&scene, &scene.cameras.at(static_cast<std::size_t>(order.camera_index)),
                        plan_.options};
    frame.options.layers = order.layers;
    return frame;
  }

 private:
  RenderPlan plan_;
  std::optional<int> posed_;
};

bool ReceiveAndFollow(const RenderRequest& request, Ranks& ranks) {
  const auto is_interrupted = [] { return PendingSignal() != 0; };
  std::optional<SharedWork> work = ReceiveWork(ranks, is_interrupted);
  if (!work && !is_interrupted()) {
    SayGoodbye(ranks);
    return true;
  }
  if (!work) return FollowWithError(ranks, {}, is_interrupted);
  const std::vector<RankMessage> early = std::move(work->early);
  RenderFollower follower;
  RankError error;
  try {
    const Status opened = follower.Open(request, std::move(*work));
    if (opened) {
      const OpenFrame open = [&](const FrameOrder& order) { return follower.Frame(order); };
      return Follow(ranks, early, open, is_interrupted);
    }
    error = {opened.error().kind,
             fmt::format("rank {} ({}): {}", ranks.rank(), HostName(), opened.error().message)};
  } catch (const std::bad_alloc&) {
  }
  return FollowWithError(ranks, error, is_interrupted);
}

}  // namespace

ExitCode FollowRender(const RenderRequest& request, Ranks& ranks) {
  CatchInterrupts();
  return ReceiveAndFollow(request, ranks) ? ExitCode::kOk : ExitCodeOf(ErrorKind::kInterrupted);
}

}  // namespace sheaf
