#include "src/formats/png_reader.h"

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

#include "src/formats/read_file.h"

namespace sheaf {

void OnPngError(png_structp png, png_const_charp message) {
  auto* complaint = static_cast<PngComplaint*>(png_get_error_ptr(png));
  std::snprintf(complaint->text, sizeof(complaint->text), "%s", message);
  png_longjmp(png, 1);
}

void OnPngWarning(png_structp, png_const_charp) {}

// Before each block its size, and padding that keeps the block aligned.
constexpr std::size_t kBlockHeader = alignof(std::max_align_t);
static_assert(kBlockHeader >= sizeof(std::size_t));

png_voidp PngHeap::Allocate(png_structp png, png_alloc_size_t bytes) {
  auto* heap = static_cast<PngHeap*>(png_get_mem_ptr(png));
  if (bytes > heap->most_ - std::min(heap->used_, heap->most_)) {
    heap->is_beyond_most_ = true;
    return nullptr;
  }
  void* const block = std::malloc(kBlockHeader + bytes);
  if (block == nullptr) {
    heap->is_exhausted_ = true;
    return nullptr;
  }
  heap->used_ += bytes;
  std::memcpy(block, &bytes, sizeof bytes);
  return static_cast<char*>(block) + kBlockHeader;
}

void PngHeap::Free(png_structp png, png_voidp memory) {
  if (memory == nullptr) return;
  void* const block = static_cast<char*>(memory) - kBlockHeader;
  std::size_t bytes;
  std::memcpy(&bytes, block, sizeof bytes);
  static_cast<PngHeap*>(png_get_mem_ptr(png))->used_ -= bytes;
  std::free(block);
}

void PngHeap::Explain(PngComplaint* complaint) const {
  if (is_exhausted_) throw std::bad_alloc();
  if (!is_beyond_most_) return;
  std::snprintf(complaint->text, sizeof(complaint->text),
                "its chunks claim more than the %zu MiB that a file of its size may take",
                most_ >> 20);
}

PngReader::PngReader()
    : png_(png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &complaint, &OnPngError, &OnPngWarning,
                                    &heap_, &PngHeap::Allocate, &PngHeap::Free)) {
  if (png_ != nullptr) info_ = png_create_info_struct(png_);
  if (info_ != nullptr) return;
  png_destroy_read_struct(&png_, nullptr, nullptr);
  throw std::bad_alloc();  // nothing else can be missing
}

PngReader::~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }

bool PngReader::Explained(bool succeeded) {
  if (!succeeded) heap_.Explain(&complaint);
  return succeeded;
}

bool PngReader::ReadHeader(std::FILE* file, std::size_t file_bytes, PngPixels pixels) {
  heap_.SetMost(MostMemoryFor(file_bytes));
  png_init_io(png_, file);
  return Explained(ReadInfo(pixels));
}

bool PngReader::ReadHeader(std::string_view bytes, PngPixels pixels) {
  heap_.SetMost(MostMemoryFor(bytes.size()));
  bytes_ = bytes;
  png_set_read_fn(png_, this, &ReadBytes);
  return Explained(ReadInfo(pixels));
}

void PngReader::ReadBytes(png_structp png, png_bytep to, std::size_t count) {
  auto* reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (reader->bytes_.size() < count) png_error(png, "read beyond end of data");
  std::memcpy(to, reader->bytes_.data(), count);
  reader->bytes_.remove_prefix(count);
}

bool PngReader::ReadInfo(PngPixels pixels) {
  if (setjmp(png_jmpbuf(png_))) return false;
  png_set_user_limits(png_, kMaxImageSide, kMaxImageSide);
  png_read_info(png_, info_);
  png_set_expand(png_);
  const bool has_16 = png_get_bit_depth(png_, info_) == 16;
  bits = has_16 && pixels == PngPixels::kRgb8Or16 ? 16 : 8;
  if (bits == 8) png_set_scale_16(png_);
  int intent = 0;
  is_srgb = png_get_sRGB(png_, info_, &intent) != 0;
  png_fixed_point gamma = 0;
  is_linear = !is_srgb && png_get_gAMA_fixed(png_, info_, &gamma) != 0 && gamma == PNG_FP_1;
  int unit = 0;
  png_int_32 x = 0, y = 0;
  if (png_get_oFFs(png_, info_, &x, &y, &unit) && unit == PNG_OFFSET_PIXEL) {
    offset_x = x, offset_y = y;
  }
  png_textp texts = nullptr;
  const int text_count = png_get_text(png_, info_, &texts, nullptr);
  for (int i = 0; i < text_count; ++i) {
    if (std::strcmp(texts[i].key, kPngSizeKey) == 0) {
      std::sscanf(texts[i].text, "%dx%d", &full_width, &full_height);
    }
    for (const char* key : kMetadataKeys) {
      if (std::strcmp(texts[i].key, key) == 0) metadata.emplace_back(key, texts[i].text);
    }
  }
  if (pixels == PngPixels::kRgba8) {
    png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
  } else {
    png_set_strip_alpha(png_);
  }
  png_set_gray_to_rgb(png_);
  png_set_interlace_handling(png_);
  png_read_update_info(png_, info_);
  width = static_cast<int>(png_get_image_width(png_, info_));
  height = static_cast<int>(png_get_image_height(png_, info_));
  row_bytes = png_get_rowbytes(png_, info_);
  return true;
}

bool PngReader::ReadRows(std::uint8_t* rows) {
  std::vector<png_bytep> starts(static_cast<std::size_t>(height));
  for (png_bytep& start : starts) {
    start = rows;
    rows += row_bytes;
  }
  return Explained(ReadImage(starts.data()));
}

bool PngReader::ReadImage(png_bytepp rows) {
  if (setjmp(png_jmpbuf(png_))) return false;
  png_read_image(png_, rows);
  png_read_end(png_, nullptr);
  return true;
}

}  // namespace sheaf
