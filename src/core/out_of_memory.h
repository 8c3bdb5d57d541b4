// Where memory ran out inside a library that makes text of exceptions.
#ifndef SHEAF_CORE_OUT_OF_MEMORY_H_
#define SHEAF_CORE_OUT_OF_MEMORY_H_

#include <cerrno>
#include <new>
#include <string_view>

namespace sheaf {

// Whether what a library says of its failure means memory. A thread that does not start is for want
// of its stack.
inline bool SpeaksOfMemory(std::string_view text) {
  for (const std::string_view sign :
       {"bad_alloc", "nsufficient memory", "annot allocate memory", "pthread_create"}) {
    if (text.find(sign) != std::string_view::npos) return true;
  }
  return false;
}

// Throws std::bad_alloc again where it does.
inline void ThrowIfOutOfMemory(std::string_view text) {
  if (SpeaksOfMemory(text)) throw std::bad_alloc();
}

// The same of a system call's errno.
inline void ThrowIfOutOfMemory(int code) {
  if (code == ENOMEM) throw std::bad_alloc();
}

}  // namespace sheaf

#endif  // SHEAF_CORE_OUT_OF_MEMORY_H_
