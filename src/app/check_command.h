// `sheaf check`: whether scenes are sound, and what of them rendering would skip.
#ifndef SHEAF_APP_CHECK_COMMAND_H_
#define SHEAF_APP_CHECK_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command CheckCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_CHECK_COMMAND_H_
