// `sheaf view`.
#ifndef SHEAF_APP_VIEW_COMMAND_H_
#define SHEAF_APP_VIEW_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command ViewCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_VIEW_COMMAND_H_
