// A parallel loop over independent items, on oneTBB.
#ifndef SHEAF_CORE_PARALLEL_H_
#define SHEAF_CORE_PARALLEL_H_

#include <cstdint>
#include <functional>

namespace sheaf {

// `threads`, or the number of cores this process may use where it is 0; at most what the process
// allows oneTBB at the time: one a core, unless the host program has set another limit.
int ThreadCount(int threads);

// Calls body(worker, item) for every item in [0, count), each once, on at most `threads` threads:
// in [1, ThreadCount(threads)]. Nothing of the host's oneTBB is changed. Calls with the same
// worker, in [0, threads), never overlap, so that a worker may own its buffers. Items are handed
// out one by one. What a body throws is thrown here, after the loop has stopped.
void ParallelFor(int threads, std::uint64_t count,
                 const std::function<void(int worker, std::uint64_t item)>& body);

}  // namespace sheaf

#endif  // SHEAF_CORE_PARALLEL_H_
