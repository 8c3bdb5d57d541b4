// What a picture of a lone model needs: a camera that frames it, three lights, a ground under it.
#ifndef SHEAF_FORMATS_STUDIO_H_
#define SHEAF_FORMATS_STUDIO_H_

#include "sheaf/scene.h"

namespace sheaf {

// The camera "default": looks at the scene from the front, a little from the right and above, so
// that its outline just fits a picture that is `aspect` times as wide as high.
Camera CameraThatFrames(const Scene& scene, const Vec3d& up, double aspect);

// Adds a key, a fill and a rim light, the first of a scene, white ambient light and a gradient.
void AddStudio(Scene* scene);

// Turns these lights by the first camera: the key light over its left shoulder, a fill light from
// the right, a rim light from behind the model.
void AimStudio(Scene* scene);

// Adds a round floor that ends softly just below what the scene holds, for its shadow.
void AddGround(Scene* scene);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_STUDIO_H_
