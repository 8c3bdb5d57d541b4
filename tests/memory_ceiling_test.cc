// What a file claims of itself is not believed: reading takes at most 8 times its size and 64 MiB,
// beside what it describes; --memory-limit holds for everything.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/run_command.h"

namespace sheaf {
namespace {

// The most that any command of this test has taken.
long PeakMegabytes() {
  rusage usage;
  REQUIRE(getrusage(RUSAGE_CHILDREN, &usage) == 0);
  return usage.ru_maxrss / 1024;
}

// The command alone takes some ten.
constexpr long kMostMegabytes = 64 + 24;

std::string Little32(std::uint32_t number) {
  std::string bytes;
  for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(number >> 8 * i & 255));
  return bytes;
}
std::string Big32(std::uint32_t number) {
  const std::string little = Little32(number);
  return {little.rbegin(), little.rend()};
}

void CheckRefused(const std::string& bytes, const std::string& ending, const std::string& reason) {
  const Workspace work;
  const std::string path = work / ("a" + ending);
  WriteText(path, bytes);
  const Outcome outcome = work.Run({"convert", path, "-o", work / "b.pfm"});
  CAPTURE(outcome.err);
  CHECK(outcome.code == 4);
  CHECK(LineCount(outcome.err) == 1);
  CHECK(Contains(outcome.err, reason));
  CHECK(PeakMegabytes() < kMostMegabytes);
}

// ---- PNG ----

const std::string kPngStart = "\x89PNG\r\n\x1a\n" + Big32(13) + "IHDR" + Big32(1) + Big32(1) +
                              std::string("\x08\x02\0\0\0\x90\x77\x53\xde", 9);

TEST_CASE("a chunk of a PNG that claims 2 GiB") {
  CheckRefused(kPngStart + Big32(0x7fffffff) + "iTXt", ".png", "cut short");
  CheckRefused(kPngStart + Big32(0x7fffffff) + "zTXt" + std::string(100, 'a'), ".png", "cut short");
}

// ---- OpenEXR ----

std::string Attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + Little32(static_cast<std::uint32_t>(value.size())) + value;
}

struct Exr {
  std::uint32_t flags = 0, width = 1, height = 1;
  char compression = 3;
  std::string more;  // attributes

  std::string Bytes() const {
    const std::string box = Little32(0) + Little32(0) + Little32(width - 1) + Little32(height - 1);
    const std::string channel = std::string("Y\0", 2) + Little32(2) + Little32(0) + Little32(1) +
                                Little32(1) + std::string(1, '\0');
    return "v/1\x01" + Little32(2 | flags) + Attribute("channels", "chlist", channel) +
           Attribute("compression", "compression", std::string(1, compression)) +
           Attribute("dataWindow", "box2i", box) + Attribute("displayWindow", "box2i", box) +
           Attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           Attribute("pixelAspectRatio", "float", Little32(0x3f800000)) +
           Attribute("screenWindowCenter", "v2f", Little32(0) + Little32(0)) +
           Attribute("screenWindowWidth", "float", Little32(0x3f800000)) + more + '\0';
  }
};

constexpr std::uint32_t kTiled = 0x200, kDeep = 0x800;

TEST_CASE("headers of OpenEXR that claim gigabytes") {
  if (!FormatOf("a.exr")->is_built_in) return;
  Exr attribute;
  attribute.more = std::string("owner\0string\0", 13) + Little32(0x7ffffff0) + "me";
  CheckRefused(attribute.Bytes(), ".exr", "attribute \"owner\" claims 2147483632 bytes");
  attribute.more = std::string("owner\0string\0", 13) + Little32(0xfffffff0) + "me";
  CheckRefused(attribute.Bytes(), ".exr", "claims -16 bytes");

  // Sizes that the library does not look at: it would take the rest for other attributes.
  Exr beyond;
  beyond.more = Attribute("owner", "float", std::string(40, 'a'));
  CheckRefused(beyond.Bytes(), ".exr", "\"owner\" is malformed");
  beyond.more = Attribute("more", "chlist", std::string("R\0", 2) + std::string(30, 'a'));
  CheckRefused(beyond.Bytes(), ".exr", "\"more\" is malformed");

  Exr preview;
  preview.more = Attribute("preview", "preview", Little32(20000) + Little32(20000) + "abcd");
  CheckRefused(preview.Bytes(), ".exr", "preview");

  Exr table;
  table.width = table.height = 65536;
  table.compression = 0;
  CheckRefused(table.Bytes(), ".exr", "more pixels than its bytes can hold");
  table.height = 0x7fffffff;
  CheckRefused(table.Bytes(), ".exr", "");

  Exr tiles;
  tiles.flags = kTiled;
  tiles.more = Attribute("tiles", "tiledesc", Little32(1) + Little32(1) + std::string(1, '\0'));
  tiles.width = tiles.height = 30000;
  CheckRefused(tiles.Bytes(), ".exr", "more pixels than its bytes can hold");
  tiles.width = tiles.height = 8;
  tiles.more =
      Attribute("tiles", "tiledesc", Little32(40000) + Little32(40000) + std::string(1, '\0'));
  CheckRefused(tiles.Bytes(), ".exr", "tiles claim more memory");

  Exr lines;
  lines.compression = 9;  // packs 256 lines
  lines.width = 0x7fffff;
  CheckRefused(lines.Bytes(), ".exr", "");

  Exr deep;
  deep.flags = kDeep;
  CheckRefused(deep.Bytes(), ".exr", "deep data");
}

// ---- The limit ----

#ifdef __linux__
TEST_CASE("--memory-limit: one line and exit code 3") {
  const Workspace work;
  const auto render = [&](const std::string& limit, const std::string& size) {
    return work.Run({"render", kScene, "--camera", "front", "--size", size, "--threads", "1", "-q",
                     "--denoise", "--memory-limit", limit, "-o", work / "a.png"});
  };
  CHECK(render("1G", "32x32").code == 0);
  const Outcome beyond = render("96M", "2048x2048");
  CHECK(beyond.code == 3);
  CHECK(beyond.err == "sheaf: needs more than --memory-limit 96M\n");
  for (const std::string wrong : {"0", "12Q", "-1", "", "9T9", "99999999999T"}) {
    CHECK(render(wrong, "32x32").code == 2);
  }
}
#endif

}  // namespace
}  // namespace sheaf
