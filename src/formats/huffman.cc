#include "src/formats/huffman.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

namespace sheaf {
namespace {

constexpr int kMostBits = 15;
using LengthCounts = std::array<std::uint32_t, kMostBits + 1>;  // codes of each length

// Of Huffman's tree over `counts`, which ascend; what is deeper than `most` counts there.
LengthCounts CountLengths(const std::vector<std::uint64_t>& counts, int most) {
  // The two rarest become one, again and again. Leaves and pairs both wait in ascending order.
  const std::size_t leaves = counts.size(), nodes = 2 * leaves - 1;
  std::vector<std::uint64_t> weight = counts;
  weight.reserve(nodes);
  std::vector<std::size_t> parent(nodes);
  std::size_t leaf = 0, pair = leaves;
  const auto rarest = [&] {
    const bool is_leaf = leaf < leaves && (pair == weight.size() || weight[leaf] <= weight[pair]);
    return is_leaf ? leaf++ : pair++;
  };
  while (weight.size() < nodes) {
    const std::size_t a = rarest(), b = rarest();
    parent[a] = parent[b] = weight.size();
    weight.push_back(weight[a] + weight[b]);
  }
  LengthCounts lengths = {};
  std::vector<int> depth(nodes);
  for (std::size_t i = nodes - 1; i-- > 0;) {
    depth[i] = depth[parent[i]] + 1;
    if (i < leaves) ++lengths[static_cast<std::size_t>(std::min(depth[i], most))];
  }
  return lengths;
}

// Makes a code of lengths that fits: 2^-length, summed up, is 1.
void FitLengths(LengthCounts& lengths, std::size_t most) {
  std::uint32_t sum = 0;  // of 2^(most - length)
  for (std::size_t i = 1; i <= most; ++i) sum += lengths[i] << (most - i);
  for (; sum > 1u << most; --sum) {
    // A longest code moves beside another code, which becomes a bit longer.
    std::size_t shorter = most - 1;
    while (lengths[shorter] == 0) --shorter;
    --lengths[most];
    --lengths[shorter];
    lengths[shorter + 1] += 2;
  }
}

std::uint16_t Reverse(std::uint32_t bits, int length) {
  std::uint32_t reversed = 0;
  for (int i = 0; i < length; ++i) reversed |= (bits >> i & 1) << (length - 1 - i);
  return static_cast<std::uint16_t>(reversed);
}

// Codes of one length follow one another in the order of their symbols.
void NumberCodes(const LengthCounts& lengths, std::vector<HuffmanCode>& codes) {
  std::array<std::uint32_t, kMostBits + 2> next = {};
  for (std::size_t i = 1; i <= kMostBits; ++i) next[i + 1] = (next[i] + lengths[i]) << 1;
  for (HuffmanCode& code : codes) {
    if (code.length > 0) code.bits = Reverse(next[code.length]++, code.length);
  }
}

}  // namespace

std::vector<HuffmanCode> MakeHuffmanCodes(std::span<const std::uint32_t> counts, int most) {
  std::vector<std::size_t> symbols;  // from the rarest on
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) symbols.push_back(i);
  }
  assert(!symbols.empty() && most <= kMostBits && symbols.size() <= std::size_t{1} << most);
  std::stable_sort(symbols.begin(), symbols.end(),
                   [&](std::size_t a, std::size_t b) { return counts[a] < counts[b]; });
  LengthCounts lengths = {};
  if (symbols.size() == 1) {
    lengths[1] = 1;
  } else {
    std::vector<std::uint64_t> sorted;
    for (const std::size_t symbol : symbols) sorted.push_back(counts[symbol]);
    lengths = CountLengths(sorted, most);
    FitLengths(lengths, static_cast<std::size_t>(most));
  }
  std::vector<HuffmanCode> codes(counts.size());
  std::size_t symbol = 0;
  for (int length = most; length > 0; --length) {
    for (std::uint32_t i = 0; i < lengths[static_cast<std::size_t>(length)]; ++i) {
      codes[symbols[symbol++]].length = static_cast<std::uint8_t>(length);
    }
  }
  NumberCodes(lengths, codes);
  return codes;
}

}  // namespace sheaf
