#include "src/app/picture_as_read.h"

#include "src/formats/picture.h"

namespace sheaf {

PictureSpec SpecAsRead(const ReadPictureResult& picture, const std::string& named,
                       std::optional<int> bits, const std::string& transfer) {
  PictureSpec spec = WholePicture(picture.film.width, picture.film.height, Transfer::kLinear);
  if (picture.window.width() > 0) {
    spec.window = picture.window;
    spec.full_width = picture.full_width;
    spec.full_height = picture.full_height;
  }
  spec.metadata = picture.metadata;
  const bool is_same_kind = picture.is_display != HoldsFloats(named);
  const bool keeps_bits = is_same_kind && CheckPictureBits(named, picture.bits).ok();
  spec.bits = bits.value_or(keeps_bits ? picture.bits : 0);
  const bool keeps = transfer.empty() || transfer == "keep";
  if (transfer == "srgb" || (keeps && picture.is_srgb)) spec.transfer = Transfer::kSrgb;
  return spec;
}

}  // namespace sheaf
