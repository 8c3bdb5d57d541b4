// Writes finished pictures. A file appears whole or not at all: a temporary beside it, then a
// rename.
#ifndef SHEAF_FORMATS_PICTURE_H_
#define SHEAF_FORMATS_PICTURE_H_

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"
#include "src/formats/exr.h"
#include "src/formats/pfm.h"
#include "src/formats/picture_spec.h"
#include "src/formats/png.h"

namespace sheaf {

// Clamps to [0, 1] (NaN becomes 0), encodes, multiplies by 255 and rounds to nearest.
// Returns 3 * width * height bytes, interleaved, rows from the top.
std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer);

// Whether WritePicture knows the ending of this path (.png, .pfm, .exr, any case); an error lists
// them.
Status CheckPicturePath(const std::string& path);

// Whether a picture of this path holds floats, in linear light (.pfm, .exr).
bool HoldsFloats(const std::string& path);

// Whether it holds layers beside the colours (.exr).
bool HoldsLayers(const std::string& path);

// Whether it can have this many bits a channel: .png 8 or 16, .exr 16 or 32, .pfm 32.
Status CheckPictureBits(const std::string& path, int bits);

// Writes a picture whose rows come in turn, by the path's ending: .png, .pfm (little-endian float,
// linear, untouched bits) or .exr. No more than a row is kept, but of a .pfm that is
// a pipe or a device. Without a Finish() the file does not appear, and one that was there stays.
class PictureWriter {
 public:
  // Sides in [1, kMaxImageSide]. kUsage for an unknown ending; kInputOutput where the path cannot
  // be written.
  static Result<PictureWriter> Create(const std::string& path, const PictureSpec& spec);
  static Result<PictureWriter> Create(const std::string& path, int width, int height,
                                      Transfer transfer);

  // The next rows from the top, as wide as the picture. After an error the only call left is the
  // destructor.
  Status WriteRows(const Film& rows);
  // Once, after all rows.
  Status Finish();

 private:
  using Writer = std::variant<PngWriter, PfmWriter, ExrWriter>;
  PictureWriter(Writer writer, const PictureSpec& spec)
      : writer_(std::move(writer)),
        transfer_(spec.values == Values::kLight ? spec.transfer : Transfer::kLinear),
        bits_(spec.bits) {}

  Writer writer_;
  Transfer transfer_;
  int bits_;
  std::vector<std::uint8_t> row_;  // quantised
};

// Reads a .png (values of 0 to 1, as they lie in the file), a .pfm or an .exr.
Result<ReadPictureResult> ReadPicture(const std::string& path);

// The whole film through a PictureWriter.
Status WritePicture(const Film& film, Transfer transfer, const std::string& path);
Status WritePicture(const Film& film, const PictureSpec& spec, const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PICTURE_H_
