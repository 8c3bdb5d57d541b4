// `sheaf info`: what this build and this machine can do, and what a scene holds.
#ifndef SHEAF_APP_INFO_COMMAND_H_
#define SHEAF_APP_INFO_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command InfoCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_INFO_COMMAND_H_
