#include "src/render/band_queue.h"

#include <cassert>

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
  assert(!taken_.valid());
  taken_ = std::async(std::launch::async, [this, &band = films_[front_]] { return Take(band); });
  front_ = 1 - front_;
}

Status BandQueue::Take(Film& band) {
  Status status = sink_(band);
  if (!status) stop_.store(true, std::memory_order_relaxed);
  return status;
}

}  // namespace sheaf
