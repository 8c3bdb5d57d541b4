// What the bytes of a picture mean.
#ifndef SHEAF_SCENE_DECODE_TABLE_H_
#define SHEAF_SCENE_DECODE_TABLE_H_

#include <vector>

#include "sheaf/scene.h"
#include "src/scene/srgb.h"

namespace sheaf {

// Linear light by byte.
template <typename Real>
std::vector<Real> DecodeTable(Transfer transfer) {
  std::vector<Real> table;
  for (int byte = 0; byte < 256; ++byte) {
    const double share = byte / 255.0;
    table.push_back(static_cast<Real>(transfer == Transfer::kSrgb ? SrgbDecode(share) : share));
  }
  return table;
}

}  // namespace sheaf

#endif  // SHEAF_SCENE_DECODE_TABLE_H_
