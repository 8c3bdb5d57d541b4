// What the ending of a picture's path says of it.
#ifndef SHEAF_FORMATS_PICTURE_H_
#define SHEAF_FORMATS_PICTURE_H_

#include <string>

#include "sheaf/formats.h"

namespace sheaf {

// Whether a picture of this path holds floats, in linear light.
bool HoldsFloats(const std::string& path);

// Whether it holds layers beside the colours.
bool HoldsLayers(const std::string& path);

// Display values become light, where the file says how they are encoded.
void DecodeLight(ReadPictureResult& picture);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PICTURE_H_
