// `sheaf merge`: parts of a picture become the whole.
#ifndef SHEAF_APP_MERGE_COMMAND_H_
#define SHEAF_APP_MERGE_COMMAND_H_

#include <string>
#include <vector>

#include "sheaf/error.h"

namespace CLI {
class App;
}

namespace sheaf {

struct MergeRequest {
  std::vector<std::string> parts;
  std::string output;
};

// Adds the subcommand; parsing then fills `request`, which has to outlive `app`.
CLI::App* AddMergeCommand(CLI::App& app, MergeRequest& request);

Status RunMerge(const MergeRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_MERGE_COMMAND_H_
