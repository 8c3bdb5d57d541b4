// `sheaf pareto`: run time against error, over the settings that trade one for the other.
#ifndef SHEAF_APP_PARETO_COMMAND_H_
#define SHEAF_APP_PARETO_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command ParetoCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_PARETO_COMMAND_H_
