// Pictures that are neither PNG nor JPEG: BMP, TGA, TIFF, WebP, Radiance HDR and OpenEXR, by
// OpenImageIO, where Sheaf was built with it.
#ifndef SHEAF_FORMATS_OTHER_IMAGES_H_
#define SHEAF_FORMATS_OTHER_IMAGES_H_

#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"

namespace sheaf {

// What `bytes` are by how they begin, as "a BMP"; null where they are of no format of these. Known
// without OpenImageIO too.
const char* OtherImageKind(std::string_view bytes);

// In 8 bits; light, of HDR and OpenEXR, is encoded as sRGB, and above 1 it is white. Errors name no
// file; without OpenImageIO any call is one.
Result<Image> DecodeOtherImage(std::string_view bytes);

// In linear light: of HDR and OpenEXR the numbers themselves, of others decoded from sRGB.
Result<FloatImage> DecodeOtherLight(std::string_view bytes);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_OTHER_IMAGES_H_
