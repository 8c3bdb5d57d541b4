#include "src/app/picture_as_read.h"

#include "src/app/choose.h"
#include "src/app/output_path.h"
#include "src/formats/picture.h"

namespace sheaf {

Status CheckWritten(const std::string& output, const std::string& format, const LookOptions& look,
                    std::optional<int> bits) {
  if (const Status known = CheckPictureOutput(output, format); !known) return known;
  const std::string named = FormatPath(output, format);
  if (const Status shown = CheckLook(look, named); !shown) return shown;
  return bits ? CheckPictureBits(named, *bits) : Status(Done{});
}

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
