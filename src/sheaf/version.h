// The version of these headers, and the mark of what the library exports. C reads it too.
#ifndef SHEAF_SHEAF_VERSION_H_
#define SHEAF_SHEAF_VERSION_H_

// CMake reads the project's version from here.
#define SHEAF_VERSION_MAJOR 0
#define SHEAF_VERSION_MINOR 2
#define SHEAF_VERSION_PATCH 0

#define SHEAF_STRINGIFY_(x) #x
#define SHEAF_STRINGIFY(x) SHEAF_STRINGIFY_(x)
#define SHEAF_VERSION_STRING           \
  SHEAF_STRINGIFY(SHEAF_VERSION_MAJOR) \
  "." SHEAF_STRINGIFY(SHEAF_VERSION_MINOR) "." SHEAF_STRINGIFY(SHEAF_VERSION_PATCH)

// Stands before each function that a program may call. A shared library hides everything else; what
// links the static one re-exports nothing.
#if defined(SHEAF_SHARED) && defined(__GNUC__)
#define SHEAF_API __attribute__((visibility("default")))
#else
#define SHEAF_API
#endif

#ifdef __cplusplus

namespace sheaf {

inline constexpr char kVersion[] = SHEAF_VERSION_STRING;

// The version of the library that runs, like "0.2.0": another than kVersion where a shared library
// was exchanged. Lives as long as the process.
SHEAF_API const char* LibraryVersion();

}  // namespace sheaf

#endif  // __cplusplus

#endif  // SHEAF_SHEAF_VERSION_H_
