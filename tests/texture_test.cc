// Textures: where their texels land, to the bit on every target.
#include <doctest/doctest.h>

#include <string>

#include "model_files.h"
#include "same_bits.h"
#include "src/formats/png.h"

namespace sheaf {
namespace {

Picture8 Chequered() {
  Picture8 picture{4, 2, {}};
  for (int i = 0; i < 8; ++i) {
    for (const int c : {40 * (i % 4), 120 * (i / 4), 255 - 30 * i}) {
      picture.rgb.push_back(static_cast<std::uint8_t>(c));
    }
  }
  return picture;
}

TEST_CASE("textures, wraps and filters have the same bits on every target") {
  const Folder folder;
  REQUIRE(WritePng(Chequered(), Transfer::kLinear, folder / "t.png").ok());
  for (const char* wrap : {"\"repeat\"", "\"mirror\"", "[\"clamp\", \"repeat\"]"}) {
    for (const char* filter : {"linear", "nearest", "mip"}) {
      const std::string text = std::string(R"({"materials": [{"name": "a", "kd": 0.5, "ambient": 1,
        "base_colour": {"texture": {"image": "t.png", "wrap": )") +
                               wrap + R"(, "filter": ")" + filter +
                               R"(", "factor": [1, 0.5, 1]}}}],
        "settings": {"ambient": 1},
        "objects": [{"material": "a", "mesh": {"positions": [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]],
          "uv": [[-1.3,2.1],[2.2,2.1],[2.2,-1.7],[-1.3,-1.7]], "triangles": [[0,1,2],[0,2,3]]}}],
        "lights": [{"spot": {"position": [0,0,3], "direction": [0,0.1,-1], "outer": 40}, "intensity": 4}],
        "cameras": [{"name": "c", "eye": [0.2,0.1,5], "look_at": [0,0,0]}]})";
      const Scene scene = ReadOrFail(folder.Write("t.json", text));
      RenderOptions options;
      options.width = 70, options.height = 50;
      CheckSameBits(scene, scene.cameras[0], options);
    }
  }
}

TEST_CASE("a texture's texels land where they belong") {
  const Folder folder;
  REQUIRE(WritePng(Chequered(), Transfer::kLinear, folder / "t.png").ok());
  // Straight on, four pixels by two: each shows the middle of one texel.
  const Scene scene =
      ReadOrFail(folder.Write("t.json", R"({"settings": {"ambient": 1, "size": [4, 2]},
    "materials": [{"name": "a", "ambient": 1,
      "base_colour": {"texture": {"image": "t.png", "srgb": false}}}],
    "objects": [{"material": "a", "mesh": {"positions": [[-2,-1,0],[2,-1,0],[2,1,0],[-2,1,0]],
      "uv": [[0,1],[1,1],[1,0],[0,0]], "triangles": [[0,1,2],[0,2,3]]}}],
    "cameras": [{"name": "c", "eye": [0,0,5], "look_at": [0,0,0], "orthographic": {"height": 2}}]})"));
  RenderOptions options;
  options.width = 4, options.height = 2;
  const Film film = RenderOrFail(scene, scene.cameras[0], options);
  const Picture8 picture = Chequered();
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    CHECK(film.rgb[i] == doctest::Approx(picture.rgb[i] / 255.0).epsilon(1e-5));
  }
}

TEST_CASE("images that are none") {
  const Folder folder;
  const auto refused = [&](const std::string& bytes, const std::string& part) {
    folder.Write("t.png", bytes);
    CheckRefused(folder.Write("t.json", R"({"materials": [{"name": "a",
      "base_colour": {"texture": {"image": "t.png"}}}], "cameras": []})"),
                 part);
  };
  refused("", "neither a PNG nor a JPEG");
  refused("\x89PNG\r\n\x1a\n", ":2: /materials/0/base_colour/texture/image");
  refused("\xff\xd8\xff\xe0 no more", "image");
  // A header that claims 65,000 x 65,000.
  REQUIRE(WritePng(Chequered(), Transfer::kLinear, folder / "big.png").ok());
  std::ifstream file(folder / "big.png", std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  bytes[18] = bytes[22] = '\xfd', bytes[19] = bytes[23] = '\xe8';
  refused(bytes, "image");
}

}  // namespace
}  // namespace sheaf
