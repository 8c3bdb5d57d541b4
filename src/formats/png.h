// PNG, 8 or 16 bits a channel.
#ifndef SHEAF_FORMATS_PNG_H_
#define SHEAF_FORMATS_PNG_H_

#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "sheaf/scene.h"
#include "src/formats/picture_encoder.h"

namespace sheaf {

// An 8-bit picture as it lies in the file: no gamma applied.
struct Picture8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // channels * width * height, interleaved, rows from the top
  int channels = 3;               // or 4, with alpha; read pictures have 3
};

// Writes a picture of 8 or 16 bits a channel row by row. Its transfer is recorded in the file: an
// sRGB chunk, or a gAMA chunk of 1 where it is linear, so that viewers brighten it; neither for
// Values::kNumbers. kInputOutput where the path cannot be written.
NewEncoder CreatePngEncoder(const std::string& path, const PictureSpec& spec);

// Writes a whole picture. `transfer` is recorded in the file and changes no pixel.
Status WritePng(const Picture8& picture, Transfer transfer, const std::string& path);

// Reads any PNG as RGB: grey is spread, palettes looked up, 16 bits rounded to 8, alpha dropped.
// kInputOutput for whatever is not a sound PNG with sides up to kMaxImageSide.
Result<Picture8> ReadPng(const std::string& path);

// The same as floats, value / 255 or value / 65535, with what the file says of itself.
Result<ReadPictureResult> ReadPngFilm(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PNG_H_
