// What one thread's phases took: time, and how full the kernels' vectors were.
#ifndef SHEAF_RENDER_PHASE_CLOCK_H_
#define SHEAF_RENDER_PHASE_CLOCK_H_

#include <chrono>
#include <cstdint>

#include "sheaf/render.h"
#include "sheaf/stats.h"

namespace sheaf {

class PhaseClock {
 public:
  // Kernels run `lanes` >= 1 elements at a time.
  PhaseClock(Timing timing, std::uint32_t lanes) : timing_(timing), lanes_(lanes) {}

  // What came before belongs to no phase.
  void Start() {
    if (timing_ == Timing::kOn) last_ = Clock::now();
  }

  // Everything since the last call counts for `phase`.
  void Charge(Phase phase) {
    if (timing_ == Timing::kOff) return;
    const Clock::time_point now = Clock::now();
    seconds_[static_cast<int>(phase)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

  // The same for a kernel that took `count` elements, whole vectors of them, of which `live`
  // mattered.
  void Charge(Phase phase, std::uint32_t live, std::uint32_t count) {
    LaneUse& use = lane_use_[static_cast<int>(phase)];
    ++use.batches;
    use.live += live;
    use.lanes += (count + lanes_ - 1) / lanes_ * lanes_;
    Charge(phase);
  }

  double seconds(Phase phase) const { return seconds_[static_cast<int>(phase)]; }
  const LaneUse& lane_use(Phase phase) const { return lane_use_[static_cast<int>(phase)]; }
  LaneUse all_lane_use() const {
    LaneUse sum;
    for (const LaneUse& use : lane_use_) sum += use;
    return sum;
  }

 private:
  using Clock = std::chrono::steady_clock;

  Timing timing_;
  std::uint32_t lanes_;
  Clock::time_point last_;
  double seconds_[static_cast<int>(Phase::kCount)] = {};
  LaneUse lane_use_[static_cast<int>(Phase::kCount)] = {};
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_PHASE_CLOCK_H_
