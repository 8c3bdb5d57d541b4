// OpenEXR pictures, where Sheaf was built with the library.
#ifndef SHEAF_FORMATS_EXR_H_
#define SHEAF_FORMATS_EXR_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/formats.h"
#include "src/formats/picture_encoder.h"

namespace sheaf {

// Without OpenEXR the functions below fail with kUsage.
bool IsExrBuiltIn();

// Writes a picture in tiles of 64 x 64, compressed by ZIP, row of tiles by row of tiles. Layers are
// channels: R, G, B, then depth.Z, normal.X, ..., albedo.R, ..., id.ID and heat.*. With
// `spec.bits` of 16 all but depth and id are halves, else floats. kInputOutput where the path
// cannot be written.
NewEncoder CreateExrEncoder(const std::string& path, const PictureSpec& spec);

// Reads R, G and B, or Y as grey, of any EXR of one part. kInputOutput for whatever is none.
Result<ReadPictureResult> ReadExr(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_EXR_H_
