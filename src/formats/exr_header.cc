#include "src/formats/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "src/formats/printable.h"
#include "src/formats/read_file.h"

namespace sheaf {
namespace {

// What OpenEXR makes room by. Numbers of a file that are out of range stand for none.
struct Claims {
  std::int64_t width = 0, height = 0;  // of the data window
  std::int64_t tile_width = 0, tile_height = 0;
  std::int64_t lines = 1;  // that are packed together
  std::int64_t channels = 0;
};

// The lines that a compression packs together, by its number in the file.
constexpr std::array<int, 10> kPackedLines = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};

// The library reads an attribute of these types without regard to the size that the file states,
// and takes what follows for the next one.
constexpr std::pair<std::string_view, int> kTypeSizes[] = {
    {"box2f", 16},         {"box2i", 16},    {"chromaticities", 32},
    {"compression", 1},    {"double", 8},    {"envmap", 1},
    {"deepImageState", 1}, {"float", 4},     {"int", 4},
    {"keycode", 28},       {"lineOrder", 1}, {"m33f", 36},
    {"m33d", 72},          {"m44f", 64},     {"m44d", 128},
    {"rational", 8},       {"tiledesc", 9},  {"timecode", 8},
    {"v2d", 16},           {"v2f", 8},       {"v2i", 8},
    {"v3d", 24},           {"v3f", 12},      {"v3i", 12}};

std::int64_t Signed32(const unsigned char* at) {
  const auto bits = static_cast<std::uint32_t>(at[0]) | static_cast<std::uint32_t>(at[1]) << 8 |
                    static_cast<std::uint32_t>(at[2]) << 16 |
                    static_cast<std::uint32_t>(at[3]) << 24;
  return static_cast<std::int32_t>(bits);
}

// How many channels a list has that ends where its attribute does; nothing where it does not.
std::optional<std::int64_t> CountChannels(std::string_view list) {
  constexpr std::size_t kAfterName = 16;
  for (std::int64_t count = 0;; ++count) {
    const std::size_t end = list.find('\0');
    if (end == std::string_view::npos) return std::nullopt;
    if (end == 0) return list.size() == 1 ? std::optional(count) : std::nullopt;
    if (list.size() - end - 1 < kAfterName) return std::nullopt;
    list.remove_prefix(end + 1 + kAfterName);
  }
}

class HeaderScan {
 public:
  HeaderScan(const std::string& path, std::uint64_t bytes)
      : path_(path), left_(bytes), bytes_(bytes), file_(std::fopen(path.c_str(), "rb")) {}

  Status Run() {
    unsigned char start[8];
    // What is no OpenEXR file at all, the library says best.
    if (!file_ || !Take(start, sizeof start) || Signed32(start) != 0x01312f76) return Done{};
    constexpr unsigned kDeep = 0x08, kManyParts = 0x10;
    if (start[5] & kDeep) return InputError(path_, "deep data, which are not read");
    for (;;) {
      Claims claims;
      bool is_empty = true;
      for (;;) {
        std::string name, type;
        if (!TakeText(&name)) return Done{};
        if (name.empty()) break;
        is_empty = false;
        if (!TakeText(&type)) return Done{};
        if (const Status taken = TakeAttribute(name, type, &claims); !taken) return taken;
      }
      if (is_empty) return Done{};
      if (const Status possible = Check(claims); !possible) return possible;
      if (!(start[5] & kManyParts)) return Done{};
    }
  }

 private:
  bool Take(unsigned char* to, std::size_t count) {
    if (count > left_ || std::fread(to, 1, count, file_.get()) != count) return false;
    left_ -= count;
    return true;
  }

  // A name and the zero at its end.
  bool TakeText(std::string* text) {
    constexpr std::size_t kMost = 255;
    for (;;) {
      unsigned char c = 0;
      if (!Take(&c, 1) || text->size() > kMost) return false;
      if (c == 0) return true;
      text->push_back(static_cast<char>(c));
    }
  }

  Status TakeAttribute(const std::string& name, const std::string& type, Claims* claims) {
    unsigned char size_bytes[4];
    if (!Take(size_bytes, sizeof size_bytes)) return Done{};
    const std::int64_t size = Signed32(size_bytes);
    if (size < 0 || static_cast<std::uint64_t>(size) > left_) {
      return InputError(path_, fmt::format("its attribute \"{}\" claims {} bytes; the file has {}",
                                           Printable(name, 40), size, bytes_));
    }
    const auto wrong = [&] {
      return InputError(path_,
                        fmt::format("its attribute \"{}\" is malformed", Printable(name, 40)));
    };
    for (const auto& [known, bytes] : kTypeSizes) {
      if (type == known && size != bytes) return wrong();
    }
    if (type == "chlist") {
      std::string list(static_cast<std::size_t>(size), '\0');
      if (!Take(reinterpret_cast<unsigned char*>(list.data()), list.size())) return Done{};
      const std::optional<std::int64_t> channels = CountChannels(list);
      if (!channels) return wrong();
      claims->channels = std::max(claims->channels, *channels);
      return Done{};
    }
    std::array<unsigned char, 16> data = {};
    const auto kept = std::min(static_cast<std::size_t>(size), data.size());
    if (!Take(data.data(), kept)) return Done{};
    const std::uint64_t rest = static_cast<std::uint64_t>(size) - kept;
    if (name == "dataWindow" && size == 16) {
      claims->width = Signed32(&data[8]) - Signed32(&data[0]) + 1;
      claims->height = Signed32(&data[12]) - Signed32(&data[4]) + 1;
    } else if (name == "tiles" && size >= 8) {
      claims->tile_width = Signed32(&data[0]);
      claims->tile_height = Signed32(&data[4]);
    } else if (name == "compression" && data[0] < kPackedLines.size()) {
      claims->lines = kPackedLines[data[0]];
    } else if (type == "preview") {
      const std::int64_t width = Signed32(&data[0]), height = Signed32(&data[4]);
      const bool fits = width >= 0 && height >= 0 && width <= size && height <= size &&
                        width * height * 4 == size - 8;
      if (!fits) return InputError(path_, "its preview claims more pixels than it has");
    } else if (name == "type" && kept >= 4 && std::equal(data.begin(), data.begin() + 4, "deep")) {
      return InputError(path_, "deep data, which are not read");
    }
    if (std::fseek(file_.get(), static_cast<long>(rest), SEEK_CUR) == 0) left_ -= rest;
    return Done{};
  }

  Status Check(const Claims& claims) const {
    constexpr std::int64_t kSide = std::numeric_limits<std::int32_t>::max();
    const std::int64_t width = claims.width, height = claims.height;
    // Sides that no picture has are refused by the caller, and by the library.
    if (width < 1 || height < 1 || width > kSide || height > kSide) return Done{};
    const bool is_tiled = claims.tile_width > 0 && claims.tile_height > 0;
    const auto parts = [](std::int64_t whole, std::int64_t part) {
      return (whole + part - 1) / part;
    };
    const double tables =
        8.0 * (is_tiled ? static_cast<double>(parts(width, claims.tile_width)) *
                              static_cast<double>(parts(height, claims.tile_height))
                        : static_cast<double>(parts(height, claims.lines)));
    if (tables > static_cast<double>(bytes_)) {
      return InputError(path_, "has more pixels than its bytes can hold");
    }
    // Four bytes are the most that a channel has a pixel.
    const double pixel = 4.0 * static_cast<double>(std::max<std::int64_t>(claims.channels, 1));
    const double piece =
        pixel *
        (is_tiled ? static_cast<double>(claims.tile_width) * static_cast<double>(claims.tile_height)
                  : static_cast<double>(width) * static_cast<double>(claims.lines));
    const double picture = pixel * static_cast<double>(width) * static_cast<double>(height);
    const double most = static_cast<double>(MostMemoryFor(bytes_)) + picture;
    if (piece > most) {
      return InputError(path_, fmt::format("its {} claim more memory than a file of its size may",
                                           is_tiled ? "tiles" : "lines"));
    }
    return Done{};
  }

  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::string path_;
  std::uint64_t left_, bytes_;
  std::unique_ptr<std::FILE, CloseFile> file_;
};

}  // namespace

Status CheckExrHeaders(const std::string& path, std::uint64_t bytes) {
  return HeaderScan(path, bytes).Run();
}

}  // namespace sheaf
