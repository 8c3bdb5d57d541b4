#include "src/app/interrupt.h"

#include <atomic>
#include <csignal>

namespace sheaf {
namespace {

std::atomic<int> pending_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may not wait for a lock");

extern "C" void RaiseFlag(int signal) { pending_signal.store(signal, std::memory_order_relaxed); }

}  // namespace

void CatchInterrupts() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction action;
    if (sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = &RaiseFlag;
    sigemptyset(&action.sa_mask);
    // SA_RESETHAND gives the second signal its deadly default back.
    action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
    sigaction(signal, &action, nullptr);
  }
}

int PendingSignal() { return pending_signal.load(std::memory_order_relaxed); }

}  // namespace sheaf
