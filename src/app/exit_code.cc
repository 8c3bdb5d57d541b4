#include "src/app/exit_code.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>

#include "src/app/interrupt.h"

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
  const std::string line = fmt::format("{}{}\n", prefix, error.message);
  std::fputs(line.c_str(), stderr);
  return ExitCodeOf(error.kind);
}

}  // namespace sheaf
