#include "src/app/layer_picture.h"

#include "src/app/choose.h"

namespace sheaf {

std::optional<Layers> ParseLayers(const std::string& text) {
  const auto names = ParseNames(text);
  if (!names) return std::nullopt;
  Layers layers;
  for (const std::string& name : *names) {
    int i = 0;
    while (i < kLayerCount && name != LayerName(static_cast<Layer>(i))) ++i;
    if (i == kLayerCount) return std::nullopt;
    layers.Add(static_cast<Layer>(i));
  }
  return layers;
}

std::string LayerPath(const std::string& path, Layer layer) {
  const std::size_t dot = path.rfind('.');
  return path.substr(0, dot) + "." + LayerName(layer) + path.substr(dot);
}

}  // namespace sheaf
