// OpenEXR pictures, where Sheaf was built with the library.
#ifndef SHEAF_FORMATS_EXR_H_
#define SHEAF_FORMATS_EXR_H_

#include <memory>
#include <string>

#include "sheaf/error.h"
#include "src/formats/picture_spec.h"

namespace sheaf {

// Writes a picture in tiles of 64 x 64, compressed by ZIP, row of tiles by row of tiles. Layers are
// channels: R, G, B, then depth.Z, normal.X, ..., albedo.R, ..., id.ID and heat.*. With
// `spec.bits` of 16 all but depth and id are halves, else floats. Without a Finish() the file does
// not appear, and one that was there stays.
class ExrWriter {
 public:
  // kUsage where Sheaf was built without OpenEXR; kInputOutput where the path cannot be written.
  static Result<ExrWriter> Create(const std::string& path, const PictureSpec& spec);
  ExrWriter(ExrWriter&&) noexcept;
  ~ExrWriter();

  // The next rows from the top, with the layers of the spec. After an error the only call left is
  // the destructor.
  Status WriteRows(const Film& rows);
  // Once, after all rows.
  Status Finish();

 private:
  class Encoder;
  explicit ExrWriter(std::unique_ptr<Encoder> encoder);

  std::unique_ptr<Encoder> encoder_;
};

// Reads R, G and B, or Y as grey, of any EXR of one part. kInputOutput for whatever is none.
Result<ReadPictureResult> ReadExr(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_EXR_H_
