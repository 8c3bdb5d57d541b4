// Another of a user's own headers, at a path of Sheaf's sources.
#ifndef SHEAF_TESTS_CONSUMERS_SRC_CORE_ERROR_H_
#define SHEAF_TESTS_CONSUMERS_SRC_CORE_ERROR_H_

inline constexpr int kOwnSourceError = 4;

#endif  // SHEAF_TESTS_CONSUMERS_SRC_CORE_ERROR_H_
