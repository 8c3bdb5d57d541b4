// What a frame that is rendered in rounds keeps from one to the next.
#ifndef SHEAF_RENDER_SAMPLE_ROUND_H_
#define SHEAF_RENDER_SAMPLE_ROUND_H_

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <variant>
#include <vector>

#include "sheaf/film.h"
#include "sheaf/render.h"
#include "src/scalar/converge.h"

namespace sheaf {

// The samples of each pixel of an area, added up in the frame's arithmetic.
class SampleSums {
 public:
  SampleSums(const PixelRect& area, Precision precision);

  // Of a pixel of the picture that lies in the area. Threads may write different ones at once.
  template <typename Real>
  scalar::PixelSums<Real>& at(int x, int y) {
    return std::get<Pixels<Real>>(pixels_)[index(x, y)];
  }

  // Their means, as colours of a film of the area.
  void WriteMeans(Film& film) const;

  // Of all pixels.
  std::uint64_t samples() const;

 private:
  template <typename Real>
  using Pixels = std::vector<scalar::PixelSums<Real>>;

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - area_.y0) * static_cast<std::size_t>(area_.width()) +
           static_cast<std::size_t>(x - area_.x0);
  }

  const PixelRect area_;
  std::variant<Pixels<float>, Pixels<double>> pixels_;
};

// How much of a frame's time is used; from 1 on: all of it. Any thread may ask.
using TimeUsed = std::function<double()>;

// One round: each pixel gets samples until its error is at most `goal`.
class SampleRound {
 public:
  enum class Kind { kFirst, kLater };

  // The first round is never cut, so that there is a picture.
  SampleRound(Kind kind, double goal, const TimeUsed& used, SampleSums& sums)
      : kind_(kind), goal_(goal), used_(used), sums_(sums) {}

  bool is_first() const { return kind_ == Kind::kFirst; }
  double goal() const { return goal_; }
  SampleSums& sums() const { return sums_; }

  // Asked before further work: whether it has to be left, as there is no time.
  bool Cut() {
    if (!is_first() && !is_cut() && used_() >= 1) is_cut_.store(true, std::memory_order_relaxed);
    return is_cut();
  }
  // Whether any work was left.
  bool is_cut() const { return is_cut_.load(std::memory_order_relaxed); }

 private:
  const Kind kind_;
  const double goal_;
  const TimeUsed& used_;
  SampleSums& sums_;
  std::atomic<bool> is_cut_{false};
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_SAMPLE_ROUND_H_
