// Compression as PNG holds its rows: a zlib stream (RFC 1950) of deflate's blocks (RFC 1951).
//
// zlib takes two to three times as long. This looks for a match in a table of what came before, as
// LZ4 does (Collet 2011), but at the last four places of a hash, compares eight bytes at a time,
// takes the longest at once, and gives every block codes of its own.
#ifndef SHEAF_FORMATS_DEFLATE_H_
#define SHEAF_FORMATS_DEFLATE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/formats/huffman.h"

namespace sheaf {

// A symbol of a code and the bits that follow it.
struct DeflateSymbol {
  std::uint32_t symbol, extra;
  int extra_bits;
};

// Compresses bytes as they come, in memory that does not grow with them. The same bytes, however
// they are cut into calls, give the same stream.
class Deflater {
 public:
  Deflater();

  void Write(const std::uint8_t* bytes, std::size_t size);
  // No more bytes come.
  void Finish();

  // What is compressed so far and was not taken yet.
  std::vector<std::uint8_t> TakeOutput();
  std::size_t output_size() const { return output_.size(); }

 private:
  enum class BlockPlace { kInside, kLast };
  using Places = std::array<std::uint32_t, 4>;
  using Codes = std::vector<HuffmanCode>;

  std::size_t FindMatch(std::size_t at, std::size_t end, std::size_t& distance);
  void RememberPlaces(std::size_t from, std::size_t to, std::size_t end);
  void FindTokens(std::size_t end);
  void WriteBlock(BlockPlace place);
  void WriteTokens(BlockPlace place);
  void WriteCodes(const Codes& literals, const Codes& distances);
  void PutSymbol(const Codes& codes, const DeflateSymbol& symbol);
  void PutBits(std::uint64_t bits, int count);
  // In the stream, counted from 1, modulo 2^32: a place that is mistaken for a later one does no
  // harm, as bytes are compared.
  std::uint32_t PlaceOf(std::size_t at) const {
    return static_cast<std::uint32_t>(dropped_ + at + 1);
  }

  std::vector<std::uint8_t> bytes_;  // those that matches may reach back to, and those to come
  std::size_t known_ = 0;            // of bytes_: compressed already
  std::size_t size_ = 0;             // of bytes_: written
  std::uint64_t dropped_ = 0;        // bytes before bytes_
  std::vector<Places> last_;         // by hash of four bytes: where they last began; 0: nowhere
  std::vector<std::uint32_t> tokens_;
  std::uint32_t sum_a_ = 1, sum_b_ = 0;  // Adler's

  std::vector<std::uint8_t> output_;
  std::uint64_t bits_ = 0;  // not yet in output_
  int bit_count_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_DEFLATE_H_
