// What a rank renders with: a thread that takes areas of a picture and gives their pixels back.
#ifndef SHEAF_CLUSTER_AREA_WORKER_H_
#define SHEAF_CLUSTER_AREA_WORKER_H_

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace sheaf {

struct FinishedArea {
  PixelRect area;
  Film pixels;
};

class AreaWorker {
 public:
  // Starts with the frame. All arguments outlive it.
  AreaWorker(const Scene& scene, const Camera& camera, const RenderOptions& options);
  AreaWorker(const AreaWorker&) = delete;
  AreaWorker& operator=(const AreaWorker&) = delete;
  ~AreaWorker();  // stops what it does

  // Whether the scene is compiled, so that areas are rendered at once.
  bool is_ready();

  // The next area to render, after those given before.
  void Give(const PixelRect& area);

  // No more areas come: it ends when those given are done.
  void End();

  // A finished area that has not been taken.
  std::optional<FinishedArea> Take();

  // Whether it has ended and all of its areas are taken.
  bool is_done();

  // After is_done: how it went; what threw is thrown.
  Status Join();
  const RenderStats& stats() const { return stats_; }

 private:
  void Run();
  bool Next(PixelRect* area);
  Status Finish(const PixelRect& area, Film& pixels);

  const Scene& scene_;
  const Camera& camera_;
  const RenderOptions options_;
  RenderProgress progress_;
  RenderStats stats_;
  Status status_ = Done{};
  std::exception_ptr thrown_;

  std::mutex mutex_;  // of all below
  std::condition_variable wake_;
  std::deque<PixelRect> given_;
  std::deque<FinishedArea> finished_;
  bool is_ready_ = false, is_ended_ = false, has_stopped_ = false;

  std::thread thread_;  // last: it starts when everything else is there
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_AREA_WORKER_H_
