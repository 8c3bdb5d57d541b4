// The module that reads further formats of images: a library of its own, which is loaded with the
// first such image. OpenImageIO brings 250 libraries, which take a third of a second and 130 MB;
// who has no such image does not pay for them.
#ifndef SHEAF_FORMATS_IMAGE_MODULE_H_
#define SHEAF_FORMATS_IMAGE_MODULE_H_

#include <cstddef>
#include <string>
#include <vector>

namespace sheaf {

struct ModuleImage {
  int width = 0, height = 0, channels = 0;
  int alpha = -1;              // the channel that is alpha; negative: none
  std::vector<float> numbers;  // channels * width * height; bytes are shares of 255
  std::string error;
};

// Reads `size` bytes of the format that goes by `ending`, as "bmp"; false with an error otherwise,
// and where a side is above `largest_side`. Module and library are built together, so that they
// share types.
using DecodeByModule = bool(const char* bytes, std::size_t size, const char* ending,
                            int largest_side, ModuleImage& image);
inline constexpr const char* kDecodeByModule = "SheafDecodeImage";

}  // namespace sheaf

#endif  // SHEAF_FORMATS_IMAGE_MODULE_H_
