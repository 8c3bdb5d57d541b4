// `sheaf completion` and `sheaf man`.
#ifndef SHEAF_APP_MANUAL_COMMAND_H_
#define SHEAF_APP_MANUAL_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command CompletionCommand();
Command ManCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_MANUAL_COMMAND_H_
