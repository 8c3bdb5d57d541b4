// Huffman codes as deflate has them (RFC 1951, section 3.2.2).
#ifndef SHEAF_FORMATS_HUFFMAN_H_
#define SHEAF_FORMATS_HUFFMAN_H_

#include <cstdint>
#include <span>
#include <vector>

namespace sheaf {

// A symbol's code: its last `length` bits, the first one lowest; length 0: the symbol never comes.
struct HuffmanCode {
  std::uint16_t bits = 0;
  std::uint8_t length = 0;
};

// The codes of symbols that come so many times, none longer than `most` bits (at most 15). Symbols
// that come at all are at least one and at most 2^most.
std::vector<HuffmanCode> MakeHuffmanCodes(std::span<const std::uint32_t> counts, int most);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_HUFFMAN_H_
