#include "src/app/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "src/app/interrupt.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

using Clock = std::chrono::steady_clock;

// In one write, so that lines of several processes do not mix.
void PrintError(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::string Duration(double seconds) {
  const auto whole = std::llround(seconds);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

// Pixels a second so far, and the time that the rest takes at that rate.
struct Pace {
  double share, rate, seconds_left;
};

Pace PaceOf(std::uint64_t done, std::uint64_t total, double seconds) {
  const double share = total == 0 ? 1.0 : std::min(1.0, double(done) / double(total));
  const double rate = seconds > 0.0 ? double(done) / seconds : 0.0;
  return {share, rate, rate > 0.0 ? double(total) * (1.0 - share) / rate : 0.0};
}

std::string Describe(const Pace& pace) {
  if (pace.rate <= 0.0) return fmt::format("{:3.0f} %", 100.0 * pace.share);
  return fmt::format("{:3.0f} %  {:.2f} million pixels/s  {} left", std::floor(100.0 * pace.share),
                     pace.rate * 1e-6, Duration(pace.seconds_left));
}

std::size_t TerminalColumns() {
  winsize size = {};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

}  // namespace

ReadingNotice::ReadingNotice(ProgressStyle style, const std::string& path) : style_(style) {
  if (style_ == ProgressStyle::kBar) PrintError(fmt::format("reading {}", PrintablePath(path)));
}

ReadingNotice::~ReadingNotice() {
  if (style_ == ProgressStyle::kBar) PrintError("\r\x1b[K");
}

ProgressStyle AutomaticProgressStyle() {
  const char* terminal = std::getenv("TERM");
  const bool draws = terminal != nullptr && std::string_view(terminal) != "dumb";
  return draws && isatty(STDERR_FILENO) ? ProgressStyle::kBar : ProgressStyle::kPlain;
}

ProgressStyle ProgressStyleNamed(const std::string& word) {
  if (word == "none") return ProgressStyle::kNone;
  return word == "plain" ? ProgressStyle::kPlain : AutomaticProgressStyle();
}

FrameWatch::FrameWatch(ProgressStyle style, std::string label, const RenderOptions& options,
                       std::uint64_t pixels)
    : style_(style), label_(std::move(label)), pixels_(pixels) {
  if (style_ == ProgressStyle::kPlain) {
    const std::string crop = options.crop
                                 ? fmt::format(", crop {},{},{},{}", options.crop->x0,
                                               options.crop->y0, options.crop->x1, options.crop->y1)
                                 : "";
    const std::string samples = options.budget
                                    ? fmt::format("{:g} s", *options.budget)
                                    : fmt::format("{} {} a pixel", options.samples,
                                                  options.samples == 1 ? "sample" : "samples");
    PrintError(fmt::format("{}: rendering {}x{}, {}{}\n", label_, options.width, options.height,
                           samples, crop));
  }
  thread_ = std::thread([this] { Watch(); });
}

FrameWatch::~FrameWatch() { StopWatching(); }

void FrameWatch::Watch() {
  const Clock::time_point start = Clock::now();
  std::unique_lock lock(mutex_);
  while (!wake_.wait_for(lock, std::chrono::milliseconds(100), [this] { return finished_; })) {
    if (PendingSignal() != 0) progress_.stop.store(true, std::memory_order_relaxed);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (style_ == ProgressStyle::kBar) DrawBar(seconds);
    if (style_ == ProgressStyle::kPlain) PrintLine(seconds);
  }
  if (bar_drawn_) PrintError("\r\x1b[K");
}

void FrameWatch::StopWatching() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void FrameWatch::DrawBar(double seconds) {
  if (progress_.stage.load(std::memory_order_relaxed) == RenderStage::kBuilding) {
    PrintError(fmt::format("\r{}  building the tree  {}\x1b[K", label_, Duration(seconds)));
    bar_drawn_ = true;
    return;
  }
  const Pace pace = PaceOf(progress_.pixels_done.load(std::memory_order_relaxed), pixels_, seconds);
  const std::string text = Describe(pace);
  // The last column stays free: writing there wraps the line on some terminals.
  const std::size_t used = label_.size() + text.size() + 7;
  const std::size_t columns = TerminalColumns();
  std::string bar;
  if (columns > used + 4) {
    const std::size_t room = std::min<std::size_t>(columns - used, 40);
    const auto full = static_cast<std::size_t>(pace.share * static_cast<double>(room));
    bar = fmt::format("[{}{}] ", std::string(full, '='), std::string(room - full, ' '));
  }
  std::string line = fmt::format("{}  {}{}", label_, bar, text);
  if (line.size() >= columns) line.resize(columns - 1);
  PrintError("\r" + line + "\x1b[K");
  bar_drawn_ = true;
}

void FrameWatch::PrintLine(double seconds) {
  const Pace pace = PaceOf(progress_.pixels_done.load(std::memory_order_relaxed), pixels_, seconds);
  const auto tenth = static_cast<std::uint64_t>(10.0 * pace.share);
  if (tenth <= last_line_tenth_ || tenth >= 10 || seconds < last_line_seconds_ + 1.0) return;
  PrintError(fmt::format("{}: {}\n", label_, Describe(pace)));
  last_line_tenth_ = tenth;
  last_line_seconds_ = seconds;
}

void FrameWatch::Finish(const RenderStats& stats) {
  StopWatching();
  if (style_ == ProgressStyle::kNone) return;
  const double seconds = stats.wall_seconds;
  const auto rays = static_cast<double>(stats.rays.traced());
  PrintError(fmt::format("{}: {:.2f} million rays in {:.3f} s, {:.1f} million rays/s, {}, {} {}\n",
                         label_, rays * 1e-6, seconds, seconds > 0.0 ? rays / seconds * 1e-6 : 0.0,
                         stats.target, stats.threads, stats.threads == 1 ? "thread" : "threads"));
  if (stats.reached.rounds == 0) return;
  PrintError(fmt::format("{}: error {:g} reached, {:.1f} samples a pixel\n", label_,
                         stats.reached.error,
                         static_cast<double>(stats.reached.samples) /
                             static_cast<double>(std::max<std::uint64_t>(pixels_, 1))));
}

SequencePace::SequencePace(std::uint64_t pictures) : pictures_(pictures), start_(Clock::now()) {}

std::string SequencePace::Text() const {
  if (pictures_ == 1) return "";
  const std::string place = fmt::format("{}/{}", done_ + 1, pictures_);
  if (done_ == skipped_) return place;
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left =
      seconds / static_cast<double>(done_ - skipped_) * static_cast<double>(pictures_ - done_);
  return fmt::format("{}, {} left", place, Duration(left));
}

StepWatch::StepWatch(ProgressStyle style, std::string label, std::uint64_t steps)
    : style_(style), label_(std::move(label)), steps_(steps), start_(Clock::now()) {}

StepWatch::~StepWatch() { Clear(); }

void StepWatch::Clear() {
  if (style_ == ProgressStyle::kBar && done_ > 0) PrintError("\r\x1b[K");
}

void StepWatch::Advance() {
  ++done_;
  if (style_ == ProgressStyle::kNone) return;
  const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
  const double left =
      seconds * static_cast<double>(steps_ - std::min(done_, steps_)) / static_cast<double>(done_);
  const std::string text =
      fmt::format("{}: {} of {}, {} left", label_, done_, steps_, Duration(left));
  if (style_ == ProgressStyle::kBar) {
    PrintError("\r" + text.substr(0, TerminalColumns() - 1) + "\x1b[K");
    return;
  }
  const std::uint64_t tenth = 10 * done_ / std::max<std::uint64_t>(steps_, 1);
  if (tenth <= last_line_tenth_ || tenth >= 10 || seconds < last_line_seconds_ + 2.0) return;
  PrintError(text + "\n");
  last_line_tenth_ = tenth;
  last_line_seconds_ = seconds;
}

}  // namespace sheaf
