// Whether two numbers are the same down to the sign of zero and the bits of a NaN.
#ifndef SHEAF_TESTS_BITS_H_
#define SHEAF_TESTS_BITS_H_

#include <cstring>

namespace sheaf {

template <typename Real>
bool SameBits(Real a, Real b) {
  return std::memcmp(&a, &b, sizeof(Real)) == 0;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_BITS_H_
