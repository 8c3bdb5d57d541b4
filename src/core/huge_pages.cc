#include "src/core/huge_pages.h"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace sheaf {

void AskForHugePages([[maybe_unused]] void* data, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
  // The last part of a page is left alone: what follows it is not this array's.
  madvise(data, bytes / kHugePage * kHugePage, MADV_HUGEPAGE);
#endif
}

}  // namespace sheaf
