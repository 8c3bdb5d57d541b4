// Reads a scene file: JSON with comments, described in docs/scene-format.md.
#ifndef SHEAF_FORMATS_SCENE_JSON_H_
#define SHEAF_FORMATS_SCENE_JSON_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"

namespace sheaf {

// Reads and checks a whole scene file. An unreadable file is kInputOutput; anything wrong inside it
// is kScene with the message `file:line: /json/path: what; did you mean "..."?`.
Result<Scene> ReadSceneJson(const std::string& path);

// The same within another scene, whose files and warnings these are.
class SceneFiles;
Result<Scene> ReadSceneJson(const std::string& path, SceneFiles& files);
Result<Scene> ParseSceneJson(std::string_view text, const std::string& name, SceneFiles& files);

// The same from memory; `name` stands for the file in messages.
Result<Scene> ParseSceneJson(std::string_view text, const std::string& name);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SCENE_JSON_H_
