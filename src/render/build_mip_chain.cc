#include "src/render/build_mip_chain.h"

#include <algorithm>
#include <cstddef>

#include "src/scene/decode_table.h"

namespace sheaf {
namespace {

constexpr int kChannels = 4;

// The byte whose light is nearest, by a table of where to begin looking.
class ByteOfLight {
 public:
  explicit ByteOfLight(const std::vector<float>& light) {
    for (std::size_t byte = 0; byte + 1 < light.size(); ++byte) {
      ends_.push_back((light[byte] + light[byte + 1]) / 2);
    }
    ends_.push_back(2);  // beyond all light
    std::uint32_t byte = 0;
    for (int bin = 0; bin <= kBins; ++bin) {
      while (ends_[byte] <= static_cast<float>(bin) / kBins) ++byte;
      first_.push_back(byte);
    }
  }

  std::uint32_t operator()(float light) const {
    std::uint32_t byte = first_[static_cast<std::size_t>(light * kBins)];
    while (ends_[byte] <= light) ++byte;
    return byte;
  }

 private:
  static constexpr int kBins = 4096;
  std::vector<float> ends_;  // by byte: where it gives way to the next
  std::vector<std::uint32_t> first_;
};

// What texel `to` of a side covers of the level before: texels from `first` on, by weights that add
// up to the side there.
struct Cover {
  int first, count;
  int weights[4];  // a side is at most three times the next one
};

Cover CoverOf(int to, int from_side, int to_side) {
  const std::int64_t begin = std::int64_t{to} * from_side, end = begin + from_side;
  Cover cover{static_cast<int>(begin / to_side), 0, {}};
  for (std::int64_t i = cover.first; i * to_side < end; ++i) {
    const std::int64_t low = std::max(begin, i * to_side), high = std::min(end, (i + 1) * to_side);
    cover.weights[cover.count++] = static_cast<int>(high - low);
  }
  return cover;
}

// The channels of a level, in linear light.
struct LightLevel {
  int width = 0, height = 0;
  std::vector<float> channels;  // kChannels a texel

  float* row(int y) {
    return channels.data() +
           kChannels * static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  }
};

// Adds the covered texels of a row to those of `sums`, weighed.
void AddRow(const float* row, const std::vector<Cover>& columns, float weight,
            std::vector<float>& sums) {
  float* sum = sums.data();
  for (const Cover& cover : columns) {
    const float* texel = row + std::ptrdiff_t{kChannels} * cover.first;
    for (int i = 0; i < cover.count; ++i, texel += kChannels) {
      const float share = weight * static_cast<float>(cover.weights[i]);
      for (int c = 0; c < kChannels; ++c) sum[c] += texel[c] * share;
    }
    sum += kChannels;
  }
}

// The next level; `row_of(y)` gives rows of the one before.
template <typename RowOf>
LightLevel Shrink(int width, int height, RowOf row_of) {
  LightLevel next{std::max(width / 2, 1), std::max(height / 2, 1), {}};
  std::vector<Cover> columns;
  for (int x = 0; x < next.width; ++x) columns.push_back(CoverOf(x, width, next.width));
  std::vector<float> sums(kChannels * columns.size());
  next.channels.reserve(sums.size() * static_cast<std::size_t>(next.height));
  const float whole = static_cast<float>(width) * static_cast<float>(height);
  for (int y = 0; y < next.height; ++y) {
    const Cover rows = CoverOf(y, height, next.height);
    std::fill(sums.begin(), sums.end(), 0.0f);
    for (int i = 0; i < rows.count; ++i) {
      AddRow(row_of(rows.first + i), columns, static_cast<float>(rows.weights[i]), sums);
    }
    for (const float sum : sums) next.channels.push_back(sum / whole);
  }
  return next;
}

// The image's own rows in linear light, one at a time.
class ImageRows {
 public:
  ImageRows(const Image& image, const std::vector<float>& light)
      : image_(image), light_(light), row_(kChannels * static_cast<std::size_t>(image.width)) {}

  const float* operator()(int y) {
    const auto width = static_cast<std::size_t>(image_.width);
    const std::uint32_t* texel = image_.texels.data() + width * static_cast<std::size_t>(y);
    for (std::size_t x = 0; x < width; ++x) {
      for (int c = 0; c < 3; ++c) row_[kChannels * x + c] = light_[texel[x] >> 8 * c & 255];
      row_[kChannels * x + 3] = static_cast<float>(texel[x] >> 24) / 255;
    }
    return row_.data();
  }

 private:
  const Image& image_;
  const std::vector<float>& light_;
  std::vector<float> row_;
};

void Store(const LightLevel& level, const ByteOfLight& byte_of, MipChain& chain) {
  const int i = chain.level_count++;
  chain.levels.first[i] = static_cast<std::int32_t>(chain.texels.size());
  chain.levels.width[i] = level.width;
  chain.levels.height[i] = level.height;
  for (std::size_t at = 0; at < level.channels.size(); at += kChannels) {
    std::uint32_t texel = static_cast<std::uint32_t>(level.channels[at + 3] * 255 + 0.5f) << 24;
    for (std::size_t c = 0; c < 3; ++c) texel |= byte_of(level.channels[at + c]) << 8 * c;
    chain.texels.push_back(texel);
  }
}

}  // namespace

MipChain BuildMipChain(const Image& image, Transfer transfer) {
  static_assert(kMaxTextureSide == 1 << (kMaxTextureLevels - 1));
  MipChain chain;
  chain.levels.width[0] = image.width;
  chain.levels.height[0] = image.height;
  if (image.width == 1 && image.height == 1) return chain;
  const std::vector<float> light = DecodeTable<float>(transfer);
  const ByteOfLight byte_of(light);
  ImageRows rows(image, light);
  LightLevel level = Shrink(image.width, image.height, [&](int y) { return rows(y); });
  Store(level, byte_of, chain);
  while (level.width > 1 || level.height > 1) {
    level = Shrink(level.width, level.height, [&](int y) { return level.row(y); });
    Store(level, byte_of, chain);
  }
  return chain;
}

}  // namespace sheaf
