#include "src/core/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <cstddef>

namespace sheaf {

int ThreadCount(int threads) {
  using oneapi::tbb::global_control;
  // The limit is the host's: a core each, unless it has set another.
  const std::size_t most = global_control::active_value(global_control::max_allowed_parallelism);
  const int wanted = threads > 0 ? threads : oneapi::tbb::info::default_concurrency();
  return static_cast<int>(std::min(static_cast<std::size_t>(wanted), most));
}

void ParallelFor(int threads, std::uint64_t count,
                 const std::function<void(int worker, std::uint64_t item)>& body) {
  assert(threads > 0);
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] {
    oneapi::tbb::parallel_for(
        oneapi::tbb::blocked_range<std::uint64_t>(0, count, 1),
        [&](const oneapi::tbb::blocked_range<std::uint64_t>& range) {
          const int worker = oneapi::tbb::this_task_arena::current_thread_index();
          for (std::uint64_t item = range.begin(); item != range.end(); ++item) body(worker, item);
        },
        oneapi::tbb::simple_partitioner());
  });
}

}  // namespace sheaf
