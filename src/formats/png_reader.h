// Reads PNGs through libpng: pictures from files, textures from memory.
#ifndef SHEAF_FORMATS_PNG_READER_H_
#define SHEAF_FORMATS_PNG_READER_H_

#include <png.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string_view>

#include "sheaf/formats.h"

namespace sheaf {

// libpng reports an error by longjmp, which runs no destructor. So every function that may be
// jumped out of holds only trivial locals; what owns memory lives in its caller.

// Where libpng leaves its last words: the pointer to give with OnPngError.
struct PngComplaint {
  char text[200] = "";
};
[[noreturn]] void OnPngError(png_structp png, png_const_charp message);
void OnPngWarning(png_structp png, png_const_charp message);

// What libpng allocates: the pointer to give with its two functions. Chunks may claim gigabytes
// that a file does not have, or pack them a thousandfold.
class PngHeap {
 public:
  // At most so much at a time.
  void SetMost(std::size_t bytes) { most_ = bytes; }
  // After libpng failed: throws std::bad_alloc where that was for want of memory, and names the
  // limit where it was for that.
  void Explain(PngComplaint* complaint) const;

  static png_voidp Allocate(png_structp png, png_alloc_size_t bytes);
  static void Free(png_structp png, png_voidp memory);

 private:
  std::size_t used_ = 0, most_ = PNG_SIZE_MAX;
  bool is_exhausted_ = false, is_beyond_most_ = false;
};

// Of the whole picture, in the file of a part.
inline constexpr char kPngSizeKey[] = "sheaf:size";

// What pixels are read as. Grey is spread, palettes are looked up, 16 bits are rounded to 8 where
// only 8 are asked for. No gamma is applied, whatever the file says of itself.
enum class PngPixels { kRgb8, kRgb8Or16, kRgba8 };

// One file or picture each.
class PngReader {
 public:
  PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader();

  // Reads up to the pixels. False: see `complaint`. `file` or `bytes` outlives ReadRows.
  // `file_bytes` is the size of the file, by which what its chunks may take is limited.
  bool ReadHeader(std::FILE* file, std::size_t file_bytes, PngPixels pixels);
  bool ReadHeader(std::string_view bytes, PngPixels pixels);

  // Reads the rest, `height` rows of `row_bytes` at a time, one after the other.
  bool ReadRows(std::uint8_t* rows);

  PngComplaint complaint;  // in a few plain words; never empty after a failure
  int width = 0, height = 0, bits = 8;
  bool is_srgb = false, is_linear = false;
  int offset_x = 0, offset_y = 0, full_width = 0, full_height = 0;
  std::size_t row_bytes = 0;
  PictureMetadata metadata;

 private:
  bool Explained(bool succeeded);
  static void ReadBytes(png_structp png, png_bytep to, std::size_t count);
  bool ReadInfo(PngPixels pixels);
  bool ReadImage(png_bytepp rows);

  std::string_view bytes_;  // not yet read
  PngHeap heap_;
  png_structp png_;
  png_infop info_ = nullptr;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PNG_READER_H_
