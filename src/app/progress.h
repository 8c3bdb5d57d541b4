// Tells a person on stderr how a frame comes along, and tells the frame when a person wants it to
// stop.
#ifndef SHEAF_APP_PROGRESS_H_
#define SHEAF_APP_PROGRESS_H_

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "sheaf/render.h"

namespace sheaf {

enum class ProgressStyle {
  kBar,    // one line that is drawn over: a terminal
  kPlain,  // a line at the start, one every tenth (at most one a second), one at the end
  kNone,
};

// The style of a word of --progress: "auto", "plain" or "none".
ProgressStyle ProgressStyleNamed(const std::string& word);

// kBar where stderr is a terminal that can move its cursor, else kPlain.
ProgressStyle AutomaticProgressStyle();

// Says on a terminal that a file is being read, as long as it lives.
class ReadingNotice {
 public:
  ReadingNotice(ProgressStyle style, const std::string& path);
  ReadingNotice(const ReadingNotice&) = delete;
  ReadingNotice& operator=(const ReadingNotice&) = delete;
  ~ReadingNotice();

 private:
  const ProgressStyle style_;
};

// Watches one frame from construction to Finish() or destruction, in a thread that wakes ten times
// a second. It forwards PendingSignal() to the renderer in every style.
class FrameWatch {
 public:
  // `label` names the frame, `pixels` is how many it has.
  FrameWatch(ProgressStyle style, std::string label, const RenderOptions& options,
             std::uint64_t pixels);
  FrameWatch(const FrameWatch&) = delete;
  FrameWatch& operator=(const FrameWatch&) = delete;
  ~FrameWatch();  // of a frame that failed: the bar goes away, no last line

  RenderProgress* progress() { return &progress_; }

  // Prints the frame's last line: rays, seconds, rays a second.
  void Finish(const RenderStats& stats);

 private:
  void Watch();
  void StopWatching();
  void DrawBar(double seconds);
  void PrintLine(double seconds);

  const ProgressStyle style_;
  const std::string label_;
  const std::uint64_t pixels_;
  RenderProgress progress_;

  std::mutex mutex_;
  std::condition_variable wake_;
  bool finished_ = false;  // guarded by mutex_

  // Of the watching thread alone.
  bool bar_drawn_ = false;
  double last_line_seconds_ = 0.0;
  std::uint64_t last_line_tenth_ = 0;

  std::thread thread_;  // last: it starts when everything else is there
};

// Tells how far work of many steps has come, and how long the rest takes at the pace so far. In
// kPlain a line a tenth, at most one every two seconds: short work says nothing.
class StepWatch {
 public:
  StepWatch(ProgressStyle style, std::string label, std::uint64_t steps);
  StepWatch(const StepWatch&) = delete;
  StepWatch& operator=(const StepWatch&) = delete;
  ~StepWatch();  // the bar goes away

  // A step is done.
  void Advance();

  // Takes the bar away until the next step, so that a line can be printed.
  void Clear();

 private:
  const ProgressStyle style_;
  const std::string label_;
  const std::uint64_t steps_;
  const std::chrono::steady_clock::time_point start_;
  std::uint64_t done_ = 0, last_line_tenth_ = 0;
  double last_line_seconds_ = 0.0;
};

// How a sequence of pictures comes along.
class SequencePace {
 public:
  explicit SequencePace(std::uint64_t pictures);

  // A picture is done, by this run or before it.
  void Advance() { ++done_; }
  void Skip() { ++done_, ++skipped_; }

  // Of the picture in work: "3/24, 1:20 left"; of the first "1/24", of an only one nothing.
  std::string Text() const;

 private:
  const std::uint64_t pictures_;
  const std::chrono::steady_clock::time_point start_;
  std::uint64_t done_ = 0, skipped_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_APP_PROGRESS_H_
