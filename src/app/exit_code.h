// What the command tells the shell.
#ifndef SHEAF_APP_EXIT_CODE_H_
#define SHEAF_APP_EXIT_CODE_H_

#include "sheaf/error.h"

namespace sheaf {

enum class ExitCode : int {
  kOk = 0,
  kDifferent = 1,  // what was compared differs, or a test failed
  kInternal = 1,   // a defect of the program, or no memory left
  kUsage = 2,
  kScene = 3,
  kInputOutput = 4,
  kUndecided = 5,      // a measurement was too noisy or too short for a verdict
  kInterrupted = 130,  // SIGINT, as shells count it
  kTerminated = 143,   // SIGTERM
};

// kInterrupted becomes the code of the signal that came (interrupt.h).
ExitCode ExitCodeOf(ErrorKind kind);

// Prints the error as one line on stderr and returns its exit code. A message about a scene stands
// alone, because it begins with file:line, which editors follow.
ExitCode Report(const Error& error);

}  // namespace sheaf

#endif  // SHEAF_APP_EXIT_CODE_H_
