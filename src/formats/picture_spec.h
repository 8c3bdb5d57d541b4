// What a picture file is asked to be, and what one turned out to be.
#ifndef SHEAF_FORMATS_PICTURE_SPEC_H_
#define SHEAF_FORMATS_PICTURE_SPEC_H_

#include <string>
#include <utility>
#include <vector>

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

using PictureMetadata = std::vector<std::pair<std::string, std::string>>;  // UTF-8

// What a picture says of its origin: text chunks of a .png, attributes of an .exr. Of what readers
// find they keep these.
inline constexpr const char* kMetadataKeys[] = {"Scene", "Camera", "Settings"};

// What the values of a film are that is written: light, or what a .png holds already.
enum class Values { kLight, kEncoded };

struct PictureSpec {
  // The part of a picture of full_width x full_height that the file holds.
  PixelRect window;
  int full_width = 0, full_height = 0;
  Transfer transfer = Transfer::kLinear;  // of a .png
  Values values = Values::kLight;
  int bits = 0;              // a channel; 0: 8 of .png, 32 of others
  Layers layers;             // of .exr alone
  PictureMetadata metadata;  // of .png and .exr alone

  bool is_whole() const {
    return window.x0 == 0 && window.y0 == 0 && window.x1 == full_width && window.y1 == full_height;
  }
};

inline PictureSpec WholePicture(int width, int height, Transfer transfer) {
  PictureSpec spec;
  spec.window = {0, 0, width, height};
  spec.full_width = width;
  spec.full_height = height;
  spec.transfer = transfer;
  return spec;
}

struct ReadPictureResult {
  Film film;
  bool is_display = false;  // whether the values are encoded for a display: those of a .png
  int bits = 32;
  bool is_srgb = false;  // whether a .png says that its encoding is sRGB
  // Which part of a picture it is; an empty window where the format cannot say it (.pfm).
  PixelRect window;
  int full_width = 0, full_height = 0;
  PictureMetadata metadata;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PICTURE_SPEC_H_
