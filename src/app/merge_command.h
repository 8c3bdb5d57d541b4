// `sheaf merge`: parts of a picture become the whole.
#ifndef SHEAF_APP_MERGE_COMMAND_H_
#define SHEAF_APP_MERGE_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command MergeCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_MERGE_COMMAND_H_
