#include "bench/simulate_ranks.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <deque>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "src/cluster/area_plan.h"
#include "src/cluster/lead_frame.h"

namespace sheaf::bench {
namespace {

enum class EventKind { kReady, kRendered, kWritten };

struct Event {
  double time;
  EventKind kind;
  int rank;
  std::size_t area;
  bool operator>(const Event& other) const { return time > other.time; }
};

class Simulation {
 public:
  explicit Simulation(const ClusterModel& model)
      : model_(model),
        limits_(LimitsFor(model.ranks, model.threads,
                          model.pixel_bytes * model.tile_size * model.tile_size)),
        plan_(model.picture, model.tile_size, model.ranks,
              static_cast<std::int64_t>(static_cast<double>(limits_.area) / model.pixel_bytes),
              model.share),
        free_at_(static_cast<std::size_t>(model.ranks), 0) {}

  ClusterTimes Run() {
    for (int rank = 0; rank < model_.ranks; ++rank) {
      const double scene = SceneAt(rank);
      times_.broadcast = std::max(times_.broadcast, scene);
      events_.push({scene + model_.compile, EventKind::kReady, rank, 0});
    }
    while (!events_.empty()) {
      const Event event = events_.top();
      events_.pop();
      Take(event);
      HandOut(event.time);
    }
    times_.ideal /= model_.threads * static_cast<double>(model_.ranks);
    const double span = last_rendered_ - times_.broadcast - model_.compile;
    if (span > 0) times_.idle = std::clamp(1 - busy_ / (span * model_.ranks), 0.0, 1.0);
    return times_;
  }

 private:
  // The tree of two branches, in pieces: a rank sends each twice.
  double SceneAt(int rank) const {
    const double depth = std::bit_width(static_cast<unsigned>(rank) + 1) - 1;
    if (depth == 0 || model_.scene_bytes == 0) return 0;
    const double piece = 2 * model_.piece_bytes * model_.link_byte;
    return model_.scene_bytes / model_.piece_bytes * piece + depth * (piece + model_.latency);
  }

  double AreaBytes(std::size_t area) const {
    return model_.pixel_bytes * areas_[area].width() * static_cast<double>(areas_[area].height());
  }

  double AreaSeconds(const PixelRect& area) {
    double sum = 0, longest = 0;
    for (int y = area.y0; y < area.y1; y += model_.tile_size) {
      for (int x = area.x0; x < area.x1; x += model_.tile_size) {
        const double seconds = model_.tile(x, y);
        sum += seconds;
        longest = std::max(longest, seconds);
      }
    }
    times_.ideal += sum;
    return std::max(sum / model_.threads, longest);
  }

  void Take(const Event& event) {
    if (event.kind == EventKind::kWritten) {
      out_pixels_ -= PixelsOf(event.area);
      times_.total = std::max(times_.total, event.time);
      return;
    }
    // Rank 0 has no message to itself.
    const bool is_remote = event.rank > 0;
    double now = event.time;
    if (event.kind == EventKind::kRendered) last_rendered_ = std::max(last_rendered_, now);
    if (event.kind == EventKind::kRendered && is_remote) {
      const double link = AreaBytes(event.area) * model_.link_byte;
      link_free_ = std::max(link_free_, now + model_.latency) + link;
      times_.link_busy += link;
      now = link_free_;
    }
    const double bytes = event.kind == EventKind::kRendered ? AreaBytes(event.area) : 0;
    const double work = model_.message + bytes * model_.take_byte;
    lead_free_ = std::max(lead_free_, now) + work;
    times_.lead_busy += work;
    const int areas = event.kind == EventKind::kReady ? kAreasAtOnce : 1;
    for (int i = 0; i < areas; ++i) hungry_.push_back(event.rank);
    if (event.kind == EventKind::kRendered) Gather(event.area);
  }

  // Rows are written from the top.
  void Gather(std::size_t area) {
    is_there_[area] = true;
    held_ += AreaBytes(area);
    times_.most_rows_held = std::max(times_.most_rows_held, held_);
    for (; next_written_ < areas_.size() && is_there_[next_written_]; ++next_written_) {
      const double seconds = AreaBytes(next_written_) * model_.write_byte;
      write_free_ = std::max(write_free_, lead_free_) + seconds;
      times_.write_busy += seconds;
      held_ -= AreaBytes(next_written_);
      events_.push({write_free_, EventKind::kWritten, 0, next_written_});
    }
  }

  std::int64_t PixelsOf(std::size_t area) const {
    return std::int64_t{areas_[area].width()} * areas_[area].height();
  }

  void HandOut(double now) {
    while (!hungry_.empty() && static_cast<double>(out_pixels_) * model_.pixel_bytes <
                                   static_cast<double>(limits_.window)) {
      const int rank = hungry_.front();
      hungry_.pop_front();
      const std::optional<PixelRect> area = plan_.Next(model_.threads);
      if (!area) return;
      areas_.push_back(*area);
      is_there_.push_back(false);
      ++times_.areas;
      out_pixels_ += PixelsOf(areas_.size() - 1);
      const double seconds = AreaSeconds(*area);
      times_.slowest_area = std::max(times_.slowest_area, seconds);
      double& free_at = free_at_[static_cast<std::size_t>(rank)];
      const double sent = std::max(now, lead_free_) + (rank > 0 ? model_.latency : 0);
      free_at = std::max(free_at, sent) + seconds;
      busy_ += seconds;
      events_.push({free_at, EventKind::kRendered, rank, areas_.size() - 1});
    }
  }

  const ClusterModel& model_;
  const LeadLimits limits_;
  AreaPlan plan_;
  ClusterTimes times_;
  std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
  std::deque<int> hungry_;
  std::vector<PixelRect> areas_;
  std::vector<bool> is_there_;
  std::vector<double> free_at_;  // by rank
  double link_free_ = 0, lead_free_ = 0, write_free_ = 0, held_ = 0, busy_ = 0, last_rendered_ = 0;
  std::int64_t out_pixels_ = 0;
  std::size_t next_written_ = 0;
};

}  // namespace

ClusterTimes SimulateRanks(const ClusterModel& model) { return Simulation(model).Run(); }

}  // namespace sheaf::bench
