// The numbers of a glTF file: accessors over views of buffers.
#ifndef SHEAF_FORMATS_GLTF_ACCESSORS_H_
#define SHEAF_FORMATS_GLTF_ACCESSORS_H_

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/formats/gltf_document.h"

namespace sheaf {

// The elements of an accessor, one after another.
struct GltfNumbers {
  std::size_t components = 1;  // of an element
  std::vector<double> values;

  std::size_t count() const { return values.size() / components; }
};

// All numbers of an accessor whose elements have `low` to `high` components. Nothing, and a fault
// in the document, where it reaches beyond its buffer or is malformed.
std::optional<GltfNumbers> ReadAccessor(GltfDocument& document, int index, int low, int high);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_GLTF_ACCESSORS_H_
