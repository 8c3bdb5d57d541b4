// Which target really runs.
#ifndef SHEAF_CORE_RUNNING_TARGET_H_
#define SHEAF_CORE_RUNNING_TARGET_H_

#include <string>

#include "sheaf/target.h"

namespace sheaf {

// The name that code compiled for the target reports of itself, so that no target is another in
// disguise; "scalar" for the baseline.
std::string RunningTarget(Target target);

}  // namespace sheaf

#endif  // SHEAF_CORE_RUNNING_TARGET_H_
