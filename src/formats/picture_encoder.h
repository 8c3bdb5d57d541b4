// What turns rows of a film into the bytes of a picture file.
#ifndef SHEAF_FORMATS_PICTURE_ENCODER_H_
#define SHEAF_FORMATS_PICTURE_ENCODER_H_

#include <memory>

#include "sheaf/error.h"
#include "sheaf/film.h"

namespace sheaf {

// One file in work; PictureWriter states the contract. Each format exports a factory alone.
class PictureEncoder {
 public:
  PictureEncoder() = default;
  PictureEncoder(const PictureEncoder&) = delete;
  PictureEncoder& operator=(const PictureEncoder&) = delete;
  virtual ~PictureEncoder() = default;

  virtual Status WriteRows(const Film& rows) = 0;
  virtual Status Finish() = 0;
};

using NewEncoder = Result<std::unique_ptr<PictureEncoder>>;

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PICTURE_ENCODER_H_
