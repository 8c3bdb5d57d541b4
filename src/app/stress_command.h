// `sheaf stress`: runs the stress cases of the numerics.
#ifndef SHEAF_APP_STRESS_COMMAND_H_
#define SHEAF_APP_STRESS_COMMAND_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "src/app/exit_code.h"
#include "src/lab/stress.h"

namespace CLI {
class App;
}

namespace sheaf {

// The command line as it was given.
struct StressRequest {
  std::vector<std::string> cases;  // empty: all
  bool list = false, thorough = false;
  std::optional<stress::Ray> replay;
};

CLI::App* AddStressCommand(CLI::App& app, StressRequest& request);

// kDifferent where a case fails.
Result<ExitCode> RunStress(const StressRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_STRESS_COMMAND_H_
