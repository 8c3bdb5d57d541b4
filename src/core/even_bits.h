// Bits 0, 2, 4, ... of a number, packed: a coordinate out of a Morton code.
#ifndef SHEAF_CORE_EVEN_BITS_H_
#define SHEAF_CORE_EVEN_BITS_H_

#include <cstdint>

namespace sheaf {

inline std::uint32_t EvenBits(std::uint32_t code) {
  std::uint32_t packed = 0;
  for (int bit = 0; bit < 16; ++bit) packed |= (code >> bit) & (1u << bit);
  return packed;
}

}  // namespace sheaf

#endif  // SHEAF_CORE_EVEN_BITS_H_
