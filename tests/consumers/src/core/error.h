// Another of a user's own headers, at a path of Sheaf's sources.
#ifndef CONSUMER_SRC_CORE_ERROR_H_
#define CONSUMER_SRC_CORE_ERROR_H_

inline constexpr int kOwnSourceError = 4;

#endif  // CONSUMER_SRC_CORE_ERROR_H_
