// Reads a scene file: JSON with comments, described in docs/scene-format.md.
#ifndef SHEAF_FORMATS_SCENE_JSON_H_
#define SHEAF_FORMATS_SCENE_JSON_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Reads and checks a whole scene file. An unreadable file is kInputOutput; anything wrong inside it
// is kScene with the message `file:line: /json/path: what; did you mean "..."?`.
Result<Scene> ReadSceneJson(const std::string& path);

// The same within another scene, whose files and warnings these are.
Result<Scene> ReadSceneJson(const std::string& path, SceneFiles& files);
Result<Scene> ParseSceneJson(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_JSON_H_
