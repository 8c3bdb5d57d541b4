// `sheaf diff`: a picture of where two pictures differ.
#ifndef SHEAF_APP_DIFF_COMMAND_H_
#define SHEAF_APP_DIFF_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command DiffCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_DIFF_COMMAND_H_
