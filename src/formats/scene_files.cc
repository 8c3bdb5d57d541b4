#include "src/formats/scene_files.h"

#include <algorithm>
#include <cerrno>

#include "src/formats/read_file.h"

namespace sheaf {
namespace {

namespace fs = std::filesystem;

// Absolute first: of a relative path whose first part is not there, weakly_canonical keeps it
// relative.
fs::path Canonical(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path canonical = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : canonical;
}

// Whether an errno of opening or reading is about the path, not about the machine.
bool IsOfPath(int code) {
  constexpr int kCodes[] = {0, ENOENT, ENOTDIR, EACCES, EPERM, EISDIR, ELOOP, ENAMETOOLONG, ENXIO};
  return std::find(std::begin(kCodes), std::end(kCodes), code) != std::end(kCodes);
}

}  // namespace

SceneFiles::SceneFiles(const std::string& scene, const ReadOptions& options, DecodedImages* images)
    : options_(options),
      images_(images),
      root_(Canonical(fs::path(scene).parent_path() / ".")),
      paths_{scene} {}

Result<std::string> SceneFiles::Resolve(const std::string& from, const std::string& reference) {
  if (reference.empty() || reference.find('\0') != std::string::npos) {
    return Error{ErrorKind::kScene, "no name of a file"};
  }
  const fs::path path = fs::path(from).parent_path() / reference;  // an absolute one stays
  if (options_.outside == Outside::kRefused) {
    const fs::path within = Canonical(path).lexically_relative(root_);
    if (within.empty() || *within.begin() == "..") {
      return Error{ErrorKind::kScene, "lies outside the scene's folder (see --allow-outside)"};
    }
  }
  paths_.push_back(path.string());
  return path.string();
}

Result<std::string> SceneFiles::Read(const std::string& path, std::size_t max_bytes) {
  int code = 0;
  Result<std::string> bytes = ReadWholeFile(path, max_bytes, &code);
  if (!bytes && !IsOfPath(code) && !fault_) fault_ = bytes.error();
  return bytes;
}

void SceneFiles::AddAnimation(const std::string& name, double seconds) {
  animations_.push_back(name);
  const bool counts = options_.animation.empty() || options_.animation == name;
  if (counts) duration_ = std::max(duration_, seconds);
}

bool SceneFiles::Enter(const std::string& path) {
  const fs::path canonical = Canonical(path);
  if (std::find(open_.begin(), open_.end(), canonical) != open_.end()) return false;
  open_.push_back(canonical);
  return true;
}

}  // namespace sheaf
