#include "src/render/sample_round.h"

namespace sheaf {

SampleSums::SampleSums(const PixelRect& area, Precision precision) : area_(area) {
  const auto count =
      static_cast<std::size_t>(area.width()) * static_cast<std::size_t>(area.height());
  if (precision == Precision::kDouble) {
    pixels_ = Pixels<double>(count);
  } else {
    pixels_ = Pixels<float>(count);
  }
}

void SampleSums::WriteMeans(Film& film) const {
  std::visit(
      [&](const auto& pixels) {
        float* rgb = film.rgb.data();
        for (const auto& pixel : pixels) {
          const auto mean = pixel.mean();
          *rgb++ = static_cast<float>(mean.x);
          *rgb++ = static_cast<float>(mean.y);
          *rgb++ = static_cast<float>(mean.z);
        }
      },
      pixels_);
}

std::uint64_t SampleSums::samples() const {
  return std::visit(
      [](const auto& pixels) {
        std::uint64_t sum = 0;
        for (const auto& pixel : pixels) sum += pixel.samples;
        return sum;
      },
      pixels_);
}

}  // namespace sheaf
