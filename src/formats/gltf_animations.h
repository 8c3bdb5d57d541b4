// The animations of a glTF file at one moment (glTF 2.0, 3.11).
#ifndef SHEAF_FORMATS_GLTF_ANIMATIONS_H_
#define SHEAF_FORMATS_GLTF_ANIMATIONS_H_

#include <optional>
#include <string>

#include "src/formats/gltf_document.h"

namespace sheaf {

// Which animations count, and when.
struct GltfMoment {
  std::optional<double> time;  // seconds; absent: the nodes stay at rest
  std::string animation;       // by name; empty: all
};

// Gives the nodes of the document the translations, rotations, scales and weights that they have at
// the moment, and tells the document's files how long each animation takes. Before its first key
// and after its last a channel has that key's value. Of two animations that move one property of a
// node the first counts. False with a fault.
bool ApplyAnimations(GltfDocument& document, const GltfMoment& moment);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_ANIMATIONS_H_
