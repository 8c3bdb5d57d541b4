// Layers of a film as colours that an eye can use.
#ifndef SHEAF_VIEW_SHOW_LAYER_H_
#define SHEAF_VIEW_SHOW_LAYER_H_

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// The rows of a layer as colours. A file of floats holds the numbers, one of bytes what an eye can
// use: depth from white at the camera to black at `far`, normals from [-1, 1] to [0, 1], objects in
// colours of their own.
enum class LayerLook { kNumbers, kDisplay };
Film ShowLayer(const Film& rows, Layer layer, LayerLook look, double far);

// The largest distance from the camera to what the scene holds.
double FarthestDepth(const Scene& scene, const Camera& camera);

}  // namespace sheaf

#endif  // SHEAF_VIEW_SHOW_LAYER_H_
