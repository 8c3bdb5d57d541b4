// A subcommand of `sheaf`: the options that it adds, and what runs when they are parsed.
#ifndef SHEAF_APP_COMMAND_H_
#define SHEAF_APP_COMMAND_H_

#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

#include "sheaf/error.h"
#include "src/app/exit_code.h"

namespace CLI {
class App;
}

namespace sheaf {

struct Command {
  std::function<void(CLI::App&)> add_options;
  std::function<Result<ExitCode>()> run;
};

// The command whose options fill a Request. `run` returns a Status or a Result<ExitCode>.
template <typename Request, typename Ran>
Command MakeCommand(void (*add_options)(CLI::App&, Request&), Ran (*run)(const Request&)) {
  const auto request = std::make_shared<Request>();
  return {[=](CLI::App& app) { add_options(app, *request); },
          [=]() -> Result<ExitCode> {
            Ran ran = run(*request);
            if (!ran) return ran.error();
            if constexpr (std::is_same_v<Ran, Status>)
              return ExitCode::kOk;
            else
              return std::move(ran).value();
          }};
}

}  // namespace sheaf

#endif  // SHEAF_APP_COMMAND_H_
