// Two films in turn: one is rendered into while a sink has the other.
#ifndef SHEAF_RENDER_BAND_QUEUE_H_
#define SHEAF_RENDER_BAND_QUEUE_H_

#include <atomic>
#include <functional>
#include <future>

#include "sheaf/error.h"
#include "sheaf/film.h"

namespace sheaf {

// May take the film's contents away.
using BandSink = std::function<Status(Film& band)>;

// The queue between a frame and its sink, one band long. Its destructor waits for the sink.
class BandQueue {
 public:
  // A sink that fails sets `stop`, so that the band in work ends soon too. Both outlive the queue.
  BandQueue(const BandSink& sink, std::atomic<bool>& stop) : sink_(sink), stop_(stop) {}

  // The film that the sink does not have, in this size and with these layers, holding anything.
  // Valid until Push.
  Film& Front(int width, int height, Layers layers);

  // Waits until the sink is done with what it has; an error if it failed.
  Status Wait();

  // After Wait: hands Front's film to the sink, in a thread of its own.
  void Push();

  // After Wait: hands Front's film to the sink and waits for it.
  Status PushLast() { return Take(films_[front_]); }

 private:
  Status Take(Film& band);

  const BandSink& sink_;
  std::atomic<bool>& stop_;
  Film films_[2];
  int front_ = 0;
  std::future<Status> taken_;  // last: destroyed first, and its destructor waits
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_BAND_QUEUE_H_
