// `sheaf bench`: rays a second by target, and a verdict against an earlier run.
#ifndef SHEAF_APP_BENCH_COMMAND_H_
#define SHEAF_APP_BENCH_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command BenchCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_BENCH_COMMAND_H_
