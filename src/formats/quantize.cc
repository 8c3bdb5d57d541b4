#include "src/formats/quantize.h"

#include <algorithm>
#include <cmath>

#include "src/scene/srgb.h"

namespace sheaf {
namespace {

// A whole number of 0 to `most`.
template <typename Integer>
Integer QuantizeChannel(float value, Transfer transfer, double most) {
  if (!(value > 0.0f)) return 0;  // NaN is not greater than 0 either
  if (value >= 1.0f) return static_cast<Integer>(most);
  const double encoded = transfer == Transfer::kSrgb ? SrgbEncode(value) : value;
  // In double both operations are exact for a float near a tie, so that halves always round up.
  return static_cast<Integer>(std::floor(std::min(encoded, 1.0) * most + 0.5));
}

}  // namespace

void QuantizeRowTo8Bit(const float* values, std::size_t count, Transfer transfer,
                       std::uint8_t* bytes) {
  std::transform(values, values + count, bytes, [transfer](float value) {
    return QuantizeChannel<std::uint8_t>(value, transfer, 255.0);
  });
}

void QuantizeRowTo16Bit(const float* values, std::size_t count, Transfer transfer,
                        std::uint8_t* bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto number = QuantizeChannel<std::uint16_t>(values[i], transfer, 65535.0);
    bytes[2 * i] = static_cast<std::uint8_t>(number >> 8);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(number & 255);
  }
}

std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer) {
  std::vector<std::uint8_t> bytes(film.rgb.size());
  QuantizeRowTo8Bit(film.rgb.data(), film.rgb.size(), transfer, bytes.data());
  return bytes;
}

}  // namespace sheaf
