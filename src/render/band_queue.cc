#include "src/render/band_queue.h"

#include <cassert>
#include <utility>

namespace sheaf {

Film& BandQueue::Front(int width, int height, Layers layers) {
  Film& film = films_[front_];
  // A band of the same size keeps its memory, which the system would otherwise have to clear anew.
  if (film.width != width || film.height != height) {
    film.Resize(width, height, layers);
  }
  return film;
}

Status BandQueue::Wait() { return taken_.valid() ? taken_.get() : Status(Done{}); }

void BandQueue::Push() {
  assert(!taken_.valid() && thread_.joinable());
  {
    const std::lock_guard lock(mutex_);
    task_ = std::packaged_task<Status()>([this, &band = films_[front_]] { return Take(band); });
    taken_ = task_.get_future();
  }
  changed_.notify_one();
  front_ = 1 - front_;
}

void BandQueue::StartThread() {
  assert(!thread_.joinable());
  thread_ = std::thread([this] { Serve(); });
}

// What it takes up it finishes, and it takes up all.
void BandQueue::Serve() {
  while (true) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return task_.valid() || is_closing_; });
    if (!task_.valid()) return;
    std::packaged_task<Status()> task = std::move(task_);
    lock.unlock();
    task();
  }
}

BandQueue::~BandQueue() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

Status BandQueue::Take(Film& band) {
  Status status = sink_(band);
  if (!status) stop_.store(true, std::memory_order_relaxed);
  return status;
}

}  // namespace sheaf
