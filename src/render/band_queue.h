// Two films in turn: one is rendered into while a sink has the other.
#ifndef SHEAF_RENDER_BAND_QUEUE_H_
#define SHEAF_RENDER_BAND_QUEUE_H_

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <thread>

#include "sheaf/error.h"
#include "sheaf/film.h"

namespace sheaf {

// May take the film's contents away.
using BandSink = std::function<Status(Film& band)>;

// The queue between a frame and its sink, one band long. Its destructor waits for the sink. One
// thread serves all bands: a new thread may take milliseconds until it first runs, and until then,
// or longer, on the core that renders.
class BandQueue {
 public:
  // A sink that fails sets `stop`, so that the band in work ends soon too. Both outlive the queue.
  BandQueue(const BandSink& sink, std::atomic<bool>& stop) : sink_(sink), stop_(stop) {}
  ~BandQueue();
  BandQueue(const BandQueue&) = delete;
  BandQueue& operator=(const BandQueue&) = delete;

  // Starts the thread. Before the first Push.
  void StartThread();

  // The film that the sink does not have, in this size and with these layers, holding anything.
  // Valid until Push.
  Film& Front(int width, int height, Layers layers);

  // Waits until the sink is done with what it has; an error if it failed.
  Status Wait();

  // After Wait: hands Front's film to the sink, in the queue's thread.
  void Push();

  // After Wait: hands Front's film to the sink and waits for it.
  Status PushLast() { return Take(films_[front_]); }

 private:
  Status Take(Film& band);
  void Serve();

  const BandSink& sink_;
  std::atomic<bool>& stop_;
  Film films_[2];
  int front_ = 0;
  std::future<Status> taken_;  // of the band that the sink has

  std::thread thread_;
  std::mutex mutex_;  // of the two below, which the thread waits for
  std::condition_variable changed_;
  std::packaged_task<Status()> task_;  // not yet taken up
  bool is_closing_ = false;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_BAND_QUEUE_H_
