#include "src/formats/quantize.h"

#include <algorithm>
#include <array>
#include <bit>

#include "src/scene/srgb.h"

namespace sheaf {
namespace {

// To [0, 1]; NaN becomes 0.
float Clamp(float value) {
  const float positive = value > 0.0f ? value : 0.0f;
  return positive < 1.0f ? positive : 1.0f;
}

// In double both operations are exact for a float near a tie, so that halves always round up. What
// is not negative is rounded down by the conversion.
std::int32_t Round(double encoded, double most) {
  return static_cast<std::int32_t>(encoded * most + 0.5);
}

double Encode(double value, Transfer transfer) {
  return transfer == Transfer::kSrgb ? std::min(SrgbEncode(value), 1.0) : value;
}

// sRGB's levels of eight bits by comparison: its curve takes 30 ns a value, and never falls.
class SrgbLevels {
 public:
  SrgbLevels() {
    for (std::uint32_t level = 1; level < 256; ++level) least_[level] = LeastOf(level);
    least_[256] = kOne + 1;
    std::uint32_t level = 0;
    for (std::uint32_t i = 0; i < kBuckets; ++i) {
      while (least_[level + 1] <= kLowest + (i << kShift)) ++level;
      first_[i] = static_cast<std::uint8_t>(level);
    }
  }

  // `clamped` lies in [0, 1].
  std::uint8_t LevelOf(float clamped) const {
    const auto bits = std::bit_cast<std::uint32_t>(clamped);
    if (bits < kLowest) return 0;
    std::uint32_t level = first_[(bits - kLowest) >> kShift];
    while (bits >= least_[level + 1]) ++level;
    return static_cast<std::uint8_t>(level);
  }

 private:
  // Bits of floats, which grow with the positive number; a bucket has 2^kShift of them.
  static constexpr std::uint32_t kLowest = std::bit_cast<std::uint32_t>(0x1p-13f);
  static constexpr std::uint32_t kOne = std::bit_cast<std::uint32_t>(1.0f);
  static constexpr int kShift = 16;
  static constexpr std::uint32_t kBuckets = ((kOne - kLowest) >> kShift) + 1;

  // The first value that becomes `level`, by halving.
  static std::uint32_t LeastOf(std::uint32_t level) {
    std::uint32_t below = kLowest, reached = kOne;
    while (reached - below > 1) {
      const std::uint32_t middle = below + (reached - below) / 2;
      const double encoded = Encode(std::bit_cast<float>(middle), Transfer::kSrgb);
      (Round(encoded, 255.0) < static_cast<std::int32_t>(level) ? below : reached) = middle;
    }
    return reached;
  }

  std::array<std::uint32_t, 257> least_ = {};
  std::array<std::uint8_t, kBuckets> first_ = {};
};

}  // namespace

void QuantizeRowTo8Bit(const float* values, std::size_t count, Transfer transfer,
                       std::uint8_t* bytes) {
  if (transfer == Transfer::kSrgb) {
    static const SrgbLevels levels;
    for (std::size_t i = 0; i < count; ++i) bytes[i] = levels.LevelOf(Clamp(values[i]));
    return;
  }
  // Step by step for a block of values, so that compilers use vectors.
  constexpr std::size_t kBlock = 64;
  float clamped[kBlock] = {};
  std::int32_t numbers[kBlock];
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t size = std::min(kBlock, count - first);
    for (std::size_t i = 0; i < size; ++i) clamped[i] = Clamp(values[first + i]);
    for (std::size_t i = 0; i < kBlock; ++i) numbers[i] = Round(clamped[i], 255.0);
    for (std::size_t i = 0; i < size; ++i) bytes[first + i] = static_cast<std::uint8_t>(numbers[i]);
  }
}

void QuantizeRowTo16Bit(const float* values, std::size_t count, Transfer transfer,
                        std::uint8_t* bytes) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::int32_t number = Round(Encode(Clamp(values[i]), transfer), 65535.0);
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
