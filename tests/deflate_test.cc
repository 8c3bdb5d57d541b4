// What is compressed is what zlib reads, whatever the bytes are.
#include "src/formats/deflate.h"

#include <doctest/doctest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "src/formats/huffman.h"

namespace sheaf {
namespace {

using Bytes = std::vector<std::uint8_t>;

// In pieces of `piece` bytes.
Bytes Deflated(const Bytes& bytes, std::size_t piece) {
  Deflater deflater;
  Bytes stream;
  const auto take = [&] {
    const Bytes more = deflater.TakeOutput();
    stream.insert(stream.end(), more.begin(), more.end());
  };
  for (std::size_t i = 0; i < bytes.size(); i += piece) {
    deflater.Write(bytes.data() + i, std::min(piece, bytes.size() - i));
    if (i % 3 == 0) take();
  }
  deflater.Finish();
  take();
  return stream;
}

void CheckRoundTrip(const Bytes& bytes) {
  const Bytes stream = Deflated(bytes, 5000);
  CHECK(Deflated(bytes, 7777) == stream);
  Bytes read(bytes.size() + 1);
  uLongf size = static_cast<uLongf>(read.size());
  REQUIRE(uncompress(read.data(), &size, stream.data(), static_cast<uLong>(stream.size())) == Z_OK);
  read.resize(size);
  CHECK(read == bytes);
}

TEST_CASE("no bytes, few bytes, and every number of bytes near a block's end") {
  for (std::size_t n = 0; n < 300; ++n) {
    Bytes bytes(n, 7);
    CheckRoundTrip(bytes);
    for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<std::uint8_t>(i * i);
    CheckRoundTrip(bytes);
  }
  for (const std::size_t near :
       {std::size_t{32768}, std::size_t{131072}, std::size_t{163840}, std::size_t{294912}}) {
    for (std::size_t n = near - 5; n <= near + 5; ++n) CheckRoundTrip(Bytes(n, 1));
  }
}

TEST_CASE("noise, words, and matches of every length and distance") {
  std::mt19937 random(5);
  for (const std::uint32_t colours : {2u, 5u, 256u}) {
    Bytes bytes(400'000);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() % colours);
    CheckRoundTrip(bytes);
  }
  Bytes bytes(1000);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  while (bytes.size() < 900'000) {
    const std::size_t length = 1 + random() % 300;
    const std::size_t most = std::min<std::size_t>(bytes.size(), 33'000);
    // Short distances come as often as long ones.
    const std::size_t distance = 1 + (random() % most >> random() % 16);
    for (std::size_t i = 0; i < length; ++i) bytes.push_back(bytes[bytes.size() - distance]);
    bytes.push_back(static_cast<std::uint8_t>(random()));
  }
  CheckRoundTrip(bytes);
}

TEST_CASE("what repeats becomes small") {
  CHECK(Deflated(Bytes(3'000'000, 9), 4096).size() < 3'000'000 / 600);
}

// The number that 2^-length sums up to, in 2^-15.
std::uint32_t SumOf(const std::vector<HuffmanCode>& codes) {
  std::uint32_t sum = 0;
  for (const HuffmanCode& code : codes) sum += code.length > 0 ? 1u << (15 - code.length) : 0;
  return sum;
}

TEST_CASE("Huffman's codes: as long as they should be, none longer than asked for") {
  const std::vector<HuffmanCode> even =
      MakeHuffmanCodes(std::vector<std::uint32_t>{3, 3, 0, 3, 3}, 15);
  CHECK(even[0].length == 2);
  CHECK(even[2].length == 0);
  CHECK(even[4].bits == 3);
  // Counts that double give the longest codes that there are.
  std::vector<std::uint32_t> counts;
  for (int i = 0; i < 30; ++i) counts.push_back(1u << i);
  for (const int most : {5, 7, 15}) {
    const std::vector<HuffmanCode> codes = MakeHuffmanCodes(counts, most);
    CHECK(SumOf(codes) == 1u << 15);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      CHECK(codes[i].length >= 1);
      CHECK(codes[i].length <= most);
      if (i > 0) CHECK(codes[i].length <= codes[i - 1].length);
    }
  }
  CHECK(MakeHuffmanCodes(std::vector<std::uint32_t>{0, 8}, 15)[1].length == 1);
}

}  // namespace
}  // namespace sheaf
