#include "src/view/motion_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace sheaf {

void MotionReport::Add(const ViewPicture& picture, double seconds) {
  recent_.push_back(seconds);
  while (recent_.front() < seconds - 1) recent_.pop_front();
  if (has_last_) {
    intervals_.push_back(seconds - last_);
    sizes_.emplace_back(picture.width, picture.height);
  }
  has_last_ = true;
  last_ = seconds;
}

double MotionReport::RecentRate(double now) const {
  const auto is_recent = [now](double at) { return at >= now - 1; };
  return static_cast<double>(std::count_if(recent_.begin(), recent_.end(), is_recent));
}

std::string MotionReport::Text() const {
  if (intervals_.empty()) return "";
  const double seconds = std::accumulate(intervals_.begin(), intervals_.end(), 0.0);
  std::vector<std::pair<int, int>> sizes = sizes_;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return fmt::format(
      "in motion: {} pictures in {:.2f} s, {:.1f} a second, median {}x{}, longest interval {:.0f} "
      "ms",
      intervals_.size(), seconds, static_cast<double>(intervals_.size()) / seconds, middle->first,
      middle->second, 1e3 * *std::max_element(intervals_.begin(), intervals_.end()));
}

}  // namespace sheaf
