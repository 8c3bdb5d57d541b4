#include "sheaf/film.h"

namespace sheaf {

const char* LayerName(Layer layer) {
  static constexpr const char* kNames[] = {"depth", "normal", "albedo", "id", "heat"};
  return kNames[static_cast<int>(layer)];
}

}  // namespace sheaf
