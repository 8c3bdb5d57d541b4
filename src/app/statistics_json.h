// The statistics of `sheaf render --json`; docs/command.md describes every field.
#ifndef SHEAF_APP_STATISTICS_JSON_H_
#define SHEAF_APP_STATISTICS_JSON_H_

#include <optional>
#include <string>
#include <vector>

#include "sheaf/render.h"
#include "src/cluster/leader.h"

namespace sheaf {

// One rendered and written picture.
struct FrameRecord {
  std::string camera;
  std::optional<int> frame;  // of a sequence
  std::string picture;       // its path
  RenderOptions options;
  RenderStats stats;                   // of what this run rendered
  int resumed_rows = 0;                // that an earlier run had rendered, parts added up
  bool is_kept = false;                // whether an earlier run had finished it
  std::vector<RankRecord> ranks = {};  // where several processes rendered
};

// One JSON object, indented, with a newline at its end. Bytes of a name that are not UTF-8 are
// replaced.
std::string StatisticsJson(const std::string& scene_path, const std::vector<FrameRecord>& frames);

}  // namespace sheaf

#endif  // SHEAF_APP_STATISTICS_JSON_H_
