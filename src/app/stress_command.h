// `sheaf stress`: runs the stress cases of the numerics.
#ifndef SHEAF_APP_STRESS_COMMAND_H_
#define SHEAF_APP_STRESS_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command StressCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_STRESS_COMMAND_H_
