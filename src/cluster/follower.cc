#include "src/cluster/follower.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>

#include "src/cluster/area_worker.h"
#include "src/cluster/wire.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

// After `stop`: rank 0 gets the signal too, and has something to say.
constexpr std::chrono::seconds kPatienceAtTheEnd{5};

class FrameFollower {
 public:
  FrameFollower(Ranks& ranks, const OpenFrame& open) : ranks_(ranks), open_(open) {}

  // False: rank 0 has ended the work.
  bool Take(const RankMessage& message) {
    switch (message.kind) {
      case kFrameMessage:
        Begin(WireReader(message.bytes).Get<FrameOrder>());
        break;
      case kAreaMessage:
        if (worker_) worker_->Give(WireReader(message.bytes).Get<PixelRect>());
        break;
      case kEndMessage:
        if (worker_) worker_->End();
        break;
      case kStopMessage:
        return false;
      default:
        break;
    }
    return true;
  }

  // Whether something happened.
  bool Work() {
    if (!worker_) return false;
    if (!is_welcome_ && worker_->is_ready()) {
      is_welcome_ = true;
      ranks_.Send(0, kReadyMessage, Pack(RankInfoOf(frame_.options)));
      return true;
    }
    if (const std::optional<FinishedArea> area = worker_->Take()) {
      ranks_.Send(0, kRowsMessage, Pack(*area));
      return true;
    }
    if (!worker_->is_done()) return false;
    const Status status = worker_->Join();
    if (!status) {
      Fail(status.error());
    } else {
      ranks_.Send(0, kStatsMessage, Pack(worker_->stats()));
    }
    worker_.reset();
    return true;
  }

  void Fail(const Error& error) {
    Send({error.kind, fmt::format("rank {} ({}): {}", ranks_.rank(), HostName(), error.message)});
  }
  void Send(const RankError& error) {
    worker_.reset();
    has_failed_ = true;
    ranks_.Send(0, kErrorMessage, Pack(error));
  }
  void Stop() { worker_.reset(); }

 private:
  void Begin(const FrameOrder& order) {
    if (has_failed_) return;
    Result<FollowedFrame> frame = open_(order);
    if (!frame) return Fail(frame.error());
    frame_ = std::move(frame).value();
    is_welcome_ = false;
    worker_ = std::make_unique<AreaWorker>(*frame_.scene, *frame_.camera, frame_.options);
  }

  Ranks& ranks_;
  const OpenFrame& open_;
  FollowedFrame frame_;
  std::unique_ptr<AreaWorker> worker_;
  bool is_welcome_ = false, has_failed_ = false;
};

bool RunFollower(FrameFollower& follower, Ranks& ranks, const std::function<bool()>& stop) {
  std::optional<Clock::time_point> end;
  Patience patience;
  for (;;) {
    if (!end && stop()) {
      follower.Stop();
      end = Clock::now() + kPatienceAtTheEnd;
    }
    if (end && Clock::now() > *end) return false;
    RankMessage message;
    const bool has_message = ranks.Receive(&message);
    bool has_worked = false;
    try {
      if (has_message && !follower.Take(message)) break;
      has_worked = !end && follower.Work();
    } catch (const std::bad_alloc&) {
      follower.Send({std::nullopt, ""});
    }
    if (has_message || has_worked) {
      patience.Reset();
    } else {
      patience.Rest();
    }
  }
  follower.Stop();
  SayGoodbye(ranks);
  return true;
}

}  // namespace

void SayGoodbye(Ranks& ranks) {
  ranks.Send(0, kByeMessage, "");
  ranks.Leave();
}

bool Follow(Ranks& ranks, const std::vector<RankMessage>& early, const OpenFrame& open,
            const std::function<bool()>& stop) {
  FrameFollower follower(ranks, open);
  for (const RankMessage& message : early) follower.Take(message);
  return RunFollower(follower, ranks, stop);
}

bool FollowWithError(Ranks& ranks, const RankError& error, const std::function<bool()>& stop) {
  const OpenFrame none;
  FrameFollower follower(ranks, none);
  follower.Send(error);
  return RunFollower(follower, ranks, stop);
}

}  // namespace sheaf
