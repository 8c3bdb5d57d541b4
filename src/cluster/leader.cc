#include "src/cluster/leader.h"

#include <chrono>

#include "src/cluster/lead_frame.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

// For the last words of a rank, which stops within a pixel or so.
constexpr std::chrono::seconds kPatienceAtTheEnd{5};

}  // namespace

Leader::~Leader() {
  if (!has_stopped_) Stop();
}

Status Leader::RenderRows(const Scene& scene, const Camera& camera, const FrameOrder& order,
                          const RenderOptions& options, const RowSink& sink, KeptAreas* kept,
                          RenderStats* stats, RenderProgress* progress) {
  FrameLead lead(scene, camera, options, sink, kept, ranks_, *progress);
  const Status status = lead.Run(order);
  *stats = lead.Total();
  records_ = lead.records();
  return status;
}

void Leader::Stop() {
  has_stopped_ = true;
  for (int rank = 1; rank < ranks_.count(); ++rank) ranks_.Send(rank, kStopMessage, "");
  const Clock::time_point end = Clock::now() + kPatienceAtTheEnd;
  int awaited = ranks_.count() - 1;
  Patience patience;
  while (awaited > 0 && Clock::now() < end) {
    RankMessage message;
    if (!ranks_.Receive(&message)) {
      patience.Rest();
      continue;
    }
    patience.Reset();
    awaited -= message.kind == kByeMessage;
  }
  // One that is gone would be waited for. Who started the ranks ends those that are left.
  if (awaited == 0) ranks_.Leave();
}

}  // namespace sheaf
