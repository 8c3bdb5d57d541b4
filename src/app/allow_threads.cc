#include "src/app/allow_threads.h"

#include <oneapi/tbb/global_control.h>

#include <cstddef>
#include <vector>

namespace sheaf {

void AllowThreads(int threads) {
  using oneapi::tbb::global_control;
  const auto wanted = static_cast<std::size_t>(threads);
  if (wanted <= global_control::active_value(global_control::max_allowed_parallelism)) return;
  // Never destroyed: oneTBB allocates as it takes a limit back, and memory may have run out.
  static std::vector<const global_control*>& held = *new std::vector<const global_control*>;
  held.push_back(new global_control(global_control::max_allowed_parallelism, wanted));
}

}  // namespace sheaf
