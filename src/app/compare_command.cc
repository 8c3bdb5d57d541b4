#include "src/app/compare_command.h"

#include <fmt/format.h>

#include "src/app/add_options.h"
#include "src/app/compare_pictures.h"
#include "src/app/compare_renderings.h"
#include "src/app/compare_request.h"
#include "src/formats/format_table.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

enum class Mode { kRenderings, kPictures };

// Refuses an option that only the other mode reads.
Status CheckOptions(const CLI::App& command, Mode mode) {
  for (const std::string& name : GivenOptions(command)) {
    if (name == "INPUT" || name == "--json" || name == "--progress") continue;
    const bool is_of_pictures = name == "--transfer" || name == "--fail";
    if (is_of_pictures == (mode == Mode::kPictures)) continue;
    return Usage(fmt::format("{}: only where {} compared", name,
                             is_of_pictures ? "pictures are" : "a scene's renderings are"));
  }
  return Done{};
}

Result<ExitCode> RunCompare(const CompareRequest& request) {
  const Mode mode = CheckPicturePath(request.inputs.front()) ? Mode::kPictures : Mode::kRenderings;
  if (const Status heard = CheckOptions(*request.command, mode); !heard) return heard.error();
  if (mode == Mode::kPictures) return ComparePictures(request);
  if (request.inputs.size() > 1) {
    return Usage(fmt::format("{}: no {}, and of scenes there can be only one",
                             PrintablePath(request.inputs.front()), PictureEndings()));
  }
  return CompareRenderings(request);
}

}  // namespace

Command CompareCommand() { return MakeCommand(&AddCompareOptions, &RunCompare); }

}  // namespace sheaf
