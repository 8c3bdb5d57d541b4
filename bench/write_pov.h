// Scenes as POV-Ray 3.7 reads them, so that it can be timed on the same ones.
#ifndef SHEAF_BENCH_WRITE_POV_H_
#define SHEAF_BENCH_WRITE_POV_H_

#include <string>

#include "src/scene/scene.h"

namespace sheaf::bench {

// The scene through `camera` (perspective), as the twin of the crystal ball in tests/reference does
// it: highlights by half vector, Fresnel's split at glass, whose shadow is opaque, depth limit of
// the scene's settings. Not exact: falloffs other than one of constant, linear and quadratic take
// the highest term alone; checkers are of quads.
std::string PovText(const Scene& scene, const Camera& camera);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_WRITE_POV_H_
