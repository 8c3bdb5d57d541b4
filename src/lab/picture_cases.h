// What cases that render pictures share: small scenes, and films that every target agrees on.
#ifndef SHEAF_LAB_PICTURE_CASES_H_
#define SHEAF_LAB_PICTURE_CASES_H_

#include <cstdint>

#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/lab/stress.h"

namespace sheaf::stress {

// The film by the scalar baseline; `report` learns where a target has other bits, and of pixels
// that are not finite.
Film RenderEverywhere(Report& report, const Scene& scene, RenderOptions options);

// 40 x 30 pixels, to the scene's depth.
RenderOptions Small(const Scene& scene);
Film RenderSmall(Report& report, const Scene& scene);

// A camera at the origin that looks along -z, before a grey background.
Scene NewScene();
Material Matt();
Material Glass(double ior);
Light LampAt(const Vec3d& position);
// A closed convex ball of triangles with the normals of a sphere. The fewer rings, the less round.
Mesh SmoothBall(std::uint32_t rings);

void ExpectUniform(Report& report, const Film& film, double low, double high);

}  // namespace sheaf::stress

#endif  // SHEAF_LAB_PICTURE_CASES_H_
