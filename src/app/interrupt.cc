#include "src/app/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace sheaf {
namespace {

std::atomic<int> pending_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait for a lock");

extern "C" void RaiseFlag(int signal) { pending_signal.store(signal, std::memory_order_relaxed); }

// A handler may neither lock nor allocate: _exit and write do not.
extern "C" void ExitAtOnce(int signal) {
  constexpr char kLine[] = "sheaf: interrupted\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kLine, sizeof kLine - 1);
  _exit(128 + signal);
}

void HandleWith(void (*handler)(int)) {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action;
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    // SA_RESETHAND gives the second signal its deadly default back.
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

void CatchInterrupts() { HandleWith(&RaiseFlag); }

void ExitOnInterrupts() { HandleWith(&ExitAtOnce); }

int PendingSignal() { return pending_signal.load(std::memory_order_relaxed); }

Status CheckInterrupted() {
  if (PendingSignal() != 0) return Error{ErrorKind::kInterrupted, "interrupted"};
  return Done{};
}

}  // namespace sheaf
