#include "src/app/exit_code.h"

#include <fmt/format.h>

#include <csignal>

#include "src/app/interrupt.h"
#include "src/app/print_message.h"

namespace sheaf {

ExitCode ExitCodeOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return ExitCode::kUsage;
    case ErrorKind::kScene:
      return ExitCode::kScene;
    case ErrorKind::kInputOutput:
      return ExitCode::kInputOutput;
    case ErrorKind::kInterrupted:
      return PendingSignal() == SIGTERM ? ExitCode::kTerminated : ExitCode::kInterrupted;
  }
  return ExitCode::kInternal;
}

ExitCode Report(const Error& error) {
  const char* prefix = error.kind == ErrorKind::kScene ? "" : "sheaf: ";
  PrintMessage(fmt::format("{}{}", prefix, error.message));
  return ExitCodeOf(error.kind);
}

}  // namespace sheaf
