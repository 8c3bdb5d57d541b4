// Pictures: quantisation, round trips and damaged files.
#include <doctest/doctest.h>
#include <png.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "folder.h"
#include "picture_files.h"
#include "sheaf/formats.h"
#include "sheaf/version.h"
#include "src/formats/pfm.h"
#include "src/formats/png.h"
#include "src/formats/quantize.h"

namespace sheaf {
namespace {

std::uint8_t Quantized(float value, Transfer transfer = Transfer::kLinear) {
  Film film(1, 1);
  film.rgb = {value, 0.0f, 0.0f};
  return QuantizeTo8Bit(film, transfer)[0];
}

TEST_CASE("quantisation clamps, and NaN is black") {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Transfer transfer : {Transfer::kLinear, Transfer::kSrgb}) {
    CHECK(Quantized(nan, transfer) == 0);
    CHECK(Quantized(-nan, transfer) == 0);
    CHECK(Quantized(inf, transfer) == 255);
    CHECK(Quantized(-inf, transfer) == 0);
    CHECK(Quantized(0.0f, transfer) == 0);
    CHECK(Quantized(-0.0f, transfer) == 0);
    CHECK(Quantized(-1.0f, transfer) == 0);
    CHECK(Quantized(1.0f, transfer) == 255);
    CHECK(Quantized(std::nextafter(1.0f, 0.0f), transfer) == 255);
    CHECK(Quantized(3e38f, transfer) == 255);
    CHECK(Quantized(std::numeric_limits<float>::denorm_min(), transfer) == 0);
  }
}

TEST_CASE("quantisation rounds to nearest at every boundary") {
  for (int level = 0; level < 255; ++level) {
    // The float on each side of (level + .5) / 255, judged in long double.
    const long double boundary = (static_cast<long double>(level) + 0.5L) / 255.0L;
    float below = static_cast<float>(boundary);
    while (static_cast<long double>(below) >= boundary) below = std::nextafter(below, 0.0f);
    float above = std::nextafter(below, 1.0f);
    CHECK(Quantized(below) == level);
    CHECK(Quantized(above) == level + 1);
  }
  CHECK(Quantized(0.5f) == 128);  // 127.5 exactly: halves go up
}

TEST_CASE("every 8-bit sRGB level survives linear light") {
  for (int level = 0; level < 256; ++level) {
    const double encoded = level / 255.0;
    const double linear =
        encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
    CHECK(Quantized(static_cast<float>(linear), Transfer::kSrgb) == level);
  }
}

TEST_CASE("the ending chooses the format") {
  for (const std::string path : {"a.png", "a.PNG", "/x.y/a.b.pfm", "a.Pfm", ".png"}) {
    CHECK_MESSAGE(CheckPicturePath(path).ok(), path);
  }
  for (const std::string path : {"", "a", "png", "a.jpg", "a.png/b", "a.png.", "a.pngx"}) {
    const Status status = CheckPicturePath(path);
    REQUIRE_MESSAGE(!status.ok(), path);
    CHECK(status.error().kind == ErrorKind::kUsage);
    CHECK(status.error().message.find(".pfm") != std::string::npos);
  }
}

TEST_CASE("PFM keeps every bit") {
  const Folder folder;
  for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {13, 1}, {33, 17}}) {
    Film film = RandomFilm(width, height);
    film.rgb.front() = std::bit_cast<float>(0x7fc12345u);  // a NaN with a payload
    film.rgb.back() = -0.0f;
    const std::string path = folder / "a.pfm";
    REQUIRE(WritePicture(film, Transfer::kSrgb, path).ok());
    const Result<Film> read = ReadPfm(path);
    REQUIRE(read.ok());
    CHECK(read.value().width == width);
    CHECK(read.value().height == height);
    REQUIRE(read.value().rgb.size() == film.rgb.size());
    for (std::size_t i = 0; i < film.rgb.size(); ++i) {
      CHECK(std::bit_cast<std::uint32_t>(read.value().rgb[i]) ==
            std::bit_cast<std::uint32_t>(film.rgb[i]));
    }
  }
  CHECK(folder.FileCount() == 1);
}

TEST_CASE("PFM is laid out as its format says") {
  const Folder folder;
  Film film(1, 2);
  film.rgb = {1.0f, 0.0f, 0.0f, 0.0f, 2.0f, 0.0f};
  REQUIRE(WritePfm(film, folder / "a.pfm").ok());
  const std::string zero(4, '\0');
  const std::string one("\0\0\x80\x3f", 4), two("\0\0\0\x40", 4);
  CHECK(ReadText(folder / "a.pfm") ==
        "PF\n1 2\n-1.0\n" + zero + two + zero + one + zero + zero);  // bottom row first
}

TEST_CASE("PFM of the other byte order reads the same") {
  const Folder folder;
  WriteText(folder / "a.pfm",
            std::string("PF\n1 1\n1.0\n") + std::string("\x3f\x80\0\0\x40\0\0\0\0\0\0\0", 12));
  const Result<Film> read = ReadPfm(folder / "a.pfm");
  REQUIRE(read.ok());
  CHECK(read.value().rgb == decltype(Film::rgb){1.0f, 2.0f, 0.0f});
}

TEST_CASE("damaged PFM files are errors") {
  const Folder folder;
  const std::string pixel(12, '\0');
  const std::string damaged[] = {
      "",
      "PF",
      "Pf\n1 1\n-1.0\n" + pixel,
      "P6\n1 1\n-1.0\n" + pixel,
      "PF\n1\n",
      "PF\n0 1\n-1.0\n" + pixel,
      "PF\n-1 1\n-1.0\n" + pixel,
      "PF\n1 1x\n-1.0\n" + pixel,
      "PF\n65537 1\n-1.0\n" + pixel,
      "PF\n1 99999999999999999999\n-1.0\n" + pixel,
      "PF\n65536 65536\n-1.0\n" + pixel,
      "PF\n1 1\n0\n" + pixel,
      "PF\n1 1\nnan\n" + pixel,
      "PF\n1 1\ninf\n" + pixel,
      "PF\n1 1\n-1.0",
      "PF\n1 1\n-1.0\n",
      "PF\n1 1\n-1.0\n" + pixel.substr(1),
      "PF\n1 1\n-1.0\n" + pixel + "x",
  };
  for (const std::string& bytes : damaged) {
    WriteText(folder / "a.pfm", bytes);
    const Result<Film> read = ReadPfm(folder / "a.pfm");
    REQUIRE_MESSAGE(!read.ok(), bytes);
    CHECK(read.error().kind == ErrorKind::kInputOutput);
    CHECK(read.error().message.starts_with((folder / "a.pfm") + ": "));
  }
  CHECK(!ReadPfm(folder / "absent.pfm").ok());
  CHECK(!ReadPfm(folder / ".").ok());
}

TEST_CASE("PNG gives back the quantised picture and names its writer") {
  const Folder folder;
  for (const Transfer transfer : {Transfer::kLinear, Transfer::kSrgb}) {
    for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {13, 1}, {133, 57}}) {
      const Film film = RandomFilm(width, height);
      REQUIRE(WritePicture(film, transfer, folder / "a.png").ok());
      const Result<Picture8> read = ReadPng(folder / "a.png");
      REQUIRE(read.ok());
      CHECK(read.value().width == width);
      CHECK(read.value().height == height);
      CHECK(read.value().rgb == QuantizeTo8Bit(film, transfer));
    }
    const std::string bytes = ReadText(folder / "a.png");
    CHECK(bytes.find(std::string("Software\0sheaf ", 15) + kVersion) != std::string::npos);
    CHECK((bytes.find("sRGB") != std::string::npos) == (transfer == Transfer::kSrgb));
    CHECK((bytes.find("gAMA") != std::string::npos) == (transfer == Transfer::kLinear));
    const Result<ReadPictureResult> picture = ReadPicture(folder / "a.png");
    REQUIRE(picture.ok());
    CHECK(picture.value().is_srgb == (transfer == Transfer::kSrgb));
    CHECK(picture.value().is_linear == (transfer == Transfer::kLinear));
  }
}

TEST_CASE("a PNG of numbers that are no light says nothing of a transfer") {
  const Folder folder;
  const Film film = RandomFilm(5, 4);
  PictureSpec spec = WholePicture(5, 4, Transfer::kSrgb);
  spec.values = Values::kNumbers;
  REQUIRE(WritePicture(film, spec, folder / "n.png").ok());
  const std::string bytes = ReadText(folder / "n.png");
  CHECK(bytes.find("sRGB") == std::string::npos);
  CHECK(bytes.find("gAMA") == std::string::npos);
  CHECK(ReadPng(folder / "n.png").value().rgb == QuantizeTo8Bit(film, Transfer::kLinear));
}

TEST_CASE("the same film gives the same PNG bytes") {
  const Folder folder;
  const Film film = RandomFilm(40, 30);
  REQUIRE(WritePicture(film, Transfer::kLinear, folder / "a.png").ok());
  REQUIRE(WritePicture(film, Transfer::kLinear, folder / "b.png").ok());
  CHECK(ReadText(folder / "a.png") == ReadText(folder / "b.png"));
}

// Two pixels in a format of libpng's simplified interface; the bytes are what it takes for them.
void WriteForeignPng(const std::string& path, png_uint_32 format, const void* pixels,
                     const void* palette = nullptr, png_uint_32 colours = 0) {
  png_image image = {};
  image.version = PNG_IMAGE_VERSION;
  image.width = 2;
  image.height = 1;
  image.format = format;
  image.colormap_entries = colours;
  REQUIRE(png_image_write_to_file(&image, path.c_str(), 0, pixels, 0, palette) != 0);
}

TEST_CASE("PNG of other pixel formats becomes RGB") {
  const Folder folder;
  const std::string path = folder / "a.png";
  const std::uint8_t grey[] = {10, 200}, rgba[] = {1, 2, 3, 255, 4, 5, 6, 0};
  const std::uint8_t palette[] = {7, 8, 9, 10, 11, 12}, indices[] = {1, 0};

  WriteForeignPng(path, PNG_FORMAT_GRAY, grey);
  REQUIRE(ReadPng(path).ok());
  CHECK(ReadPng(path).value().rgb == std::vector<std::uint8_t>{10, 10, 10, 200, 200, 200});
  WriteForeignPng(path, PNG_FORMAT_RGBA, rgba);
  REQUIRE(ReadPng(path).ok());
  CHECK(ReadPng(path).value().rgb == std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6});
  WriteForeignPng(path, PNG_FORMAT_RGB_COLORMAP, indices, palette, 2);
  REQUIRE(ReadPng(path).ok());
  CHECK(ReadPng(path).value().rgb == std::vector<std::uint8_t>{10, 11, 12, 7, 8, 9});
}

TEST_CASE("damaged PNG files are errors") {
  const Folder folder;
  const std::string path = folder / "a.png";
  REQUIRE(WritePicture(RandomFilm(20, 20), Transfer::kLinear, path).ok());
  const std::string whole = ReadText(path);

  for (std::size_t length = 0; length < whole.size(); length += 7) {
    WriteText(path, whole.substr(0, length));
    const Result<Picture8> read = ReadPng(path);
    REQUIRE_MESSAGE(!read.ok(), length);
    CHECK(read.error().kind == ErrorKind::kInputOutput);
    CHECK(read.error().message.starts_with(path + ": "));
  }
  // Any damaged byte must be survived; most are found by a checksum.
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    WriteText(path, damaged);
    (void)ReadPng(path).ok();
  }
  CHECK(!ReadPng(folder / "absent.png").ok());
  CHECK(!ReadPng(folder / ".").ok());
}

}  // namespace
}  // namespace sheaf
