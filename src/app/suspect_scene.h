// What a scene says and probably does not mean.
#ifndef SHEAF_APP_SUSPECT_SCENE_H_
#define SHEAF_APP_SUSPECT_SCENE_H_

#include <string>
#include <vector>

#include "sheaf/scene.h"

namespace sheaf {

// A line each: nothing lights the scene; colours that look like numbers of 0 to 255. It looks at
// materials and lights alone, so that it costs nothing beside a frame.
std::vector<std::string> SuspectScene(const Scene& scene);

}  // namespace sheaf

#endif  // SHEAF_APP_SUSPECT_SCENE_H_
