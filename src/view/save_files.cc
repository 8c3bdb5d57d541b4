#include "src/view/save_files.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "src/formats/scene_cameras.h"
#include "src/formats/scene_values.h"

namespace sheaf {

std::string NextFreePath(const std::string& prefix, const std::string& ending, int* number) {
  for (*number = 1;; ++*number) {
    std::string path = fmt::format("{}-{}.{}", prefix, *number, ending);
    std::error_code error;
    const auto status = std::filesystem::symlink_status(path, error);
    if (status.type() == std::filesystem::file_type::not_found || error) return path;
  }
}

std::string CameraFileText(const Camera& camera, const std::string& name) {
  Camera named = camera;
  named.name = name;
  named.path.clear();  // it stands where it stands
  const Json json = {{"cameras", Json::array({CameraJson(named)})}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sheaf
