// How many parts of a size cover a whole.
#ifndef SHEAF_CORE_CEIL_DIVIDE_H_
#define SHEAF_CORE_CEIL_DIVIDE_H_

namespace sheaf {

// a / b, rounded up; a >= 0, b > 0, and their sum is an int.
constexpr int CeilDivide(int a, int b) { return (a + b - 1) / b; }

}  // namespace sheaf

#endif  // SHEAF_CORE_CEIL_DIVIDE_H_
