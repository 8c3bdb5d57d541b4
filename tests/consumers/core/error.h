// A user's own header at a path that a library may use inside.
#ifndef CONSUMER_CORE_ERROR_H_
#define CONSUMER_CORE_ERROR_H_

inline constexpr int kOwnError = 3;

#endif  // CONSUMER_CORE_ERROR_H_
