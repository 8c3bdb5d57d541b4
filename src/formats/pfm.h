// PFM, the portable float map: a text header, then rows of 32-bit floats from the bottom to the
// top.
#ifndef SHEAF_FORMATS_PFM_H_
#define SHEAF_FORMATS_PFM_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/formats.h"
#include "src/formats/picture_encoder.h"

namespace sheaf {

// Writes a little-endian colour map ("PF", scale -1) row by row; every bit of every float survives,
// NaN too. A row goes to its place in the file at once. Pipes and devices have no places: their
// rows are held, 12 bytes a pixel, until Finish(). kInputOutput where the path cannot be written.
NewEncoder CreatePfmEncoder(const std::string& path, const PictureSpec& spec);

// The whole film at once.
Status WritePfm(const Film& film, const std::string& path);

// Reads a colour map of either byte order. The scale's size is ignored, as most readers do.
// kInputOutput for an unreadable file, a malformed header, a side over kMaxImageSide, or a count of
// bytes that is not what the header promises.
Result<Film> ReadPfm(const std::string& path);
Result<ReadPictureResult> ReadPfmPicture(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PFM_H_
