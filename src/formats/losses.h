// Parts of a model that are left out.
#ifndef SHEAF_FORMATS_LOSSES_H_
#define SHEAF_FORMATS_LOSSES_H_

#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Each part is a warning. Where nothing of the model is left the first of them is the error.
class Losses {
 public:
  explicit Losses(SceneFiles& files) : files_(files) {}

  // At `place`, like `a.obj:12`; `kind` is what the warning counts.
  void LeaveOut(const std::string& place, std::string_view kind, std::string_view why) {
    if (!first_) first_ = Error{ErrorKind::kScene, fmt::format("{}: {}", place, why)};
    files_.Warn(place, kind, why);
  }

  const std::optional<Error>& first() const { return first_; }

 private:
  SceneFiles& files_;
  std::optional<Error> first_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_LOSSES_H_
