// Cuts a picture into areas for whoever asks next: large ones first, small ones at the end.
#ifndef SHEAF_CLUSTER_AREA_PLAN_H_
#define SHEAF_CLUSTER_AREA_PLAN_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "sheaf/film.h"

namespace sheaf {

// An area is 1 / kAreaShare of a rank's part of what is left: even where its pixels take many times
// as long as others it ends before the rest does, and few rows wait for it. A message costs little
// (bench/cluster_model.cc).
inline constexpr int kAreaShare = 64;

// A thread of the rank shall have so many tiles of an area.
inline constexpr int kTilesPerThread = 4;

// Guided self-scheduling (Polychronopoulos and Kuck 1987) with a smaller share. Areas are whole
// rows of tiles from the top; where a part of one is enough, a part of one row of tiles.
class AreaPlan {
 public:
  // `pixels` of the picture, for so many ranks. No area has more than `most_pixels`, but one tile.
  AreaPlan(const PixelRect& pixels, int tile_size, int ranks, std::int64_t most_pixels,
           int share = kAreaShare);

  // `area`, of whole tiles, is there already. Before the first Next; each area once.
  void LeaveOut(const PixelRect& area);

  // The next area, for a rank with so many threads; nothing is left: nothing.
  std::optional<PixelRect> Next(int threads);

 private:
  // How many tiles from this one to the end of its row, or to one that is left out.
  std::int64_t RunFrom(std::int64_t tile) const;

  const PixelRect pixels_;
  const int tile_size_, ranks_, columns_, share_;
  const std::int64_t most_tiles_;
  std::int64_t next_ = 0, end_;  // tiles, row by row
  std::int64_t left_;            // tiles to hand out
  std::vector<bool> left_out_;   // by tile; empty: none
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_AREA_PLAN_H_
