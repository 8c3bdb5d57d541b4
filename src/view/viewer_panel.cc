// What the viewer tells the window: title, picture and the lines of the panel.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "src/formats/printable.h"
#include "src/view/viewer.h"

namespace sheaf {
namespace {

std::vector<std::string> HelpLines() {
  std::vector<std::string> lines;
  for (const Motion& motion : Motions())
    lines.push_back(fmt::format("{:12}{}", motion.name, motion.help));
  for (const Key& key : Keys()) lines.push_back(fmt::format("{:12}{}", key.name, key.help));
  return lines;
}

std::string SideText(const SideStats& side) {
  const double seconds = side.seconds + side.compile_seconds;
  return fmt::format("{}: {:.1f} ms, {:.2f} Mrays/s", side.target, 1e3 * seconds,
                     seconds > 0 ? 1e-6 * static_cast<double>(side.rays) / seconds : 0.0);
}

}  // namespace

std::string Viewer::Title() const {
  std::string title = fmt::format("{} - {}{} -", PrintablePath(setup_.scene_path),
                                  Printable(rig_.camera().name), is_moved_ ? ", moved" : "");
  if (!picture_ || !submitted_) return title;
  const FrameGoal& goal = submitted_->goal;
  const FrameJob& job = picture_->job;
  if (job.width == goal.width && job.height == goal.height) {
    title += fmt::format(" {}x{}, ", goal.width, goal.height);
    title += picture_->is_finished
                 ? fmt::format("{} sample{}", job.samples, job.samples == 1 ? "" : "s")
                 : fmt::format("{} of {} samples", job.samples, goal.samples);
  } else {
    title += fmt::format(" {}x{} of {}x{}", job.width, job.height, goal.width, goal.height);
  }
  return title;
}

std::vector<std::string> Viewer::StatusLines() const {
  std::vector<std::string> lines;
  if (!picture_ || !submitted_) return {"rendering the first picture"};
  const FrameGoal& goal = submitted_->goal;
  const FrameJob& job = picture_->job;
  lines.push_back(fmt::format("{}x{} of {}x{}, {} of {} samples{}", job.width, job.height,
                              goal.width, goal.height, job.samples, goal.samples,
                              picture_->is_finished ? ", done" : ""));
  lines.push_back(fmt::format("frame {:.1f} ms", 1e3 * picture_->seconds));
  const double rate = motion_.RecentRate(last_seconds_);
  if (rate > 0) lines.back() += fmt::format(", in motion {:.0f} a second", rate);
  const char* const places[] = {"left ", "right "};
  for (std::size_t i = 0; i < picture_->sides.size(); ++i) {
    lines.push_back((picture_->sides.size() > 1 ? places[i] : "") + SideText(picture_->sides[i]));
  }
  const Camera& camera = rig_.camera();
  lines.push_back(
      fmt::format("eye {:.5g}, {:.5g}, {:.5g}", camera.eye.x, camera.eye.y, camera.eye.z));
  lines.push_back(fmt::format("look at {:.5g}, {:.5g}, {:.5g}", camera.look_at.x, camera.look_at.y,
                              camera.look_at.z));
  return lines;
}

void Viewer::Fill(const WindowInput& input, WindowFrame* frame) {
  const std::shared_ptr<const ViewPicture> latest = loop_->Latest();
  if (latest && latest != picture_) {
    const bool moves = spin_start_ || is_flying_ || latest->job.is_draft;
    // The first picture of all is of a camera that stands.
    if (moves && picture_) {
      motion_.Add(*latest, input.seconds);
    } else {
      motion_.Pause();
    }
    picture_ = latest;
  }
  static const std::vector<std::string> help = HelpLines();
  if (picture_) {
    frame->rgb = picture_->rgb.data();
    frame->picture_width = picture_->width;
    frame->picture_height = picture_->height;
    frame->picture_number = picture_->number;
  }
  frame->title = Title();
  frame->is_panel_shown = is_panel_shown_;
  frame->controls = &controls_;
  frame->lists = &lists_;
  frame->status = StatusLines();
  frame->pick = pick_;
  frame->help = help;
  frame->message = message_;
  const std::string render_error = loop_->error();
  frame->error = load_error_.empty() ? render_error : load_error_;
  frame->is_moving = spin_start_ || is_flying_ || (setup_.spin_seconds > 0);
  frame->closes = closes_;
}

}  // namespace sheaf
