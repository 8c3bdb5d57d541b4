// PFM, the portable float map: a text header, then rows of 32-bit floats from the bottom to the
// top.
#ifndef SHEAF_FORMATS_PFM_H_
#define SHEAF_FORMATS_PFM_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "src/core/atomic_file.h"

namespace sheaf {

// Writes a little-endian colour map ("PF", scale -1) row by row; every bit of every float survives,
// NaN too. A row goes to its place in the file at once. Pipes and devices have no places: their
// rows are held, 12 bytes a pixel, until Finish(). Without a Finish() the file does not appear, and
// one that was there stays.
class PfmWriter {
 public:
  // Sides in [1, kMaxImageSide]. kInputOutput where the path cannot be written.
  static Result<PfmWriter> Create(const std::string& path, int width, int height);

  // The next row from the top: 3 * width floats. After an error the only call left is the
  // destructor.
  Status WriteRow(const float* rgb);
  // Once, after all rows.
  Status Finish();

 private:
  PfmWriter(AtomicFile file, std::size_t header_bytes, int width, int height);

  AtomicFile file_;
  std::size_t header_bytes_, row_bytes_;
  std::size_t rows_left_;
  std::vector<std::uint8_t> held_;  // empty where the file is seekable
};

// The whole film through a PfmWriter.
Status WritePfm(const Film& film, const std::string& path);

// Reads a colour map of either byte order. The scale's size is ignored, as most readers do.
// kInputOutput for an unreadable file, a malformed header, a side over kMaxImageSide, or a count of
// bytes that is not what the header promises.
Result<Film> ReadPfm(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PFM_H_
