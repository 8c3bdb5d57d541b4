// `sheaf compare`: whether a scene's renderings have the same bits, or how far apart pictures are.
#ifndef SHEAF_APP_COMPARE_COMMAND_H_
#define SHEAF_APP_COMPARE_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command CompareCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_COMPARE_COMMAND_H_
