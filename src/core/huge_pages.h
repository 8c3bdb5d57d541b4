// Huge pages for large arrays: rays that jump about in a tree miss the TLB less.
#ifndef SHEAF_CORE_HUGE_PAGES_H_
#define SHEAF_CORE_HUGE_PAGES_H_

#include <cstddef>

namespace sheaf {

// Bytes of a huge page, and the alignment of arrays that take them.
inline constexpr std::size_t kHugePage = std::size_t{2} << 20;

// Whether an array of so many bytes is worth it: rounding up to whole pages then adds less than
// half.
constexpr bool PagesAreHuge(std::size_t bytes) { return bytes >= 2 * kHugePage; }

// A hint to the system for [data, data + bytes), aligned to kHugePage. Does nothing where the
// system has no such hint or does not take it.
void AskForHugePages(void* data, std::size_t bytes);

}  // namespace sheaf

#endif  // SHEAF_CORE_HUGE_PAGES_H_
