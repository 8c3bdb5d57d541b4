// The files of one scene while it is read.
#ifndef SHEAF_FORMATS_SCENE_FILES_H_
#define SHEAF_FORMATS_SCENE_FILES_H_

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "src/formats/decoded_images.h"
#include "src/formats/warnings.h"

namespace sheaf {

// What readers share while one scene is read: which files they may open, which are open, and what
// they have to say.
class SceneFiles {
 public:
  // `images`, if any, outlive it.
  SceneFiles(const std::string& scene, const ReadOptions& options, DecodedImages* images = nullptr);

  const ReadOptions& options() const { return options_; }

  DecodedImages& images() { return images_ != nullptr ? *images_ : own_images_; }

  // The path of `reference`, as the file `from` names it: relative to its folder. An error, without
  // a place, where it leaves the scene's folder and may not.
  Result<std::string> Resolve(const std::string& from, const std::string& reference);

  // The bytes of a file that was resolved. Whoever calls may do without a file that is missing; a
  // disk or a system that fails is a fault of the whole scene, which must not look well without.
  Result<std::string> Read(const std::string& path, std::size_t max_bytes);
  const std::optional<Error>& fault() const { return fault_; }

  // Includes: false where `path` is being read already.
  bool Enter(const std::string& path);
  void Leave() { open_.pop_back(); }

  // What is left out or replaced, as Warnings::Add takes it. The rule for every reader: what can be
  // rendered is rendered, and what was lost is said here.
  void Warn(std::string_view place, std::string_view kind, std::string_view detail = {}) {
    warnings_.Add(place, kind, detail);
  }
  const Warnings& warnings() const { return warnings_; }

  // An animation that a model has, whether it counts or not.
  void AddAnimation(const std::string& name, double seconds);
  const std::vector<std::string>& animations() const { return animations_; }  // their names
  double duration() const { return duration_; }  // seconds of the longest that counts

  // The scene itself and whatever was resolved.
  const std::vector<std::string>& paths() const { return paths_; }

 private:
  ReadOptions options_;
  DecodedImages* images_;
  DecodedImages own_images_;
  std::filesystem::path root_;
  std::vector<std::filesystem::path> open_;
  Warnings warnings_;
  std::vector<std::string> paths_;
  std::optional<Error> fault_;  // the first
  std::vector<std::string> animations_;
  double duration_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_FILES_H_
