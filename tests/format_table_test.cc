// The table of formats is whole, and the documentation follows it.
#include "src/formats/format_table.h"

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace sheaf {
namespace {

TEST_CASE("an ending, in any case, names one format") {
  std::set<std::string> seen;
  for (const FileFormat& format : FileFormats()) {
    REQUIRE_FALSE(format.endings.empty());
    for (const std::string& ending : format.endings) {
      CAPTURE(ending);
      CHECK(seen.insert(ending).second);
      CHECK(FormatOf("a.b/c" + ending) == &format);
      std::string loud = ending;
      for (char& c : loud) c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
      CHECK(FormatOf("C" + loud) == &format);
      CHECK(FormatOf("c" + ending + "x") == nullptr);
    }
  }
  CHECK(FormatOf("png") == nullptr);
  CHECK(FormatOf("") == nullptr);
}

TEST_CASE("a format has the readers and writers of its content") {
  for (const FormatRow& row : FormatTable()) {
    CAPTURE(row.format.name);
    const bool is_picture = row.format.content == FileContent::kPicture;
    CHECK((row.parse != nullptr) == !is_picture);
    CHECK((row.read_picture != nullptr) == is_picture);
    CHECK((row.create_encoder != nullptr) == is_picture);
    CHECK(row.format.bits.empty() == !is_picture);
  }
}

TEST_CASE("messages list what the table has") {
  CHECK(PictureEndings() == ".png, .pfm or .exr");
  CHECK(SceneEndings() == ".json, .nff, .obj, .ply, .gltf or .glb");
  CHECK(BitsText() == ".png 8 or 16, .pfm 32, .exr 16 or 32");
}

TEST_CASE("docs/formats.md names every format and ending") {
  std::ifstream file(SHEAF_SOURCE_DIR "/docs/formats.md", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  for (const FileFormat& format : FileFormats()) {
    CHECK_MESSAGE(text.find(format.name) != std::string::npos, format.name);
    for (const std::string& ending : format.endings) {
      CHECK_MESSAGE(text.find("`" + ending + "`") != std::string::npos, ending);
    }
  }
}

}  // namespace
}  // namespace sheaf
