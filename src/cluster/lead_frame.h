// One picture as rank 0 leads it.
#ifndef SHEAF_CLUSTER_LEAD_FRAME_H_
#define SHEAF_CLUSTER_LEAD_FRAME_H_

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/cluster/area_plan.h"
#include "src/cluster/area_worker.h"
#include "src/cluster/kept_areas.h"
#include "src/cluster/leader.h"
#include "src/cluster/messages.h"
#include "src/cluster/ranks.h"
#include "src/cluster/strips.h"

namespace sheaf {

// Areas that a rank has at a time: one in work, one to go on with.
inline constexpr int kAreasAtOnce = 2;

// How much is under way at a time, in bytes of pixels.
struct LeadLimits {
  std::int64_t window;  // rendered or handed out, and not written: some wait for slower rows above
  std::int64_t area;    // of one area: a message takes few milliseconds
};

// For so many ranks with so many threads each: 256 MiB, and what small areas for all of them are up
// to 2 GiB.
LeadLimits LimitsFor(int ranks, int threads, double tile_bytes);

class FrameLead {
 public:
  // `options` are checked; `kept` may be null. All arguments outlive it.
  FrameLead(const Scene& scene, const Camera& camera, const RenderOptions& options,
            const RowSink& sink, KeptAreas* kept, Ranks& ranks, RenderProgress& progress);
  FrameLead(const FrameLead&) = delete;
  FrameLead& operator=(const FrameLead&) = delete;
  ~FrameLead();

  Status Run(const FrameOrder& order);

  // Of all ranks together.
  RenderStats Total() const;
  const std::vector<RankRecord>& records() const { return records_; }

 private:
  // Each returns whether something happened.
  bool TakeMessage();
  bool TakeOwn();
  bool HandOut();
  bool Write();

  void Welcome(int rank, RankInfo info);
  void Finish(int rank, FinishedArea area);
  void AddEarlier();
  void FinishRank(int rank, RenderStats stats);
  void Fail(Error error);
  bool IsDone() const;

  const RenderOptions& options_;
  const RowSink& sink_;
  KeptAreas* const kept_;
  std::size_t next_earlier_ = 0;  // of what is kept
  Ranks& ranks_;
  RenderProgress& progress_;
  const LeadLimits limits_;  // in pixels
  AreaPlan plan_;
  Strips strips_;
  std::int64_t out_pixels_ = 0;  // handed out and not written
  std::deque<int> hungry_;       // ranks that can take an area more, each as often as that
  std::vector<bool> has_ended_;  // by rank: no more areas
  std::vector<RankRecord> records_;
  int running_;  // ranks that are not through
  bool is_own_done_ = false;
  std::optional<Error> error_;
  const std::chrono::steady_clock::time_point start_;
  Film written_;
  std::future<Status> writing_;
  AreaWorker own_;  // last: it starts when everything else is there
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_LEAD_FRAME_H_
