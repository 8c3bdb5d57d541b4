// The other ranks: render what rank 0 says.
#ifndef SHEAF_CLUSTER_FOLLOWER_H_
#define SHEAF_CLUSTER_FOLLOWER_H_

#include <functional>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/cluster/messages.h"
#include "src/cluster/ranks.h"

namespace sheaf {

// What a frame is to a rank. The pointers are good until the next frame.
struct FollowedFrame {
  const Scene* scene = nullptr;
  const Camera* camera = nullptr;
  RenderOptions options;
};
using OpenFrame = std::function<Result<FollowedFrame>(const FrameOrder& order)>;

// Takes the messages that came `early`, and renders areas until rank 0 says that the work is over;
// errors go to rank 0. Asks `stop` meanwhile, and then waits a while for rank 0. Whether rank 0 has
// ended it.
bool Follow(Ranks& ranks, const std::vector<RankMessage>& early, const OpenFrame& open,
            const std::function<bool()>& stop);

// The same for a rank that has failed before there was a frame.
bool FollowWithError(Ranks& ranks, const RankError& error, const std::function<bool()>& stop);

// The last words of a rank that rank 0 has stopped.
void SayGoodbye(Ranks& ranks);

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_FOLLOWER_H_
