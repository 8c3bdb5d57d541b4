// How the library was built.
#ifndef SHEAF_CORE_BUILD_INFO_H_
#define SHEAF_CORE_BUILD_INFO_H_

namespace sheaf {

const char* CompilerName();   // with its version
const char* BuildTypeName();  // CMake's, e.g. "Release"

}  // namespace sheaf

#endif  // SHEAF_CORE_BUILD_INFO_H_
