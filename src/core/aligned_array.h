// An owning array aligned for whole-vector loads and stores.
#ifndef SHEAF_CORE_ALIGNED_ARRAY_H_
#define SHEAF_CORE_ALIGNED_ARRAY_H_

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>

#include "simd/streams.h"
#include "src/core/huge_pages.h"

namespace sheaf {

// Aligned to kAlignment. Elements are trivial and start as zeros, so that padding lanes hold
// numbers.
template <typename T>
class AlignedArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  AlignedArray() = default;

  // Drops what it held. Throws std::bad_alloc where memory runs out.
  void Allocate(std::size_t size) { AllocateForOverwrite(size, size); }
  // The same, but only the last `padding` elements start as zeros: the others are written before
  // they are read.
  void AllocateForOverwrite(std::size_t size, std::size_t padding) {
    const bool is_huge = PagesAreHuge(size * sizeof(T));
    const std::size_t bytes = is_huge ? RoundUpToHugePages(size * sizeof(T)) : size * sizeof(T);
    const std::align_val_t alignment{is_huge ? kHugePage : kAlignment};
    data_ = {static_cast<T*>(::operator new(bytes, alignment)), Free{alignment}};
    if (is_huge) AskForHugePages(data_.get(), bytes);
    std::memset(static_cast<void*>(data_.get() + (size - padding)), 0, padding * sizeof(T));
    size_ = size;
  }

  // Allocates where there is less room, then for at least twice as much as before, so that
  // allocations are few while sizes grow.
  void Reserve(std::size_t size) {
    if (size > size_) Allocate(size > 2 * size_ ? size : 2 * size_);
  }

  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  T* data() { return data_.get(); }
  const T* data() const { return data_.get(); }
  T& operator[](std::size_t i) { return data_.get()[i]; }
  const T& operator[](std::size_t i) const { return data_.get()[i]; }

 private:
  struct Free {
    std::align_val_t alignment{kAlignment};
    void operator()(T* p) const { ::operator delete(static_cast<void*>(p), alignment); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_CORE_ALIGNED_ARRAY_H_
