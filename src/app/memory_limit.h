// What happens where memory ends, and --memory-limit, which ends it early.
#ifndef SHEAF_APP_MEMORY_LIMIT_H_
#define SHEAF_APP_MEMORY_LIMIT_H_

#include <cstdint>
#include <optional>
#include <string_view>

#include "src/app/exit_code.h"

namespace CLI {
class App;
}

namespace sheaf {

// "512M", "2G", "3000000": bytes, or K, M, G and T of 1024. Nothing where it is none of these, 0
// or beyond 2^62.
std::optional<std::uint64_t> ParseBytes(std::string_view text);

// --memory-limit: from then on the process allocates no more.
void AddMemoryLimit(CLI::App& app);

// From then on the process ends with ReportMemoryEnd as operator new fails. Libraries that unwind
// from there wait for tasks that never ran: OpenEXR for its tiles, oneTBB for its limits.
void EndWhereMemoryEnds();

// One line on stderr, and its exit code: kInternal, or kScene where the limit was reached. Does not
// allocate, so that it may be called from anywhere.
ExitCode ReportMemoryEnd();

}  // namespace sheaf

#endif  // SHEAF_APP_MEMORY_LIMIT_H_
