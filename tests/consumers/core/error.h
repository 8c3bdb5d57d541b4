// A user's own header at a path that a library may use inside.
#ifndef SHEAF_TESTS_CONSUMERS_CORE_ERROR_H_
#define SHEAF_TESTS_CONSUMERS_CORE_ERROR_H_

inline constexpr int kOwnError = 3;

#endif  // SHEAF_TESTS_CONSUMERS_CORE_ERROR_H_
