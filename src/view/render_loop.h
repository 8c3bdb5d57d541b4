// The thread that renders what the window shows.
//
// It takes the newest request, renders what FramePlan says, and publishes pictures. Whoever asks
// never waits for it: a frame at rest is stopped by a new request, a draft is finished, because it
// is done soon.
#ifndef SHEAF_VIEW_RENDER_LOOP_H_
#define SHEAF_VIEW_RENDER_LOOP_H_

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "sheaf/render.h"
#include "src/view/frame_plan.h"
#include "src/view/shown_film.h"
#include "src/view/view_frame.h"

namespace sheaf {

class RenderLoop {
 public:
  // `wake` is called from the thread when there is something new to show.
  RenderLoop(double frame_seconds, std::function<void()> wake);
  // Stops what is rendered and waits for that.
  ~RenderLoop();
  RenderLoop(const RenderLoop&) = delete;
  RenderLoop& operator=(const RenderLoop&) = delete;

  // From here on this is what is wanted.
  void Submit(const ViewRequest& request);

  // The newest picture; null before the first.
  std::shared_ptr<const ViewPicture> Latest() const;
  // Why the last frame failed; empty where it did not.
  std::string error() const;

  // Runs a task on the thread, before the next frame; a frame at rest is begun anew after it. Tasks
  // run in turn. A task may call Submit. Those that have not begun when the loop ends are dropped.
  using Task = std::function<void(ShownFilm& film)>;
  void Post(Task task);

 private:
  using Clock = std::chrono::steady_clock;

  void Run();
  void TakeRequest();
  void RunTask(std::unique_lock<std::mutex>& lock);
  void RunJob(const FrameJob& job, std::unique_lock<std::mutex>& lock);
  Status RenderSides(const ViewRequest& request, const FrameJob& job, ViewPicture* picture);
  Status RenderSide(const ViewRequest& request, const FrameJob& job, const PixelRect& rect,
                    const Target& target, ViewPicture* picture);
  void StopJob();
  void Publish(const ViewPicture& made);
  double Now() const;

  const Clock::time_point origin_ = Clock::now();
  const std::function<void()> wake_;

  mutable std::mutex mutex_;  // of all below but the film, which is the thread's own
  std::condition_variable changed_;
  bool is_ending_ = false;
  std::optional<ViewRequest> pending_;
  std::deque<Task> tasks_;
  std::shared_ptr<const ViewPicture> latest_;
  std::string error_;
  ViewRequest request_;
  FramePlan plan_;
  std::optional<FrameJob> job_;  // that is being rendered
  double job_start_ = 0;
  double draft_end_ = -1;    // of the last draft
  bool has_failed_ = false;  // the request, so that it is not tried again
  std::shared_ptr<RenderProgress> progress_;
  std::uint64_t published_ = 0;

  // The thread's own: the scene that is shown, and what was made of it.
  std::shared_ptr<const Scene> prepared_;
  std::optional<Renderer> renderer_;
  ShownFilm film_;
  double last_publish_ = 0;
  std::thread thread_;  // last: it uses all the others
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_RENDER_LOOP_H_
