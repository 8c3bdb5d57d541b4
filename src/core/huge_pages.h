// Huge pages for large arrays: rays that jump about in a tree miss the TLB less.
#ifndef SHEAF_CORE_HUGE_PAGES_H_
#define SHEAF_CORE_HUGE_PAGES_H_

#include <cstddef>

namespace sheaf {

// Bytes of a huge page, and the alignment of arrays that take them.
inline constexpr std::size_t kHugePage = std::size_t{2} << 20;

// Whether an array of so many bytes is worth it: rounding up to whole pages at most doubles it.
constexpr bool PagesAreHuge(std::size_t bytes) { return bytes >= kHugePage; }
constexpr std::size_t RoundUpToHugePages(std::size_t bytes) {
  return (bytes + kHugePage - 1) / kHugePage * kHugePage;
}

// A hint to the system for [data, data + bytes), whole huge pages. Does nothing where the system
// has no such hint or does not take it.
void AskForHugePages(void* data, std::size_t bytes);

}  // namespace sheaf

#endif  // SHEAF_CORE_HUGE_PAGES_H_
