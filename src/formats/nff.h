// NFF, the Neutral File Format of Haines' Standard Procedural Databases ("A Proposal for Standard
// Graphics Environments", IEEE CG&A 7(11), 1987).
#ifndef SHEAF_FORMATS_NFF_H_
#define SHEAF_FORMATS_NFF_H_

#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// Background, view (as the camera "nff" and the picture's size), lights, fills, cones and cylinders
// (as smooth quads without caps, as many sides as the options say), spheres, polygons and patches.
// docs/formats.md says what materials and lights hold. Errors are kScene, `name:line: what`.
Result<Scene> ParseNffScene(std::string_view text, const std::string& name, SceneFiles& files);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_NFF_H_
