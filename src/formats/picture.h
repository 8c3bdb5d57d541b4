// Writes finished pictures. A file appears whole or not at all: a temporary beside it, then a
// rename.
#ifndef SHEAF_FORMATS_PICTURE_H_
#define SHEAF_FORMATS_PICTURE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "src/core/error.h"
#include "src/scene/film.h"
#include "src/scene/scene.h"

namespace sheaf {

// Clamps to [0, 1] (NaN becomes 0), encodes, multiplies by 255 and rounds to nearest.
// Returns 3 * width * height bytes, interleaved, rows from the top.
std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer);

// Whether WritePicture knows the ending of this path (.png, .pfm, any case); an error lists them.
Status CheckPicturePath(const std::string& path);

// Writes by the path's ending: .png (8 bit) or .pfm (little-endian float, linear, untouched bits).
Status WritePicture(const Film& film, Transfer transfer, const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PICTURE_H_
