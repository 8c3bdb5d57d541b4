// What the library uses of oneTBB, on the calling thread alone: for where there are no threads.
// CMake puts it in the place of <oneapi/tbb/...> (src/core/stand_in_tbb.cmake); nothing includes it
// by name.
#ifndef SHEAF_CORE_SERIAL_TBB_H_
#define SHEAF_CORE_SERIAL_TBB_H_

#include <cstddef>

#include "src/core/stand_in_ranges.h"

namespace oneapi::tbb {

// The whole range at once, which is one of the ways in which oneTBB may cut it.
template <typename Value, typename Body, typename... Partitioner>
void parallel_for(const blocked_range<Value>& range, const Body& body, const Partitioner&...) {
  if (range.begin() < range.end()) body(range);
}

template <typename Index, typename Body>
void parallel_for(Index begin, Index end, const Body& body) {
  for (Index i = begin; i < end; ++i) body(i);
}

template <typename Range, typename Value, typename Body, typename Join, typename... Partitioner>
Value parallel_reduce(const Range& range, const Value& identity, const Body& body, const Join&,
                      const Partitioner&...) {
  return body(range, identity);
}

// A task runs where it is handed over. What it throws is thrown there, not by wait().
class task_group {
 public:
  template <typename Task>
  void run(const Task& task) {
    task();
  }
  void wait() {}
};

class task_arena {
 public:
  explicit task_arena(int = 1) {}
  template <typename Task>
  auto execute(const Task& task) {
    return task();
  }
};

namespace this_task_arena {
inline int current_thread_index() { return 0; }
}  // namespace this_task_arena

namespace info {
inline int default_concurrency() { return 1; }
}  // namespace info

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t) {}
  static std::size_t active_value(parameter) { return 1; }
};

}  // namespace oneapi::tbb

#endif  // SHEAF_CORE_SERIAL_TBB_H_
