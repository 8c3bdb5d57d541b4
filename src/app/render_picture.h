// One picture of `sheaf render`: rendered, shown as it comes along, written.
#ifndef SHEAF_APP_RENDER_PICTURE_H_
#define SHEAF_APP_RENDER_PICTURE_H_

#include <cstdint>
#include <optional>
#include <string>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/frame_writer.h"
#include "src/app/progress.h"
#include "src/app/render_request.h"
#include "src/app/statistics_json.h"
#include "src/cluster/leader.h"

namespace sheaf {

// With a leader all of its ranks render, else this process alone. With an identity of the run,
// finished bands go to a journal beside the picture, and those that an earlier run left there are
// taken from it. The journal stays: RemoveJournal.
Result<FrameRecord> RenderPicture(const RenderRequest& request, const Renderer& renderer,
                                  Frame frame, const RenderOptions& options, ProgressStyle style,
                                  const std::string& label, std::optional<std::uint64_t> identity,
                                  Leader* leader);

// Says, unless the run is quiet, that this journal is of other work and is not gone on with.
void WarnOfOtherWork(const RenderRequest& request, const std::string& journal);

}  // namespace sheaf

#endif  // SHEAF_APP_RENDER_PICTURE_H_
