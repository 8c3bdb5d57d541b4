// sheaf submit: one render as many jobs of a cluster.
#ifndef SHEAF_APP_SUBMIT_COMMAND_H_
#define SHEAF_APP_SUBMIT_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command SubmitCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_SUBMIT_COMMAND_H_
