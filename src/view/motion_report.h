// How well pictures in motion kept up.
#ifndef SHEAF_VIEW_MOTION_REPORT_H_
#define SHEAF_VIEW_MOTION_REPORT_H_

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "src/view/view_frame.h"

namespace sheaf {

class MotionReport {
 public:
  // A new picture that the window shows, at this time, where the camera moves.
  void Add(const ViewPicture& picture, double seconds);
  // The motion ended: what comes next is no interval.
  void Pause() { has_last_ = false; }

  // Pictures over the last second of motion.
  double RecentRate(double now) const;

  // One line: pictures a second, their median size, the longest interval. Empty: nothing moved.
  std::string Text() const;

 private:
  std::deque<double> recent_;
  std::vector<double> intervals_;
  std::vector<std::pair<int, int>> sizes_;
  bool has_last_ = false;
  double last_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_MOTION_REPORT_H_
