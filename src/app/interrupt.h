// SIGINT and SIGTERM as a flag that long work looks at.
#ifndef SHEAF_APP_INTERRUPT_H_
#define SHEAF_APP_INTERRUPT_H_

namespace sheaf {

// From here on the first SIGINT or SIGTERM only raises the flag; a second one kills at once. A
// signal that the parent process had ignored (nohup, a shell's background job) stays ignored.
void CatchInterrupts();

// The signal that came, or 0.
int PendingSignal();

}  // namespace sheaf

#endif  // SHEAF_APP_INTERRUPT_H_
