// Layers of a picture: their names on the command line, and their files.
#ifndef SHEAF_APP_LAYER_PICTURE_H_
#define SHEAF_APP_LAYER_PICTURE_H_

#include <optional>
#include <string>

#include "sheaf/film.h"

namespace sheaf {

// Names between commas: depth, normal, albedo, id, heat; each once.
std::optional<Layers> ParseLayers(const std::string& text);

// "out/front.png" becomes "out/front.depth.png". `path` has an ending that CheckPicturePath knows.
std::string LayerPath(const std::string& path, Layer layer);

}  // namespace sheaf

#endif  // SHEAF_APP_LAYER_PICTURE_H_
