// POV-Ray 3.7 as a peer: writes scenes in its language, runs it, reads its time and picture.
#ifndef SHEAF_LAB_POV_RAY_H_
#define SHEAF_LAB_POV_RAY_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// The scene in POV-Ray's language, seen through `camera`, which is a perspective one. It is written
// as tests/reference/crystal-ball.pov is: highlights by half vector, Fresnel's split at glass,
// opaque shadows of glass, the depth limit of the scene's settings. Not exact: a falloff keeps its
// highest term alone, a texture its factor alone; only quads have checkers; cones of lights and
// colours of vertices are left out. So are instances: Flattened of src/scene/placed_groups.h first.
std::string PovText(const Scene& scene, const Camera& camera);

// Whether `povray` is on the path.
bool HasPovRay();

struct PovRender {
  double seconds = 0;  // processor time of tracing, as POV-Ray reports it; parsing is not in it
  Film film;           // linear, 16 bits a channel; empty where no picture was asked for
};

enum class PovPicture { kNone, kRead };

// Renders PovText on one thread, in a temporary folder. `antialiasing` is POV-Ray's option, such as
// "-A" or "+A0.3 +R3". Fails as Flattened does, and returns kInputOutput where POV-Ray fails.
Result<PovRender> RenderWithPovRay(const Scene& scene, const Camera& camera, int width, int height,
                                   const std::string& antialiasing, PovPicture picture);

}  // namespace sheaf

#endif  // SHEAF_LAB_POV_RAY_H_
