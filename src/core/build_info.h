// How the library was built.
#ifndef SHEAF_CORE_BUILD_INFO_H_
#define SHEAF_CORE_BUILD_INFO_H_

#include <span>

namespace sheaf {

const char* CompilerName();   // with its version
const char* CompilerFlags();  // of CMake's variables, e.g. "-O3 -DNDEBUG"
const char* BuildTypeName();  // CMake's, e.g. "Release"

// A part that a build may lack.
struct OptionalPart {
  const char* name;
  const char* purpose;
  bool is_built_in;
};

inline constexpr const char* kOidnPart = "OpenImageDenoise";

// All of them, whether built in or not.
std::span<const OptionalPart> OptionalParts();

}  // namespace sheaf

#endif  // SHEAF_CORE_BUILD_INFO_H_
