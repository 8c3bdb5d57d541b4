// Rank 0: hands out the areas of a picture, gathers its rows, and ends the work.
#ifndef SHEAF_CLUSTER_LEADER_H_
#define SHEAF_CLUSTER_LEADER_H_

#include <vector>

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/cluster/kept_areas.h"
#include "src/cluster/messages.h"
#include "src/cluster/ranks.h"

namespace sheaf {

// What a rank did for a picture.
struct RankRecord {
  RankInfo info;
  RenderStats stats;
  double idle = 0;  // the share of the picture's time in which it neither compiled nor rendered
};

class Leader {
 public:
  // `ranks` outlives it.
  explicit Leader(Ranks& ranks) : ranks_(ranks) {}
  Leader(const Leader&) = delete;
  Leader& operator=(const Leader&) = delete;
  ~Leader();  // Stop, if nobody has called it

  // As sheaf::RenderRows, on all ranks; LimitsFor says what is held of the picture. `order` tells
  // the others what `scene` and `camera` are. An error of a rank is that of the picture and names
  // the rank; where its memory has run out std::bad_alloc is thrown. With `kept`, which may be
  // null, areas of earlier runs are not rendered again, and those of this one are kept as they
  // come.
  Status RenderRows(const Scene& scene, const Camera& camera, const FrameOrder& order,
                    const RenderOptions& options, const RowSink& sink, KeptAreas* kept,
                    RenderStats* stats, RenderProgress* progress);

  // Of the last picture, by rank.
  const std::vector<RankRecord>& records() const { return records_; }

  // Tells all ranks that the work is over, and leaves together with them, if they answer in time.
  void Stop();

 private:
  Ranks& ranks_;
  std::vector<RankRecord> records_;
  bool has_stopped_ = false;
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_LEADER_H_
