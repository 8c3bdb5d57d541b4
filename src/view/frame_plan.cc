#include "src/view/frame_plan.h"

#include <algorithm>
#include <cmath>

namespace sheaf {
namespace {

// How long nothing has to change before the picture is at rest.
constexpr double kRestSeconds = 0.12;
// A finer draft has to fit with room to spare, so that the size does not swing.
constexpr double kRoom = 0.92;

std::vector<int> LevelsUpTo(int samples) {
  std::vector<int> levels;
  for (int n = 1; n < samples; n *= 4) levels.push_back(n);
  levels.push_back(samples);
  return levels;
}

}  // namespace

void FramePlan::SetGoal(const FrameGoal& goal, double now) {
  if (goal == goal_) return;
  goal_ = goal;
  levels_ = LevelsUpTo(goal.samples);
  ChooseRung();
  Restart(now);
}

void FramePlan::Restart(double now) {
  restarted_ = now;
  is_drafted_ = false;
  level_ = 0;
}

FrameJob FramePlan::Draft(int rung) const {
  const double scale = std::exp2(-0.125 * rung);
  const auto side = [scale](int pixels) {
    return std::max(1, static_cast<int>(std::lround(pixels * scale)));
  };
  return {side(goal_.width), side(goal_.height), 1, true};
}

std::optional<FrameJob> FramePlan::Next(double now) const {
  if (!is_drafted_) return Draft(rung_);
  if (is_finished() || Wait(now) > 0) return std::nullopt;
  return FrameJob{goal_.width, goal_.height, levels_[level_], false};
}

double FramePlan::Wait(double now) const {
  if (!is_drafted_ || is_finished()) return 0;
  return std::max(0.0, restarted_ + kRestSeconds - now);
}

double FramePlan::PixelSeconds(int rung) const {
  const FrameJob draft = Draft(rung);
  return seconds_a_pixel_.value_or(0) * draft.width * draft.height;
}

void FramePlan::ChooseRung() {
  if (!seconds_a_pixel_) return;
  // Where the tree alone takes the time of a frame, a picture of no pixels would not help.
  const double budget = std::max(budget_ - fixed_, 0.25 * budget_);
  while (rung_ < kMostRung && PixelSeconds(rung_) > budget) ++rung_;
  while (rung_ > 0 && PixelSeconds(rung_ - 1) <= kRoom * budget) --rung_;
}

void FramePlan::Finish(const FrameJob& job, double seconds, double fixed) {
  const bool is_whole = job.width == goal_.width && job.height == goal_.height;
  if (job.is_draft) is_drafted_ = true;
  if (is_whole && !is_finished() && job.samples == levels_[level_]) ++level_;
  if (job.samples != 1) return;  // says nothing of drafts
  const double pixels = static_cast<double>(job.width) * job.height;
  const double measured = std::max(seconds - fixed, 1e-9) / pixels;
  // Half of the old: one frame that another process delayed does not count for much.
  fixed_ = seconds_a_pixel_ ? 0.5 * (fixed_ + fixed) : fixed;
  seconds_a_pixel_ = seconds_a_pixel_ ? 0.5 * (*seconds_a_pixel_ + measured) : measured;
  ChooseRung();
}

void FramePlan::GiveUp(double seconds, double pixels) {
  seconds_a_pixel_ = std::max(seconds, 1e-9) / std::max(pixels, 1.0);
  ChooseRung();
}

}  // namespace sheaf
