// `sheaf render` on the ranks that follow.
#ifndef SHEAF_APP_FOLLOW_RENDER_H_
#define SHEAF_APP_FOLLOW_RENDER_H_

#include "src/app/exit_code.h"
#include "src/app/render_request.h"
#include "src/cluster/ranks.h"

namespace sheaf {

// Renders areas of what rank 0 renders until that ends the work. Says nothing: rank 0 does.
ExitCode FollowRender(const RenderRequest& request, Ranks& ranks);

}  // namespace sheaf

#endif  // SHEAF_APP_FOLLOW_RENDER_H_
