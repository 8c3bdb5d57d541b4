// `sheaf convert`: scenes into scene JSON, pictures into another format.
#ifndef SHEAF_APP_CONVERT_COMMAND_H_
#define SHEAF_APP_CONVERT_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command ConvertCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_CONVERT_COMMAND_H_
