// Ranges of what stands in for oneTBB: on one thread (src/core/serial_tbb.h), and on plain threads
// (tests/tsan/plain_threads.h).
#ifndef SHEAF_CORE_STAND_IN_RANGES_H_
#define SHEAF_CORE_STAND_IN_RANGES_H_

#include <cstddef>

namespace oneapi::tbb {

template <typename Value>
class blocked_range {
 public:
  blocked_range(Value begin, Value end, std::size_t grain = 1)
      : begin_(begin), end_(end), grain_(grain) {}
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  std::size_t size() const { return begin_ < end_ ? static_cast<std::size_t>(end_ - begin_) : 0; }
  std::size_t grainsize() const { return grain_; }

 private:
  Value begin_, end_;
  std::size_t grain_;
};

struct simple_partitioner {};

}  // namespace oneapi::tbb

#endif  // SHEAF_CORE_STAND_IN_RANGES_H_
