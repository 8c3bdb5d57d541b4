#include "src/cluster/area_worker.h"

#include <utility>

#include "src/render/render_frame.h"

namespace sheaf {

AreaWorker::AreaWorker(const Scene& scene, const Camera& camera, const RenderOptions& options)
    : scene_(scene), camera_(camera), options_(options), thread_([this] { Run(); }) {}

AreaWorker::~AreaWorker() {
  progress_.stop.store(true, std::memory_order_relaxed);
  End();
  if (thread_.joinable()) thread_.join();
}

void AreaWorker::Run() {
  Status status = Done{};
  try {
    status = RenderAreas(
        scene_, camera_, options_, [this](PixelRect* area) { return Next(area); },
        [this](const PixelRect& area, Film& pixels) { return Finish(area, pixels); }, &stats_,
        &progress_);
  } catch (...) {
    thrown_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  status_ = std::move(status);
  has_stopped_ = true;
}

bool AreaWorker::Next(PixelRect* area) {
  std::unique_lock lock(mutex_);
  is_ready_ = true;
  wake_.wait(lock, [this] { return is_ended_ || !given_.empty(); });
  if (given_.empty() || progress_.stop.load(std::memory_order_relaxed)) return false;
  *area = given_.front();
  given_.pop_front();
  return true;
}

Status AreaWorker::Finish(const PixelRect& area, Film& pixels) {
  const std::lock_guard lock(mutex_);
  finished_.push_back({area, std::move(pixels)});
  return Done{};
}

bool AreaWorker::is_ready() {
  const std::lock_guard lock(mutex_);
  return is_ready_;
}

void AreaWorker::Give(const PixelRect& area) {
  const std::lock_guard lock(mutex_);
  given_.push_back(area);
  wake_.notify_one();
}

void AreaWorker::End() {
  const std::lock_guard lock(mutex_);
  is_ended_ = true;
  wake_.notify_one();
}

std::optional<FinishedArea> AreaWorker::Take() {
  const std::lock_guard lock(mutex_);
  if (finished_.empty()) return std::nullopt;
  FinishedArea area = std::move(finished_.front());
  finished_.pop_front();
  return area;
}

bool AreaWorker::is_done() {
  const std::lock_guard lock(mutex_);
  return has_stopped_ && finished_.empty();
}

Status AreaWorker::Join() {
  thread_.join();
  if (thrown_) std::rethrow_exception(thrown_);
  return status_;
}

}  // namespace sheaf
