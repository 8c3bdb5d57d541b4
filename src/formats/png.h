// PNG, 8 bits a channel.
#ifndef SHEAF_FORMATS_PNG_H_
#define SHEAF_FORMATS_PNG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "src/core/error.h"
#include "src/scene/scene.h"

namespace sheaf {

// An 8-bit picture as it lies in the file: no gamma applied.
struct Picture8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height, interleaved, rows from the top
};

// `transfer` is recorded in the file and changes no pixel; a linear picture carries no such record,
// because viewers would brighten it.
Status WritePng(const Picture8& picture, Transfer transfer, const std::string& path);

// Reads any PNG as RGB: grey is spread, palettes looked up, 16 bits rounded to 8, alpha dropped.
// kInputOutput for whatever is not a sound PNG with sides up to kMaxImageSide.
Result<Picture8> ReadPng(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PNG_H_
