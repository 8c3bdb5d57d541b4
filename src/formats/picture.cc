#include "src/formats/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "src/formats/format_table.h"
#include "src/formats/printable.h"
#include "src/scene/develop.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

const FormatRow* PictureFormat(const std::string& path) {
  const FormatRow* row = FindFormat(path);
  return row != nullptr && row->format.content == FileContent::kPicture ? row : nullptr;
}

Error UnknownFormat(const std::string& path) {
  return {ErrorKind::kUsage, fmt::format("{}: unknown picture format; the name must end in {}",
                                         PrintablePath(path), PictureEndings())};
}

}  // namespace

PictureSpec WholePicture(int width, int height, Transfer transfer) {
  PictureSpec spec;
  spec.window = {0, 0, width, height};
  spec.full_width = width;
  spec.full_height = height;
  spec.transfer = transfer;
  return spec;
}

Status CheckPicturePath(const std::string& path) {
  if (PictureFormat(path) == nullptr) return UnknownFormat(path);
  return Done{};
}

bool HoldsFloats(const std::string& path) {
  const FormatRow* row = PictureFormat(path);
  return row != nullptr && row->format.holds_floats;
}

bool HoldsLayers(const std::string& path) {
  const FormatRow* row = PictureFormat(path);
  return row != nullptr && row->format.holds_layers;
}

Status CheckPictureBits(const std::string& path, int bits) {
  const FormatRow* row = PictureFormat(path);
  if (row == nullptr) return UnknownFormat(path);
  const std::vector<int>& known = row->format.bits;
  if (std::find(known.begin(), known.end(), bits) != known.end()) return Done{};
  return Error{ErrorKind::kUsage,
               fmt::format("{}: {} bits a channel; there are {}", path, bits, BitsText())};
}

Result<PictureWriter> PictureWriter::Create(const std::string& path, int width, int height,
                                            Transfer transfer) {
  return Create(path, WholePicture(width, height, transfer));
}

Result<PictureWriter> PictureWriter::Create(const std::string& path, const PictureSpec& spec) {
  const std::string named = spec.format.empty() ? path : "." + spec.format;
  const FormatRow* row = PictureFormat(named);
  if (row == nullptr) return UnknownFormat(named);
  if (spec.bits != 0) {
    if (const Status fits = CheckPictureBits(named, spec.bits); !fits) return fits.error();
  }
  NewEncoder encoder = row->create_encoder(path, spec);
  if (!encoder) return encoder.error();
  const bool is_developed = !row->format.holds_floats && spec.values == Values::kLight;
  return is_developed ? PictureWriter(std::move(encoder).value(), spec.ev, spec.tone)
                      : PictureWriter(std::move(encoder).value(), 0, Tone::kLinear);
}

namespace {
Error MovedFrom() { return {ErrorKind::kUsage, "a picture writer that was moved from"}; }
}  // namespace

PictureWriter::PictureWriter(std::unique_ptr<PictureEncoder> encoder, double ev, Tone tone)
    : encoder_(std::move(encoder)), ev_(ev), tone_(tone) {}
PictureWriter::PictureWriter(PictureWriter&&) noexcept = default;
PictureWriter& PictureWriter::operator=(PictureWriter&&) noexcept = default;
PictureWriter::~PictureWriter() = default;

Status PictureWriter::WriteRows(const Film& rows) {
  if (!encoder_) return MovedFrom();
  if (ev_ == 0 && tone_ == Tone::kLinear) return encoder_->WriteRows(rows);
  Film developed = rows;
  Develop(ev_, tone_, developed);
  return encoder_->WriteRows(developed);
}
Status PictureWriter::Finish() { return encoder_ ? encoder_->Finish() : MovedFrom(); }

Status WritePicture(const Film& film, Transfer transfer, const std::string& path) {
  return WritePicture(film, WholePicture(film.width, film.height, transfer), path);
}

Status WritePicture(const Film& film, const PictureSpec& spec, const std::string& path) {
  Result<PictureWriter> writer = PictureWriter::Create(path, spec);
  if (!writer) return writer.error();
  const Status written = writer.value().WriteRows(film);
  return written ? writer.value().Finish() : written;
}

Result<ReadPictureResult> ReadPicture(const std::string& path) {
  const FormatRow* row = PictureFormat(path);
  return row == nullptr ? UnknownFormat(path) : row->read_picture(path);
}

void DecodeLight(ReadPictureResult& picture) {
  if (picture.is_display && picture.is_srgb) {
    for (float& value : picture.film.rgb) {
      value = static_cast<float>(SrgbDecode(static_cast<double>(value)));
    }
  }
  picture.is_display = false;
}

}  // namespace sheaf
