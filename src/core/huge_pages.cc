#include "src/core/huge_pages.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace sheaf {

void AskForHugePages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  madvise(data, bytes, MADV_HUGEPAGE);
#endif
}

}  // namespace sheaf
