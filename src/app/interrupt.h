// SIGINT and SIGTERM as a flag that long work looks at.
#ifndef SHEAF_APP_INTERRUPT_H_
#define SHEAF_APP_INTERRUPT_H_

#include "sheaf/error.h"

namespace sheaf {

// From here on the first SIGINT or SIGTERM only raises the flag; a second one kills at once. A
// signal that the parent process had ignored (nohup, a shell's background job) stays ignored.
void CatchInterrupts();

// The signal that came, or 0.
int PendingSignal();

// kInterrupted once it came.
Status CheckInterrupted();

// From here on SIGINT and SIGTERM end the process at once, with the exit code of the signal: for
// work that leaves nothing half-done.
void ExitOnInterrupts();

}  // namespace sheaf

#endif  // SHEAF_APP_INTERRUPT_H_
