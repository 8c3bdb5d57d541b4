// Rounds light to the whole numbers of a display's picture.
#ifndef SHEAF_FORMATS_QUANTIZE_H_
#define SHEAF_FORMATS_QUANTIZE_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// Each clamps to [0, 1] (NaN becomes 0), encodes, multiplies by 255 or 65535 and rounds to nearest.
void QuantizeRowTo8Bit(const float* values, std::size_t count, Transfer transfer,
                       std::uint8_t* bytes);
// Two bytes a value, the higher first, as PNG has it.
void QuantizeRowTo16Bit(const float* values, std::size_t count, Transfer transfer,
                        std::uint8_t* bytes);

// 3 * width * height bytes, interleaved, rows from the top.
std::vector<std::uint8_t> QuantizeTo8Bit(const Film& film, Transfer transfer);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_QUANTIZE_H_
