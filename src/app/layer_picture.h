// Layers of a picture as pictures of their own.
#ifndef SHEAF_APP_LAYER_PICTURE_H_
#define SHEAF_APP_LAYER_PICTURE_H_

#include <optional>
#include <string>

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// Names between commas: depth, normal, albedo, id, heat; each once.
std::optional<Layers> ParseLayers(const std::string& text);

// "out/front.png" becomes "out/front.depth.png". `path` has an ending that CheckPicturePath knows.
std::string LayerPath(const std::string& path, Layer layer);

// The rows of a layer as colours. A file of floats holds the numbers, one of bytes what an eye can
// use: depth from white at the camera to black at `far`, normals from [-1, 1] to [0, 1], objects in
// colours of their own.
enum class LayerLook { kNumbers, kDisplay };
Film ShowLayer(const Film& rows, Layer layer, LayerLook look, double far);

// The largest distance from the camera to what the scene holds.
double FarthestDepth(const Scene& scene, const Camera& camera);

}  // namespace sheaf

#endif  // SHEAF_APP_LAYER_PICTURE_H_
