// Files that the window saves.
#ifndef SHEAF_VIEW_SAVE_FILES_H_
#define SHEAF_VIEW_SAVE_FILES_H_

#include <string>

#include "sheaf/scene.h"

namespace sheaf {

// PREFIX-1.ENDING, or the first number of which there is no file yet. `number` gets it.
std::string NextFreePath(const std::string& prefix, const std::string& ending, int* number);

// A scene file that holds this camera alone, by another name, for `include` or to copy from. It
// keeps the very numbers.
std::string CameraFileText(const Camera& camera, const std::string& name);

}  // namespace sheaf

#endif  // SHEAF_VIEW_SAVE_FILES_H_
