// Each kernel on a small batch, and the scalar baseline at the same work.
#ifndef SHEAF_LAB_KERNEL_CASES_H_
#define SHEAF_LAB_KERNEL_CASES_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "simd/kernels.h"

namespace sheaf {

// Work that can be repeated: every call does the same. The closures own what they work on, which
// one thread at a time may do.
struct KernelCase {
  std::string name;
  std::string element;     // what the time is a piece of
  std::uint32_t elements;  // of a call
  // The share of the lanes that work for a result: of elements that hit, face the light or spawn.
  double live;
  std::function<void()> scalar;
  std::function<void(const Kernels<float>&)> simd;
};

// In the order in which a frame runs them.
std::vector<KernelCase> MakeKernelCases();

}  // namespace sheaf

#endif  // SHEAF_LAB_KERNEL_CASES_H_
