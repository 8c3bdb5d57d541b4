// A picture by many ranks, simulated: what limits it where no such cluster is at hand.
//
// Real are the plan of areas and the limits on areas and memory (src/cluster). Assumed:
// - rank 0's link carries one message at a time, each way; all other links are free;
// - rank 0 takes in a message at a time, and writes rows at a time, beside each other and beside
//   its rendering; neither is slowed by the other;
// - an area takes the time of its tiles over the threads, or that of its longest tile;
// - all machines are alike, none fails, none has other work.
#ifndef SHEAF_BENCH_SIMULATE_RANKS_H_
#define SHEAF_BENCH_SIMULATE_RANKS_H_

#include <cstdint>
#include <functional>

#include "sheaf/film.h"

namespace sheaf::bench {

struct ClusterModel {
  int ranks = 1, threads = 1;  // threads of a rank
  PixelRect picture;
  int tile_size = 32;
  int share = 16;  // AreaPlan's
  double pixel_bytes = 12;
  double scene_bytes = 0, piece_bytes = 1 << 20;
  // Seconds.
  double compile = 0;                        // of a rank, before its first area
  double latency = 0;                        // of a message
  double message = 0;                        // of rank 0's work on a message
  double take_byte = 0;                      // of rank 0's work on a byte of rows
  double write_byte = 0;                     // of writing one
  double link_byte = 0;                      // on a link
  std::function<double(int x, int y)> tile;  // of the tile at this pixel, one thread
};

struct ClusterTimes {
  double broadcast = 0;     // until the last rank has the scene
  double total = 0;         // until the last row is written
  double ideal = 0;         // tiles over all threads
  double slowest_area = 0;  // the longest of all areas
  double link_busy = 0;     // of rank 0's link, in rows
  double lead_busy = 0;     // of rank 0's work on messages
  double write_busy = 0;
  double idle = 0;  // share of the ranks' time from their first to the end of the last area
  std::int64_t areas = 0;
  double most_rows_held = 0;  // bytes
};

ClusterTimes SimulateRanks(const ClusterModel& model);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_SIMULATE_RANKS_H_
