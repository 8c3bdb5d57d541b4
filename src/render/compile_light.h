// A scene's lights as kernels read them.
#ifndef SHEAF_RENDER_COMPILE_LIGHT_H_
#define SHEAF_RENDER_COMPILE_LIGHT_H_

#include "sheaf/scene.h"
#include "simd/shading.h"
#include "src/render/compile_geometry.h"
#include "src/render/place_scene.h"

namespace sheaf {

// `bounds` are those of what there is to be lit, placed.
template <typename Real>
LightData<Real> CompileLight(const Light& light, const Settings& settings,
                             const ScenePlacement& placement, const PointBounds& bounds);

// Makes a light that has a size give all of its light from its middle.
template <typename Real>
void ShrinkToMiddle(LightData<Real>& light);

}  // namespace sheaf

#endif  // SHEAF_RENDER_COMPILE_LIGHT_H_
