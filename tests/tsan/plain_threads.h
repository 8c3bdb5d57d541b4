// What the library uses of oneTBB, on plain std::thread: for the thread sanitizer, which does not
// see how oneTBB's own library synchronises and calls races what are none. CMake puts it in the
// place of <oneapi/tbb/...> (SHEAF_PLAIN_THREADS); nothing includes it by name. It orders threads
// no more than oneTBB promises: items are handed out without an order of memory, so that races
// between them show.
#ifndef SHEAF_TESTS_TSAN_PLAIN_THREADS_H_
#define SHEAF_TESTS_TSAN_PLAIN_THREADS_H_

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "src/core/stand_in_ranges.h"

namespace oneapi::tbb {

namespace info {
inline int default_concurrency() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}
}  // namespace info

// The lowest limit holds, as in oneTBB; it may be more than the cores.
class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t most) : most_(most) {
    const std::lock_guard lock(Mutex());
    Limits().insert(most_);
  }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;
  ~global_control() {
    const std::lock_guard lock(Mutex());
    Limits().erase(Limits().find(most_));
  }
  static std::size_t active_value(parameter) {
    const std::lock_guard lock(Mutex());
    if (Limits().empty()) return static_cast<std::size_t>(info::default_concurrency());
    return *Limits().begin();
  }

 private:
  static std::mutex& Mutex() {
    static std::mutex mutex;
    return mutex;
  }
  static std::multiset<std::size_t>& Limits() {
    static std::multiset<std::size_t> limits;
    return limits;
  }

  std::size_t most_;
};

// What the three below share; no names of oneTBB.
namespace plain {

// The places of threads in an arena. A thread has one as long as it works there.
class Slots {
 public:
  explicit Slots(int count) : is_free_(static_cast<std::size_t>(std::max(1, count)), true) {}

  std::optional<int> Take() {
    const std::lock_guard lock(mutex_);
    const auto at = std::find(is_free_.begin(), is_free_.end(), true);
    if (at == is_free_.end()) return std::nullopt;
    *at = false;
    return static_cast<int>(at - is_free_.begin());
  }
  void Give(int slot) {
    const std::lock_guard lock(mutex_);
    is_free_[static_cast<std::size_t>(slot)] = true;
  }

 private:
  std::mutex mutex_;
  std::vector<bool> is_free_;
};

// Where a thread works.
struct Place {
  std::shared_ptr<Slots> slots;
  int slot = 0;
};
inline thread_local Place here;

// Calls work() in a place, which is free again afterwards, whatever it throws.
template <typename Work>
auto WorkAt(Place place, const Work& work) {
  struct Stay {
    explicit Stay(Place place) : before(std::exchange(here, std::move(place))) {}
    ~Stay() {
      here.slots->Give(here.slot);
      here = std::move(before);
    }
    Place before;
  } stay(std::move(place));
  return work();
}

// The first exception of several threads.
class Failure {
 public:
  template <typename Work>
  void Catch(const Work& work) {
    try {
      work();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!first_) first_ = std::current_exception();
      has_failed_.store(true, std::memory_order_relaxed);
    }
  }
  bool has_failed() const { return has_failed_.load(std::memory_order_relaxed); }
  // Once the threads are joined.
  void Rethrow() {
    if (const std::exception_ptr first = std::exchange(first_, nullptr)) {
      std::rethrow_exception(first);
    }
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
  std::atomic<bool> has_failed_ = false;
};

}  // namespace plain

class task_arena {
 public:
  explicit task_arena(int threads = info::default_concurrency())
      : slots_(std::make_shared<plain::Slots>(threads)) {}
  // One thread from outside at a time, as the library has it.
  template <typename Work>
  auto execute(const Work& work) {
    return plain::WorkAt({slots_, slots_->Take().value()}, work);
  }

 private:
  std::shared_ptr<plain::Slots> slots_;
};

namespace this_task_arena {
inline int current_thread_index() { return plain::here.slot; }
}  // namespace this_task_arena

namespace plain {

// Calls work(first, item) on this thread and on as many as the arena has room for, at most one an
// item: `first` counts these threads, and `item` gives each of them more, until there are none. The
// first item of a thread is its own, so that all of them work, however little there is to do.
template <typename Work>
void Spread(std::size_t count, const Work& work) {
  if (count == 0) return;
  if (!here.slots) return task_arena().execute([&] { Spread(count, work); });
  std::vector<Place> places;
  while (places.size() + 1 < count) {
    const std::optional<int> slot = here.slots->Take();
    if (!slot) break;
    places.push_back({here.slots, *slot});
  }
  std::atomic<std::size_t> next = places.size() + 1;
  Failure failure;
  const auto run = [&](std::size_t thread) {
    failure.Catch([&] {
      for (std::size_t item = thread; item < count && !failure.has_failed();
           item = next.fetch_add(1, std::memory_order_relaxed)) {
        work(thread, item);
      }
    });
  };
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < places.size(); ++i) {
    threads.emplace_back([&, i] { WorkAt(places[i], [&] { run(i + 1); }); });
  }
  run(0);
  for (std::thread& thread : threads) thread.join();
  failure.Rethrow();
}

// The n-th part of a range, of as many items as its grain size.
template <typename Value>
blocked_range<Value> PartOf(const blocked_range<Value>& range, std::size_t n) {
  const std::size_t first = n * range.grainsize();
  const std::size_t last = std::min(first + range.grainsize(), range.size());
  return {range.begin() + static_cast<Value>(first), range.begin() + static_cast<Value>(last),
          range.grainsize()};
}

template <typename Value>
std::size_t PartCount(const blocked_range<Value>& range) {
  return (range.size() + range.grainsize() - 1) / range.grainsize();
}

}  // namespace plain

template <typename Value, typename Body, typename... Partitioner>
void parallel_for(const blocked_range<Value>& range, const Body& body, const Partitioner&...) {
  plain::Spread(plain::PartCount(range),
                [&](std::size_t, std::size_t part) { body(plain::PartOf(range, part)); });
}

template <typename Index, typename Body>
void parallel_for(Index begin, Index end, const Body& body) {
  if (!(begin < end)) return;
  plain::Spread(static_cast<std::size_t>(end - begin),
                [&](std::size_t, std::size_t item) { body(begin + static_cast<Index>(item)); });
}

template <typename Range, typename Value, typename Body, typename Join, typename... Partitioner>
Value parallel_reduce(const Range& range, const Value& identity, const Body& body, const Join& join,
                      const Partitioner&...) {
  // One value a thread, of which there are no more than parts.
  std::vector<std::optional<Value>> values(plain::PartCount(range));
  plain::Spread(values.size(), [&](std::size_t thread, std::size_t part) {
    std::optional<Value>& value = values[thread];
    value = body(plain::PartOf(range, part), value ? std::move(*value) : identity);
  });
  Value whole = identity;
  for (std::optional<Value>& value : values) {
    if (value) whole = join(std::move(whole), std::move(*value));
  }
  return whole;
}

// A task gets a thread of its own where the arena has room for one, else it runs where it is handed
// over. Tasks may hand over more.
class task_group {
 public:
  template <typename Task>
  void run(const Task& task) {
    if (!plain::here.slots) return failure_.Catch(task);
    const std::optional<int> slot = plain::here.slots->Take();
    if (!slot) return failure_.Catch(task);
    const std::lock_guard lock(mutex_);
    threads_.emplace_back([this, task, place = plain::Place{plain::here.slots, *slot}] {
      plain::WorkAt(place, [&] { failure_.Catch(task); });
    });
  }
  void wait() {
    for (std::thread last; (last = TakeThread()).joinable();) last.join();
    failure_.Rethrow();
  }

 private:
  // One that cannot be joined where there are no more.
  std::thread TakeThread() {
    const std::lock_guard lock(mutex_);
    if (threads_.empty()) return {};
    std::thread last = std::move(threads_.back());
    threads_.pop_back();
    return last;
  }

  std::mutex mutex_;
  std::vector<std::thread> threads_;
  plain::Failure failure_;
};

}  // namespace oneapi::tbb

#endif  // SHEAF_TESTS_TSAN_PLAIN_THREADS_H_
