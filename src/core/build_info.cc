#include "src/core/build_info.h"

#include "sheaf/version.h"

namespace sheaf {

const char* LibraryVersion() { return kVersion; }
const char* CompilerName() { return SHEAF_COMPILER; }
const char* BuildTypeName() { return SHEAF_BUILD_TYPE; }

}  // namespace sheaf
