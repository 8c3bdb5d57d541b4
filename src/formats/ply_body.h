// The numbers behind the header of a PLY.
#ifndef SHEAF_FORMATS_PLY_BODY_H_
#define SHEAF_FORMATS_PLY_BODY_H_

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "src/formats/ply_header.h"
#include "src/formats/text_scanner.h"

namespace sheaf {

// Numbers of the body, one after another.
class PlyBody {
 public:
  explicit PlyBody(const PlyHeader& header)
      : rest_(header.body),
        encoding_(header.encoding),
        line_end_(header.line_end),
        line_(header.body_line) {}

  std::size_t line() const { return line_; }
  bool is_text() const { return encoding_ == PlyEncoding::kAscii; }
  bool is_at_end() const { return rest_.empty(); }

  // False where the body ends or holds no number of this type.
  bool Read(PlyType type, double* out) {
    if (is_text()) return ReadWord(out);
    constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    const std::size_t size = kBytes[static_cast<int>(type)];
    if (rest_.size() < size) return false;
    unsigned char bytes[8];
    std::memcpy(bytes, rest_.data(), size);
    rest_.remove_prefix(size);
    if ((encoding_ == PlyEncoding::kLittle) != (std::endian::native == std::endian::little)) {
      std::reverse(bytes, bytes + size);
    }
    *out = Decode(type, bytes);
    return true;
  }

 private:
  static double Decode(PlyType type, const unsigned char* bytes) {
    const auto as = [bytes](auto value) {
      std::memcpy(&value, bytes, sizeof(value));
      return static_cast<double>(value);
    };
    switch (type) {
      case PlyType::kInt8:
        return as(std::int8_t{});
      case PlyType::kUint8:
        return as(std::uint8_t{});
      case PlyType::kInt16:
        return as(std::int16_t{});
      case PlyType::kUint16:
        return as(std::uint16_t{});
      case PlyType::kInt32:
        return as(std::int32_t{});
      case PlyType::kUint32:
        return as(std::uint32_t{});
      case PlyType::kFloat:
        return as(float{});
      case PlyType::kDouble:
        break;
    }
    return as(double{});
  }

  bool ReadWord(double* out) {
    std::size_t i = 0;
    for (; i < rest_.size() && (IsBlank(rest_[i]) || rest_[i] == '\n'); ++i) {
      line_ += rest_[i] == line_end_;
    }
    std::size_t end = i;
    while (end < rest_.size() && !IsBlank(rest_[end]) && rest_[end] != '\n') ++end;
    const auto number = ParseWord<double>(rest_.substr(i, end - i));
    rest_.remove_prefix(end);
    if (number) *out = *number;
    return number.has_value();
  }

  std::string_view rest_;
  PlyEncoding encoding_;
  char line_end_;
  std::size_t line_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_PLY_BODY_H_
