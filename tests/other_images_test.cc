// Pictures that are neither PNG nor JPEG, as textures and as surroundings: what they show where
// OpenImageIO is built in, and what is said where it is not.
#include "src/formats/other_images.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "model_files.h"
#include "src/core/build_info.h"
#include "src/formats/image.h"

namespace sheaf {
namespace {

bool HasPart(const std::string& name) {
  for (const OptionalPart& part : OptionalParts()) {
    if (part.name == name) return part.is_built_in;
  }
  FAIL("no part of that name");
  return false;
}

std::string Bytes(std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text.push_back(static_cast<char>(byte));
  return text;
}

// Each two by two: red and green above blue and grey 102.

std::string Bmp() {
  return "BM" +
         Bytes({70, 0, 0, 0, 0, 0, 0,  0, 54, 0, 0, 0, 40, 0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 1, 0,
                24, 0, 0, 0, 0, 0, 16, 0, 0,  0, 0, 0, 0,  0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}) +
         Bytes({255, 0, 0, 102, 102, 102, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0});
}

// From the bottom, with alpha 128 in the first texel above.
std::string Tga() {
  return Bytes({0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 2, 0, 32, 8}) +
         Bytes({255, 0, 0, 255, 102, 102, 102, 255, 0, 0, 255, 128, 0, 255, 0, 255});
}

std::string Tiff() {
  const auto entry = [](int tag, int type, int count, int value) {
    return Bytes({tag & 255, tag >> 8, type, 0, count, 0, 0, 0, value & 255, value >> 8, 0, 0});
  };
  const int data = 8 + 2 + 10 * 12 + 4;
  return "II*" + Bytes({0, 8, 0, 0, 0, 10, 0}) + entry(256, 3, 1, 2) + entry(257, 3, 1, 2) +
         entry(258, 3, 3, data + 12) + entry(259, 3, 1, 1) + entry(262, 3, 1, 2) +
         entry(273, 4, 1, data) + entry(277, 3, 1, 3) + entry(278, 3, 1, 2) + entry(279, 4, 1, 12) +
         entry(284, 3, 1, 1) + Bytes({0, 0, 0, 0}) +
         Bytes({255, 0, 0, 0, 255, 0, 0, 0, 255, 102, 102, 102}) + Bytes({8, 0, 8, 0, 8, 0});
}

// One row of light: (2, 1, 0.5) and (0.5, 0.5, 0.5).
std::string Hdr() {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
         Bytes({128, 64, 32, 130, 128, 128, 128, 128});
}

constexpr std::uint32_t kRed = 0xff0000ff, kGreen = 0xff00ff00, kBlue = 0xffff0000,
                        kGrey = 0xff666666;

TEST_CASE("what bytes are is known by how they begin") {
  CHECK(OtherImageKind(Bmp()) == std::string("a BMP"));
  CHECK(OtherImageKind(Tga()) == std::string("a TGA"));
  CHECK(OtherImageKind(Tiff()) == std::string("a TIFF"));
  CHECK(OtherImageKind(Hdr()) == std::string("a Radiance HDR"));
  CHECK(OtherImageKind("RIFF0000WEBPVP8 ") == std::string("a WebP"));
  CHECK(OtherImageKind("\x76\x2f\x31\x01") == std::string("an OpenEXR"));
  CHECK(OtherImageKind("") == nullptr);
  CHECK(OtherImageKind("a text of more than eighteen bytes") == nullptr);
}

TEST_CASE("without OpenImageIO a message names what is missing") {
  if (HasPart("OpenImageIO")) return;
  MESSAGE("skipped: no OpenImageIO in this build, so that only its absence is tested");
  for (const std::string& bytes : {Bmp(), Tga(), Tiff(), Hdr()}) {
    for (const bool is_light : {false, true}) {
      const std::string message =
          is_light ? DecodeOtherLight(bytes).error().message : DecodeImage(bytes).error().message;
      CHECK(message.find("OpenImageIO") != std::string::npos);
      CHECK(message.find(OtherImageKind(bytes)) != std::string::npos);
    }
  }
}

Image DecodeOrFail(const std::string& bytes) {
  const Result<Image> image = DecodeImage(bytes);
  if (!image) FAIL(image.error().message);
  return image.value();
}

TEST_CASE("BMP, TGA, TIFF and light as textures") {
  if (!HasPart("OpenImageIO")) return;
  for (const std::string& bytes : {Bmp(), Tga(), Tiff()}) {
    CAPTURE(OtherImageKind(bytes));
    const Image image = DecodeOrFail(bytes);
    REQUIRE(image.width == 2);
    REQUIRE(image.height == 2);
    const std::uint32_t first = bytes == Tga() ? 0x800000ff : kRed;
    CHECK(image.texels == std::vector<std::uint32_t>{first, kGreen, kBlue, kGrey});
  }
  const Image light = DecodeOrFail(Hdr());
  REQUIRE(light.texels.size() == 2);
  // Above 1 is white; a half is 188 of sRGB.
  CHECK(light.texels[0] == 0xffbcffff);
  CHECK(light.texels[1] == 0xffbcbcbc);
  CHECK(!DecodeImage(Bmp().substr(0, 40)));
  CHECK(!DecodeImage(Tiff().substr(0, 40)));
}

TEST_CASE("a scene takes them as textures and as surroundings") {
  const Folder folder;
  folder.Write("t.tga", Tga());
  folder.Write("sky.hdr", Hdr());
  const std::string textured = folder.Write(
      "t.json", R"({"materials": [{"name": "a", "base_colour": {"texture": {"image": "t.tga"}}}],
                    "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})");
  const std::string lit =
      folder.Write("s.json", R"({"settings": {"environment": {"map": {"image": "sky.hdr"}}},
                    "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})");
  if (!HasPart("OpenImageIO")) {
    CheckRefused(textured, "OpenImageIO");
    CheckRefused(lit, "OpenImageIO");
    return;
  }
  const Scene scene = ReadOrFail(textured);
  CHECK(std::get<Texture>(scene.materials[0].base_colour).image->texels[1] == kGreen);
  const Scene sky = ReadOrFail(lit);
  const auto& map = std::get<EnvironmentMap>(*sky.settings.environment);
  REQUIRE(map.image->rgb.size() == 6);
  CHECK(map.image->rgb[0] == doctest::Approx(2).epsilon(0.01));
  CHECK(map.image->rgb[5] == doctest::Approx(0.5).epsilon(0.01));
}

}  // namespace
}  // namespace sheaf
