#include "src/formats/exr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "src/core/atomic_file.h"
#include "src/core/out_of_memory.h"
#include "src/formats/exr_header.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"

#ifdef SHEAF_HAS_OPENEXR
#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#endif

namespace sheaf {

#ifdef SHEAF_HAS_OPENEXR
namespace {

constexpr int kTileSide = 64;

// The library writes here and there; what takes bytes in their order alone gets them at the end.
class FileStream : public Imf::OStream {
 public:
  FileStream(AtomicFile file, const std::string& path)
      : Imf::OStream(path.c_str()), file_(std::move(file)) {}

  void write(const char* bytes, int count) override {
    const auto size = static_cast<std::size_t>(count);
    if (file_.seekable()) {
      const Status written = file_.WriteAt(position_, bytes, size);
      if (!written && !error_) error_ = written.error();
      if (error_) throw Iex::IoExc("cannot write");
    } else {
      held_.resize(std::max(held_.size(), static_cast<std::size_t>(position_) + size));
      std::memcpy(held_.data() + position_, bytes, size);
    }
    position_ += size;
    written_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  const std::optional<Error>& error() const { return error_; }
  std::uint64_t written() const { return written_; }  // bytes, those written twice counted twice
  Status Commit() {
    const Status written = file_.Write(held_.data(), held_.size());
    return written ? file_.Commit() : written;
  }

 private:
  AtomicFile file_;
  std::uint64_t position_ = 0, written_ = 0;
  std::vector<char> held_;
  std::optional<Error> error_;
};

// One channel, and where its numbers come from.
struct Channel {
  std::string name;
  std::optional<Layer> layer;  // nothing: the colours
  int component, components;
  bool is_half;
  std::vector<float> floats;  // of a row of tiles
  std::vector<Imath::half> halves;
};

const char* const kChannelNames[kLayerCount][3] = {{"depth.Z", "", ""},
                                                   {"normal.X", "normal.Y", "normal.Z"},
                                                   {"albedo.R", "albedo.G", "albedo.B"},
                                                   {"id.ID", "", ""},
                                                   {"heat.time", "heat.lanes", "heat.rays"}};

std::vector<Channel> ChannelsOf(const PictureSpec& spec) {
  const bool is_half = spec.bits == 16;
  std::vector<Channel> channels;
  for (int c = 0; c < 3; ++c) {
    channels.push_back({std::string(1, "RGB"[c]), std::nullopt, c, 3, is_half, {}, {}});
  }
  for (int i = 0; i < kLayerCount; ++i) {
    const Layer layer = static_cast<Layer>(i);
    if (!spec.layers.has(layer)) continue;
    for (int c = 0; c < kLayerChannels[i]; ++c) {
      // Halves have 11 bits: too few to tell objects or distances apart.
      const bool needs_float = layer == Layer::kDepth || layer == Layer::kId;
      channels.push_back(
          {kChannelNames[i][c], layer, c, kLayerChannels[i], is_half && !needs_float, {}, {}});
    }
  }
  return channels;
}

// Finite light stays finite: beside an infinite pixel no filter and no mean has a value.
Imath::half ToHalf(float value) {
  constexpr auto kMost = static_cast<float>(HALF_MAX);
  return Imath::half(std::isfinite(value) ? std::clamp(value, -kMost, kMost) : value);
}

class ExrEncoder : public PictureEncoder {
 public:
  ExrEncoder(AtomicFile file, const std::string& path, const PictureSpec& spec)
      : path_(path), spec_(spec), stream_(std::move(file), path), channels_(ChannelsOf(spec)) {}

  Status Begin() {
    return Guard([this] {
      const PixelRect& window = spec_.window;
      Imf::Header header(Imath::Box2i({0, 0}, {spec_.full_width - 1, spec_.full_height - 1}),
                         Imath::Box2i({window.x0, window.y0}, {window.x1 - 1, window.y1 - 1}), 1.0f,
                         Imath::V2f(0, 0), 1.0f, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
      for (const Channel& channel : channels_) {
        header.channels().insert(channel.name,
                                 Imf::Channel(channel.is_half ? Imf::HALF : Imf::FLOAT));
      }
      for (const auto& [key, value] : spec_.metadata) {
        header.insert("sheaf:" + key, Imf::StringAttribute(value));
      }
      header.setTileDescription(Imf::TileDescription(kTileSide, kTileSide, Imf::ONE_LEVEL));
      file_.emplace(stream_, header, 0);
    });
  }

  Status WriteRows(const Film& rows) override {
    for (int y = 0; y < rows.height; ++y) {
      Keep(rows, y);
      ++row_;
      if (row_ % kTileSide != 0 && row_ != spec_.window.height()) continue;
      if (const Status written = WriteTiles(); !written) return written;
    }
    return Done{};
  }

  Status Finish() override {
    // The library's destructor writes where the tiles are, 8 bytes each, and keeps to itself what
    // fails there.
    const std::uint64_t before = stream_.written();
    std::uint64_t table = 0;
    const Status ended = Guard([&] {
      table = 8u * static_cast<std::uint64_t>(file_->numXTiles()) *
              static_cast<std::uint64_t>(file_->numYTiles());
      file_.reset();
    });
    if (!ended) return ended;
    if (stream_.error()) return *stream_.error();
    if (stream_.written() - before != table) {
      throw std::bad_alloc();  // the stream itself did not fail
    }
    return stream_.Commit();
  }

 private:
  template <typename Work>
  Status Guard(const Work& work) {
    try {
      work();
      return Done{};
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      const std::string_view text = error.what();
      ThrowIfOutOfMemory(text);
      // Its compressor fails for nothing else.
      if (text.find("compression (zlib) failed") != std::string_view::npos) throw std::bad_alloc();
      if (stream_.error()) return *stream_.error();
      return InputError(path_, fmt::format("cannot be encoded: {}", Printable(error.what())));
    }
  }

  void Keep(const Film& rows, int y) {
    const auto width = static_cast<std::size_t>(rows.width);
    for (Channel& channel : channels_) {
      const float* from = channel.layer ? rows.at(*channel.layer, 0, y) : rows.pixel(0, y);
      const auto step = static_cast<std::size_t>(channel.components);
      for (std::size_t x = 0; x < width; ++x) {
        const float value = from[x * step + static_cast<std::size_t>(channel.component)];
        if (channel.is_half) {
          channel.halves.push_back(ToHalf(value));
        } else {
          channel.floats.push_back(value);
        }
      }
    }
  }

  Status WriteTiles() {
    const PixelRect& window = spec_.window;
    const int first = window.y0 + tile_row_ * kTileSide;
    return Guard([&] {
      Imf::FrameBuffer buffer;
      const auto width = static_cast<std::size_t>(window.width());
      for (Channel& channel : channels_) {
        const std::size_t size = channel.is_half ? sizeof(Imath::half) : sizeof(float);
        char* const data = channel.is_half ? reinterpret_cast<char*>(channel.halves.data())
                                           : reinterpret_cast<char*>(channel.floats.data());
        // The library adds x and y of the picture, which begin at the window.
        const auto before = static_cast<std::ptrdiff_t>(size) *
                            (window.x0 + first * static_cast<std::ptrdiff_t>(width));
        buffer.insert(channel.name, Imf::Slice(channel.is_half ? Imf::HALF : Imf::FLOAT,
                                               data - before, size, size * width));
      }
      file_->setFrameBuffer(buffer);
      file_->writeTiles(0, file_->numXTiles() - 1, tile_row_, tile_row_);
      ++tile_row_;
      for (Channel& channel : channels_) {
        channel.floats.clear();
        channel.halves.clear();
      }
    });
  }

  std::string path_;
  PictureSpec spec_;
  FileStream stream_;
  std::vector<Channel> channels_;
  int row_ = 0, tile_row_ = 0;
  std::optional<Imf::TiledOutputFile> file_;  // last: its destructor writes to the stream
};

// ---- Reading ----

// Which part of which picture a file holds. Its windows may be any; sides are in [1, kMaxImageSide]
// once CheckSize has passed them.
struct Windows {
  Imath::Box2i data, display;

  static std::int64_t Width(const Imath::Box2i& box) {
    return std::int64_t{box.max.x} - box.min.x + 1;
  }
  static std::int64_t Height(const Imath::Box2i& box) {
    return std::int64_t{box.max.y} - box.min.y + 1;
  }
};

Status CheckSize(const Windows& windows, std::uint64_t bytes, const std::string& path) {
  const std::int64_t width = Windows::Width(windows.data), height = Windows::Height(windows.data);
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide) {
    return InputError(
        path, fmt::format("{}x{} pixels; sides may be 1 to {}", width, height, kMaxImageSide));
  }
  constexpr std::int64_t kMostPixelsPerByte = 4096;
  if (width * height / kMostPixelsPerByte > static_cast<std::int64_t>(bytes)) {
    return InputError(path, "has more pixels than its bytes can hold");
  }
  return Done{};
}

bool IsFull(const Imf::Channel& channel) {
  return channel.xSampling == 1 && channel.ySampling == 1;
}

using ColourChannels = std::array<const char*, 3>;  // of red, green and blue; one may be all three

Result<ColourChannels> FindColours(const Imf::ChannelList& channels, const std::string& path) {
  ColourChannels names = {"R", "G", "B"};
  if (channels.findChannel("R") == nullptr) names = {"Y", "Y", "Y"};
  for (const char* name : names) {
    const Imf::Channel* channel = channels.findChannel(name);
    if (channel == nullptr) return InputError(path, "has neither R, G and B nor Y");
    if (!IsFull(*channel)) return InputError(path, "has channels of less than full resolution");
  }
  return names;
}

Layers FindLayers(const Imf::ChannelList& channels) {
  Layers layers;
  for (int i = 0; i < kLayerCount; ++i) {
    const bool is_there =
        std::all_of(kChannelNames[i], kChannelNames[i] + kLayerChannels[i], [&](const char* name) {
          const Imf::Channel* channel = channels.findChannel(name);
          return channel != nullptr && IsFull(*channel);
        });
    if (is_there) layers.Add(static_cast<Layer>(i));
  }
  return layers;
}

void ReadPixels(Imf::InputFile& file, const Imath::Box2i& data, const ColourChannels& colours,
                Film* film) {
  std::vector<float> grey;
  Imf::FrameBuffer buffer;
  const std::int64_t width = Windows::Width(data);
  const auto insert = [&](const char* name, float* to, std::size_t step) {
    const std::size_t size = step * sizeof(float);
    const auto before = static_cast<std::ptrdiff_t>(step) * (data.min.x + data.min.y * width);
    buffer.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(to - before), size,
                                   size * static_cast<std::size_t>(width)));
  };
  if (colours[0][0] == 'Y') {
    grey.resize(film->pixel_count());
    insert("Y", grey.data(), 1);
  } else {
    for (std::size_t c = 0; c < 3; ++c) insert(colours[c], film->rgb.data() + c, 3);
  }
  for (int i = 0; i < kLayerCount; ++i) {
    if (!film->has(static_cast<Layer>(i))) continue;
    const auto components = static_cast<std::size_t>(kLayerChannels[i]);
    for (std::size_t c = 0; c < components; ++c) {
      insert(kChannelNames[i][c], film->layers[i].data() + c, components);
    }
  }
  file.setFrameBuffer(buffer);
  file.readPixels(data.min.y, data.max.y);
  for (std::size_t i = 0; i < grey.size(); ++i) std::fill_n(&film->rgb[3 * i], 3, grey[i]);
}

// Leaves the window empty where the whole picture is larger than any of Sheaf's.
void SetWindow(const Windows& windows, ReadPictureResult* result) {
  const std::int64_t full_width = Windows::Width(windows.display);
  const std::int64_t full_height = Windows::Height(windows.display);
  const bool is_part = full_width <= kMaxImageSide && full_height <= kMaxImageSide &&
                       full_width >= 1 && full_height >= 1;
  if (!is_part) return;
  const int x0 = windows.data.min.x - windows.display.min.x;
  const int y0 = windows.data.min.y - windows.display.min.y;
  result->window = PixelRect{x0, y0, x0 + result->film.width, y0 + result->film.height};
  result->full_width = static_cast<int>(full_width);
  result->full_height = static_cast<int>(full_height);
}

}  // namespace

bool IsExrBuiltIn() { return true; }

NewEncoder CreateExrEncoder(const std::string& path, const PictureSpec& spec) {
  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  auto encoder = std::make_unique<ExrEncoder>(std::move(file).value(), path, spec);
  if (const Status begun = encoder->Begin(); !begun) return begun.error();
  return std::unique_ptr<PictureEncoder>(std::move(encoder));
}

Result<ReadPictureResult> ReadExr(const std::string& path) {
  const Result<std::uint64_t> bytes = FileSize(path);
  if (!bytes) return bytes.error();
  if (const Status sound = CheckExrHeaders(path, bytes.value()); !sound) return sound.error();
  try {
    Imf::InputFile file(path.c_str(), 0);
    const Imf::Header& header = file.header();
    const Windows windows{header.dataWindow(), header.displayWindow()};
    if (const Status fits = CheckSize(windows, bytes.value(), path); !fits) return fits.error();
    const Result<ColourChannels> colours = FindColours(header.channels(), path);
    if (!colours) return colours.error();
    ReadPictureResult result;
    result.film =
        Film(static_cast<int>(Windows::Width(windows.data)),
             static_cast<int>(Windows::Height(windows.data)), FindLayers(header.channels()));
    ReadPixels(file, windows.data, colours.value(), &result.film);
    const Imf::Channel* first = header.channels().findChannel(colours.value()[0]);
    result.bits = first->type == Imf::HALF ? 16 : 32;
    for (const char* key : kMetadataKeys) {
      const auto* text =
          header.findTypedAttribute<Imf::StringAttribute>(std::string("sheaf:") + key);
      if (text != nullptr) result.metadata.emplace_back(key, text->value());
    }
    SetWindow(windows, &result);
    return result;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    ThrowIfOutOfMemory(error.what());
    return InputError(path, Printable(error.what()));
  }
}

#else

namespace {
Error Without(const std::string& path) {
  return {ErrorKind::kUsage, fmt::format("{}: Sheaf was built without OpenEXR", path)};
}
}  // namespace

bool IsExrBuiltIn() { return false; }
NewEncoder CreateExrEncoder(const std::string& path, const PictureSpec&) { return Without(path); }
Result<ReadPictureResult> ReadExr(const std::string& path) { return Without(path); }

#endif

}  // namespace sheaf
