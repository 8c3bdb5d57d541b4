// PNG, 8 or 16 bits a channel.
#ifndef SHEAF_FORMATS_PNG_H_
#define SHEAF_FORMATS_PNG_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/picture_spec.h"

namespace sheaf {

// An 8-bit picture as it lies in the file: no gamma applied.
struct Picture8 {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // 3 * width * height, interleaved, rows from the top
};

// Writes a picture of `spec.bits` of 8 or 16 row by row. `transfer` is recorded in the file and
// changes no pixel; a linear picture carries no such record, because viewers would brighten it.
// Without a Finish() the file does not appear, and one that was there stays.
class PngWriter {
 public:
  // Sides in [1, kMaxImageSide]. kInputOutput where the path cannot be written.
  static Result<PngWriter> Create(const std::string& path, const PictureSpec& spec);
  PngWriter(PngWriter&&) noexcept;
  ~PngWriter();

  // The next row from the top: 3 * width bytes, or pairs of them, the higher first. After an error
  // the only call left is the destructor.
  Status WriteRow(const std::uint8_t* rgb);
  // Once, after all rows.
  Status Finish();

 private:
  class Encoder;
  explicit PngWriter(std::unique_ptr<Encoder> encoder);

  std::unique_ptr<Encoder> encoder_;
};

// The whole picture through a PngWriter.
Status WritePng(const Picture8& picture, Transfer transfer, const std::string& path);

// Reads any PNG as RGB: grey is spread, palettes looked up, 16 bits rounded to 8, alpha dropped.
// kInputOutput for whatever is not a sound PNG with sides up to kMaxImageSide.
Result<Picture8> ReadPng(const std::string& path);

// The same as floats, value / 255 or value / 65535, with what the file says of itself.
Result<ReadPictureResult> ReadPngFilm(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PNG_H_
