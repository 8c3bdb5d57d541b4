#include "src/formats/deflate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <utility>

#include "src/formats/huffman.h"

namespace sheaf {
namespace {

using Symbol = DeflateSymbol;

constexpr std::size_t kWindow = 32768;     // how far a match may reach back
constexpr std::size_t kBlock = 128 << 10;  // bytes that are compressed at once
constexpr std::size_t kShortest = 4, kLongest = 258;
constexpr int kHashBits = 12;
// Of a longer match only the places of its two ends are remembered, so many at each.
constexpr std::size_t kRemembered = 4;

// A literal is its byte. A match has kMatch, its length less 3 from bit 16 on, its distance less 1.
constexpr std::uint32_t kMatch = 1u << 31;

constexpr int kLiterals = 286, kDistances = 30, kLengths = 19;
constexpr std::uint32_t kEnd = 256;  // of a block

template <typename T>
T Load(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof(value));
  return value;
}

std::size_t HashOf(const std::uint8_t* bytes) {
  return Load<std::uint32_t>(bytes) * 2654435761u >> (32 - kHashBits);
}

// The latest place comes first.
template <typename Places>
void Remember(std::uint32_t place, Places& places) {
  for (std::size_t i = places.size() - 1; i > 0; --i) places[i] = places[i - 1];
  places[0] = place;
}

// How many of at most `most` bytes are the same.
std::size_t CommonLength(const std::uint8_t* a, const std::uint8_t* b, std::size_t most) {
  std::size_t length = 0;
  if constexpr (std::endian::native == std::endian::little) {
    for (; length + 8 <= most; length += 8) {
      const std::uint64_t differs =
          Load<std::uint64_t>(a + length) ^ Load<std::uint64_t>(b + length);
      if (differs != 0) return length + static_cast<std::size_t>(std::countr_zero(differs)) / 8;
    }
  }
  while (length < most && a[length] == b[length]) ++length;
  return length;
}

// RFC 1951, section 3.2.5, as formulas.
Symbol LengthSymbol(std::uint32_t less_3) {
  if (less_3 == kLongest - 3) return {285, 0, 0};
  if (less_3 < 8) return {257 + less_3, 0, 0};
  const int high = std::bit_width(less_3) - 1, extra = high - 2;
  return {257 + 4 * static_cast<std::uint32_t>(high - 1) + (less_3 >> extra & 3),
          less_3 & ((1u << extra) - 1), extra};
}
Symbol DistanceSymbol(std::uint32_t less_1) {
  if (less_1 < 4) return {less_1, 0, 0};
  const int high = std::bit_width(less_1) - 1, extra = high - 1;
  return {2 * static_cast<std::uint32_t>(high) + (less_1 >> extra & 1),
          less_1 & ((1u << extra) - 1), extra};
}

// The lengths of codes, themselves as symbols: runs are counted (section 3.2.7).
std::vector<Symbol> DescribeLengths(std::span<const std::uint8_t> lengths) {
  std::vector<Symbol> symbols;
  for (std::size_t i = 0; i < lengths.size();) {
    std::size_t run = 1;
    while (i + run < lengths.size() && lengths[i + run] == lengths[i]) ++run;
    i += run;
    const std::uint32_t length = lengths[i - 1];
    const auto repeat = [&](std::size_t least, std::size_t most, std::uint32_t symbol, int bits) {
      for (; run >= least; run -= std::min(run, most)) {
        symbols.push_back({symbol, static_cast<std::uint32_t>(std::min(run, most) - least), bits});
      }
    };
    if (length == 0) {
      repeat(11, 138, 18, 7);
      repeat(3, 10, 17, 3);
    } else {
      symbols.push_back({length, 0, 0});
      --run;
      repeat(3, 6, 16, 2);
    }
    for (; run > 0; --run) symbols.push_back({length, 0, 0});
  }
  return symbols;
}

// Adler's sums (RFC 1950, section 8.2). The second grows by every first: a sum of the bytes by
// weight, in pieces that 32 bits hold, of products of 16 bits, which vectors take.
constexpr std::size_t kPiece = 2048;
constexpr auto kWeights = [] {
  std::array<std::int16_t, kPiece> weights = {};
  for (std::size_t i = 0; i < kPiece; ++i) weights[i] = static_cast<std::int16_t>(kPiece - i);
  return weights;
}();

void AddToSums(const std::uint8_t* bytes, std::size_t size, std::uint32_t& a, std::uint32_t& b) {
  constexpr std::uint32_t kPrime = 65521;
  while (size > 0) {
    const std::size_t piece = std::min(kPiece, size);
    const std::int16_t* const weights = kWeights.data() + (kPiece - piece);
    std::int32_t sum = 0, weighted = 0;
    for (std::size_t i = 0; i < piece; ++i) {
      const std::int16_t byte = bytes[i];
      sum += byte;
      weighted += byte * weights[i];
    }
    b = (b + static_cast<std::uint32_t>(piece) * a + static_cast<std::uint32_t>(weighted)) % kPrime;
    a = (a + static_cast<std::uint32_t>(sum)) % kPrime;
    bytes += piece;
    size -= piece;
  }
}

}  // namespace

Deflater::Deflater()
    : bytes_(kWindow + kBlock),
      last_(std::size_t{1} << kHashBits),
      output_{0x78, 0x5e} {}  // deflate with a window of 32 KiB, compressed fast

void Deflater::Write(const std::uint8_t* bytes, std::size_t size) {
  while (size > 0) {
    if (size_ == bytes_.size()) {
      WriteBlock(BlockPlace::kInside);
      const std::size_t drop = size_ - kWindow;
      std::memmove(bytes_.data(), bytes_.data() + drop, kWindow);
      dropped_ += drop;
      known_ = size_ = kWindow;
    }
    const std::size_t part = std::min(size, bytes_.size() - size_);
    std::memcpy(bytes_.data() + size_, bytes, part);
    size_ += part;
    bytes += part;
    size -= part;
  }
}

void Deflater::Finish() {
  WriteBlock(BlockPlace::kLast);
  PutBits(0, 7);  // fills the last byte
  for (const std::uint32_t sum : {sum_b_, sum_a_}) {
    output_.push_back(static_cast<std::uint8_t>(sum >> 8));
    output_.push_back(static_cast<std::uint8_t>(sum & 255));
  }
}

std::vector<std::uint8_t> Deflater::TakeOutput() { return std::exchange(output_, {}); }

// The longest match found for what begins at `at`, or 0; remembers that it begins there.
std::size_t Deflater::FindMatch(std::size_t at, std::size_t end, std::size_t& distance) {
  const std::uint8_t* const now = &bytes_[at];
  const std::uint32_t here = PlaceOf(at);
  const std::size_t most = std::min(kLongest, end - at);
  std::size_t longest = 0;
  Places& places = last_[HashOf(now)];
  for (const std::uint32_t place : places) {
    const std::size_t back = here - place;
    if (place == 0 || back > kWindow) break;
    if (Load<std::uint32_t>(now) != Load<std::uint32_t>(now - back)) continue;
    const std::size_t length = CommonLength(now, now - back, most);
    if (length <= longest) continue;
    longest = length;
    distance = back;
    if (length == most) break;
  }
  Remember(here, places);
  return longest;
}

// Those of [from, to) that four bytes before `end` begin at.
void Deflater::RememberPlaces(std::size_t from, std::size_t to, std::size_t end) {
  to = std::min(to, end - kShortest + 1);
  for (std::size_t i = from; i < to; ++i) Remember(PlaceOf(i), last_[HashOf(&bytes_[i])]);
}

void Deflater::FindTokens(std::size_t end) {
  tokens_.clear();
  std::size_t at = known_;
  while (at + kShortest <= end) {
    std::size_t distance = 0;
    std::size_t length = FindMatch(at, end, distance);
    if (length == 0) {
      tokens_.push_back(bytes_[at++]);
      continue;
    }
    tokens_.push_back(kMatch | static_cast<std::uint32_t>(length - 3) << 16 |
                      static_cast<std::uint32_t>(distance - 1));
    const std::size_t after = at + length;
    RememberPlaces(at + 1, std::min(after, at + kRemembered), end);
    RememberPlaces(std::max(at + kRemembered, after - std::min(length, kRemembered)), after, end);
    at = after;
  }
  while (at < end) tokens_.push_back(bytes_[at++]);
  known_ = end;
}

void Deflater::WriteBlock(BlockPlace place) {
  AddToSums(&bytes_[known_], size_ - known_, sum_a_, sum_b_);
  FindTokens(size_);
  WriteTokens(place);
}

void Deflater::WriteTokens(BlockPlace place) {
  std::array<std::uint32_t, kLiterals> literal_counts = {};
  // Two distances have codes whatever comes: some readers refuse a block of fewer.
  std::array<std::uint32_t, kDistances> distance_counts = {1, 1};
  literal_counts[kEnd] = 1;
  for (const std::uint32_t token : tokens_) {
    if (token & kMatch) {
      ++literal_counts[LengthSymbol(token >> 16 & 255).symbol];
      ++distance_counts[DistanceSymbol(token & 32767).symbol];
    } else {
      ++literal_counts[token];
    }
  }
  const Codes literals = MakeHuffmanCodes(literal_counts, 15);
  const Codes distances = MakeHuffmanCodes(distance_counts, 15);
  PutBits(place == BlockPlace::kLast ? 1 : 0, 1);
  PutBits(2, 2);  // with codes of its own
  WriteCodes(literals, distances);
  for (const std::uint32_t token : tokens_) {
    if (token & kMatch) {
      PutSymbol(literals, LengthSymbol(token >> 16 & 255));
      PutSymbol(distances, DistanceSymbol(token & 32767));
    } else {
      PutSymbol(literals, {token, 0, 0});
    }
  }
  PutSymbol(literals, {kEnd, 0, 0});
}

void Deflater::WriteCodes(const Codes& literals, const Codes& distances) {
  std::vector<std::uint8_t> lengths;
  for (const Codes* codes : {&literals, &distances}) {
    for (const HuffmanCode& code : *codes) lengths.push_back(code.length);
  }
  const std::vector<Symbol> described = DescribeLengths(lengths);
  std::array<std::uint32_t, kLengths> counts = {};
  for (const Symbol& symbol : described) ++counts[symbol.symbol];
  const Codes codes = MakeHuffmanCodes(counts, 7);
  PutBits(kLiterals - 257, 5);
  PutBits(kDistances - 1, 5);
  PutBits(kLengths - 4, 4);
  for (const int i : {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15}) {
    PutBits(codes[static_cast<std::size_t>(i)].length, 3);
  }
  for (const Symbol& symbol : described) PutSymbol(codes, symbol);
}

void Deflater::PutSymbol(const Codes& codes, const Symbol& symbol) {
  const HuffmanCode& code = codes[symbol.symbol];
  PutBits(code.bits | std::uint64_t{symbol.extra} << code.length, code.length + symbol.extra_bits);
}

// At most 48 bits, from the lowest on.
void Deflater::PutBits(std::uint64_t bits, int count) {
  bits_ |= bits << bit_count_;
  bit_count_ += count;
  for (; bit_count_ >= 8; bit_count_ -= 8, bits_ >>= 8) {
    output_.push_back(static_cast<std::uint8_t>(bits_ & 255));
  }
}

}  // namespace sheaf
