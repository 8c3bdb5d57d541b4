// What to render next, so that a picture in motion keeps up and one at rest gets finer.
//
// Whatever changes the picture calls Restart. Then comes a draft: so few pixels that it is done
// within the time of a frame. Once nothing has changed for a moment come all pixels with one
// sample, then with four times as many each time, up to those that are wanted. A frame with more
// samples starts anew, because its samples lie elsewhere: all of them together cost a third more
// than the last.
#ifndef SHEAF_VIEW_FRAME_PLAN_H_
#define SHEAF_VIEW_FRAME_PLAN_H_

#include <cstddef>
#include <optional>
#include <vector>

namespace sheaf {

// What is wanted in the end.
struct FrameGoal {
  int width = 1, height = 1;  // pixels
  int samples = 1;            // a pixel
  bool operator==(const FrameGoal&) const = default;
};

// One frame. A draft stands for a picture in motion; it may have all pixels.
struct FrameJob {
  int width = 0, height = 0, samples = 1;
  bool is_draft = false;
  bool operator==(const FrameJob&) const = default;
};

class FramePlan {
 public:
  // Of a frame in motion, from its start until it is shown.
  explicit FramePlan(double frame_seconds) : budget_(frame_seconds) {}

  // The clock of all calls is the caller's, in seconds. A new goal is a restart.
  void SetGoal(const FrameGoal& goal, double now);
  void Restart(double now);

  // Nothing where the picture is finished, or while Wait() is above 0.
  std::optional<FrameJob> Next(double now) const;
  // Seconds until there is a next job; 0 where there is one now, or none at all.
  double Wait(double now) const;
  bool is_finished() const { return is_drafted_ && level_ == levels_.size(); }

  // What the job took, of that `fixed` whatever its pixels are.
  void Finish(const FrameJob& job, double seconds, double fixed);
  // A draft that was stopped because it took too long: `pixels` of it were done by then.
  void GiveUp(double seconds, double pixels);

  double budget() const { return budget_; }

 private:
  // Drafts have sides of 2^(-rung/8) of the goal's.
  static constexpr int kMostRung = 56;
  FrameJob Draft(int rung) const;
  double PixelSeconds(int rung) const;  // of a draft, without what is fixed
  void ChooseRung();

  double budget_;
  FrameGoal goal_;
  std::vector<int> levels_ = {1};  // samples of the frames at rest, ascending
  double restarted_ = 0;
  bool is_drafted_ = false;
  std::size_t level_ = 0;  // the next of them
  int rung_ = 24;          // of an eighth, until a frame was timed
  double fixed_ = 0;       // seconds a frame
  std::optional<double> seconds_a_pixel_;
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_FRAME_PLAN_H_
