// POV-Ray 3.7 as a peer: scenes as it reads them, and its time and picture of one.
#ifndef SHEAF_LAB_POV_RAY_H_
#define SHEAF_LAB_POV_RAY_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// The scene through `camera`, which is a perspective one, as the twin of the crystal ball in
// tests/reference does it: highlights by half vector, Fresnel's split at glass, whose shadow is
// opaque, the depth limit of the scene's settings. Not exact: falloffs other than one of constant,
// linear and quadratic take the highest term alone; checkers are of quads,
// textures their factor alone, cones of lights and colours of vertices left out.
std::string PovText(const Scene& scene, const Camera& camera);

// Whether `povray` is on the path.
bool HasPovRay();

struct PovRender {
  double seconds = 0;  // of processor time that POV-Ray says it traced for, without parsing
  Film film;           // linear, 16 bits a channel; empty where no picture was asked for
};

enum class PovPicture { kNone, kRead };

// Renders PovText on one thread in a temporary folder. `antialiasing` is its command line's, such
// as "-A" or "+A0.3 +R3". kInputOutput where that fails.
Result<PovRender> RenderWithPovRay(const Scene& scene, const Camera& camera, int width, int height,
                                   const std::string& antialiasing, PovPicture picture);

}  // namespace sheaf

#endif  // SHEAF_LAB_POV_RAY_H_
