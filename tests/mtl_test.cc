// MTL: what materials become, and what is said of their libraries.
#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "model_files.h"
#include "src/formats/png.h"
#include "src/formats/read_scene.h"
#include "src/formats/write_scene_json.h"

namespace sheaf {
namespace {

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
const std::string kFace = "f 1/1 2/2 3/3\n";

struct Read {
  Material material;  // of the first object
  Mesh mesh;
  std::vector<std::string> warnings;  // without the folder
};

Read ReadObj(const Folder& folder, const std::string& obj) {
  const Result<ReadSceneResult> read = ReadScene(folder.Write("a.obj", obj));
  CAPTURE(MessageOf(read));
  REQUIRE(read.ok());
  const Scene& scene = read.value().scene;
  std::vector<std::string> warnings = read.value().warnings;
  for (std::string& warning : warnings) {
    REQUIRE(warning.starts_with(folder / ""));
    warning.erase(0, (folder / "").size());
  }
  return {scene.materials.at(scene.objects.at(0).material), MeshAt(scene, 0), warnings};
}

// The material m of these statements.
Read ReadMtl(const Folder& folder, const std::string& statements) {
  folder.Write("a.mtl", "newmtl m\n" + statements);
  return ReadObj(folder, "mtllib a.mtl\nusemtl m\n" + kTriangle + kFace);
}

Colour ColourOf(const Read& read) { return std::get<Colour>(read.material.base_colour); }

TEST_CASE("MTL: highlights need an exponent and an illumination model that has them") {
  const Folder folder;
  const std::string shiny = "Kd 0.5 0.4 0.3\nKs 1 0.5 0\n";
  const auto ks = [&](const std::string& more) {
    return ReadMtl(folder, shiny + more).material.ks;
  };
  CHECK(ks("Ns 20\n") == 1);
  CHECK(ks("Ns 20\nillum 2\n") == 1);
  CHECK(ks("Ns 0\nillum 2\n") == 0);
  CHECK(ks("illum 2\n") == 0);
  CHECK(ks("Ns 20\nillum 1\n") == 0);
  CHECK(ks("Ns 20\nillum 0\n") == 0);
  CHECK(ReadMtl(folder, shiny + "illum 3\n").material.reflect == Colour(1, 0.5, 0));
}

TEST_CASE("MTL: what would hide a material wholly is opaque, unless it is glass") {
  const Folder folder;
  const auto opaque = [&](const std::string& statements, const std::string& warning) {
    const Read read = ReadMtl(folder, "Kd 1 0 0\n" + statements);
    CHECK(read.material.transmit == Colour(0.0));
    CHECK(read.material.kd == 1);
    CHECK(read.warnings ==
          std::vector<std::string>{"a.mtl:1: material taken for opaque: " + warning});
  };
  opaque("Tr 1.0\nillum 1\n", "Tr 1 hides \"m\" wholly");
  opaque("d 0\n", "d 0 hides \"m\" wholly");
  const auto transmits = [&](const std::string& statements) {
    const Read read = ReadMtl(folder, statements);
    CHECK(read.warnings.empty());
    return read.material.transmit.x;
  };
  CHECK(transmits("Tr 1\nillum 7\nNi 1.5\n") == 1);
  CHECK(transmits("d 0\nillum 4\n") == 1);
  CHECK(transmits("Tr 0.25\n") == 0.25);
  CHECK(transmits("d 1\nTr 1\n") == 0);  // d decides
  CHECK(transmits("Tr 1\nd 1\n") == 0);
  CHECK(transmits("d -halo 0.75\n") == 0.25);
}

TEST_CASE("MTL: a material without a colour is grey; one number is all three") {
  const Folder folder;
  const Colour grey = std::get<Colour>(PlainMaterial().base_colour);
  CHECK(ColourOf(ReadMtl(folder, "Ns 5\n")) == grey);
  CHECK(ColourOf(ReadMtl(folder, "Kd 0.5\n")) == Colour(0.5));
  CHECK(ColourOf(ReadMtl(folder, "Kd 0.5 # dull\n")) == Colour(0.5));
  CHECK(ColourOf(ReadMtl(folder, "Kd 0 0 0\n")) == Colour(0.0));
  const Read bad = ReadMtl(folder, "Kd 1 x 1\nNs inf\n");
  CHECK(ColourOf(bad) == grey);
  CHECK(bad.warnings ==
        std::vector<std::string>{"a.mtl:2: Kd: expected a number in [-1e6, 1e6], found \"x\"",
                                 "a.mtl:3: Ns: expected a number in [-1e6, 1e9], found \"inf\""});
}

TEST_CASE("MTL: a texture that cannot be read leaves the colour, with a warning") {
  const Folder folder;
  folder.Write("t.bmp", "BM nothing");
  const Read missing = ReadMtl(folder, "Kd 0.8 0.3 0.1\nmap_Kd gone.png\n");
  CHECK(ColourOf(missing) == Colour(0.8, 0.3, 0.1));
  REQUIRE(missing.warnings.size() == 1);
  CHECK(missing.warnings[0] == "a.mtl:3: map_Kd: " + (folder / "gone.png") +
                                   ": cannot open: No such file or directory; untextured");
  const Read other = ReadMtl(folder, "Kd 0 0 0\nmap_Kd t.bmp\n");
  CHECK(ColourOf(other) == std::get<Colour>(PlainMaterial().base_colour));  // not black
  REQUIRE(other.warnings.size() == 1);
  CHECK(other.warnings[0].starts_with("a.mtl:3: map_Kd: t.bmp: "));
  const Read outside = ReadMtl(folder, "Kd 1 0 0\nmap_Kd ../t.png\n");
  REQUIRE(outside.warnings.size() == 1);
  CHECK(outside.warnings[0].find("outside the scene's folder") != std::string::npos);
}

TEST_CASE("MTL: options of a texture, and names with blanks and backslashes") {
  const Folder folder;
  folder.Write("sub/a b.png", kRedPng);
  folder.Write("t#1.png", kRedPng);
  const auto texture = [](const Read& read) {
    CHECK(read.warnings.empty());
    return std::get<Texture>(read.material.base_colour);
  };
  const Read scaled =
      ReadMtl(folder, "Kd 1 1 1\nmap_Kd -s 4 2 1 -clamp on -o 0.1 -bm 2 sub\\a b.png\n");
  CHECK(texture(scaled).wrap_u == Wrap::kClamp);
  const TextureTransform placed = texture(scaled).transform;
  CHECK(placed.scale == glm::dvec2(4, 2));
  CHECK(placed.offset == glm::dvec2(0.1, -1));  // v runs up in the file
  const Read plain = ReadMtl(folder, "map_Kd .\\sub\\a b.png # bricks\n");
  CHECK(texture(plain).factor == Colour(1.0));
  CHECK(plain.mesh.uv[2] == glm::vec2(0, 0));
  CHECK(texture(ReadMtl(folder, "Kd 0 0 0\nmap_Kd t#1.png\n")).factor == Colour(1.0));
  const Read odd = ReadMtl(folder, "map_Kd -mm 0.2 2 t#1.png\n");
  CHECK(odd.warnings ==
        std::vector<std::string>{"a.mtl:2: an option of a texture is not read: -mm"});
}

TEST_CASE("MTL: textures that nothing shows are said, of materials in use alone") {
  const Folder folder;
  folder.Write("t.png", kRedPng);
  const std::string other = "newmtl unused\nmap_Ks t.png\nmap_Kd gone.png\n";
  const Read read = ReadMtl(folder, "map_Kd t.png\nmap_Ka t.png\nmap_Ns t.png\n" + other);
  CHECK(read.warnings == std::vector<std::string>{"a.mtl:4: map_Ns is not read"});
}

// Writes a picture of two texels, of 3 or 4 channels.
void WriteTwo(const std::string& path, std::vector<std::uint8_t> bytes) {
  const int channels = static_cast<int>(bytes.size() / 2);
  REQUIRE(WritePng({2, 1, std::move(bytes), channels}, Transfer::kSrgb, path).ok());
}

TEST_CASE("MTL: textures of emission and normals") {
  const Folder folder;
  folder.Write("t.png", kRedPng);
  WriteTwo(folder / "grey.png", {9, 9, 9, 80, 80, 80});
  const Read glowing = ReadMtl(folder, "map_Ke t.png\n");
  CHECK(glowing.material.emission == Colour(1.0));
  REQUIRE(glowing.material.emission_texture.has_value());
  CHECK(glowing.material.emission_texture->transfer == Transfer::kSrgb);
  CHECK(ReadMtl(folder, "Ke 0 2 0\nmap_Ke t.png\n").material.emission == Colour(0, 2, 0));
  CHECK(ReadMtl(folder, "Ke 0 2 0\nmap_Ke gone.png\n").material.emission == Colour(0, 2, 0));
  CHECK(ReadMtl(folder, "map_Ke gone.png\n").material.emission == Colour(0.0));

  const Read bumpy = ReadMtl(folder, "map_Bump -bm 0.5 t.png\n");
  REQUIRE(bumpy.material.normal_map.has_value());
  CHECK(bumpy.material.normal_map->scale == 0.5);
  CHECK(bumpy.material.normal_map->texture.transfer == Transfer::kLinear);
  const Read best = ReadMtl(folder, "bump grey.png\nnorm -s 2 2 t.png\n");
  CHECK(best.warnings.empty());
  CHECK(best.material.normal_map->texture.transform.scale == glm::dvec2(2));
  const Read heights = ReadMtl(folder, "bump grey.png\n");
  CHECK(!heights.material.normal_map.has_value());
  CHECK(heights.warnings == std::vector<std::string>{"a.mtl:2: bump: heights are not read"});
}

TEST_CASE("MTL: a texture of opacity is the alpha of the base colour") {
  const Folder folder;
  folder.Write("t.png", kRedPng);
  WriteTwo(folder / "cut.png", {0, 0, 0, 255, 255, 255});
  WriteTwo(folder / "soft.png", {30, 60, 90, 255, 255, 255});
  WriteTwo(folder / "own.png", {1, 2, 3, 7, 4, 5, 6, 255});
  const auto texels = [](const Read& read) {
    CHECK(read.warnings.empty());
    CHECK(read.material.transmit == Colour(0.0));
    return std::get<Texture>(read.material.base_colour).image->texels;
  };
  using Texels = std::vector<std::uint32_t>;
  const Read cut = ReadMtl(folder, "Kd 0 1 0\nmap_d -clamp on cut.png\n");
  CHECK(texels(cut) == Texels{0x00ffffff, 0xffffffff});
  CHECK(std::get<Texture>(cut.material.base_colour).factor == Colour(0, 1, 0));
  CHECK(std::get<Texture>(cut.material.base_colour).wrap_u == Wrap::kClamp);
  CHECK(cut.material.alpha.mode == AlphaMode::kMask);
  const Read soft = ReadMtl(folder, "map_Kd t.png\nmap_d soft.png\n");
  CHECK(texels(soft) == Texels{0x3c0000ff, 0xff0000ff});
  CHECK(soft.material.alpha.mode == AlphaMode::kBlend);
  const Read own = ReadMtl(folder, "map_Kd own.png\nmap_d own.png\n");
  CHECK(texels(own) == Texels{0x07030201, 0xff060504});
  CHECK(own.material.alpha.mode == AlphaMode::kBlend);
  CHECK(texels(ReadMtl(folder, "map_Kd t.png\nmap_d own.png\n")) == Texels{0x070000ff, 0xff0000ff});
  const Read half = ReadMtl(folder, "d 0.5\nmap_Kd t.png\nmap_d cut.png\n");
  CHECK(texels(half).size() == 2);
  CHECK(half.material.alpha.mode == AlphaMode::kBlend);
  CHECK(half.material.alpha.factor == 0.5);
  // Nothing is cut away.
  CHECK(ReadMtl(folder, "map_Kd t.png\nmap_d t.png\n").material.alpha.mode == AlphaMode::kOpaque);
  CHECK(ReadMtl(folder, "d 0.5\nmap_d gone.png\n").material.transmit == Colour(0.5));
  const Read placed = ReadMtl(folder, "map_Kd t.png\nmap_d -s 2 2 cut.png\n");
  CHECK(placed.warnings == std::vector<std::string>{"a.mtl:3: map_d: placed as map_Kd is"});
}

TEST_CASE("MTL: names of materials and libraries with blanks, marks and comments") {
  const Folder folder;
  const std::string red =
      "newmtl Red Paint\nKd 1 0 0\nnewmtl m\nKd 0 1 0\nnewmtl n #25\nKd 0 0 1\n";
  folder.Write("my lib.mtl", red);
  folder.Write("mark.mtl", "\xef\xbb\xbf" + red);
  folder.Write("sub/cr.mtl", [text = red]() mutable {
    for (char& c : text) c = c == '\n' ? '\r' : c;
    return text;
  }());
  folder.Write("b.mtl", "newmtl other\n");
  const auto colour = [&](const std::string& library, const std::string& name) {
    const Read read = ReadObj(folder, library + "\nusemtl " + name + "\n" + kTriangle + kFace);
    CHECK(read.warnings.empty());
    return ColourOf(read);
  };
  for (const std::string library :
       {"mtllib my lib.mtl", "mtllib mark.mtl # all", "mtllib b.mtl mark.mtl", "mtllib sub\\cr.mtl",
        "\xef\xbb\xbfmtllib my lib.mtl  ", "mtllib mark.mtl\nmtllib mark.mtl"}) {
    CAPTURE(library);
    CHECK(colour(library, "Red Paint") == Colour(1, 0, 0));
    CHECK(colour(library, "m") == Colour(0, 1, 0));
    CHECK(colour(library, "m # the green one") == Colour(0, 1, 0));
    CHECK(colour(library, "n #25") == Colour(0, 0, 1));
  }
  // The library after the faces that use it.
  CHECK(ColourOf(ReadObj(folder, "usemtl m\n" + kTriangle + kFace + "mtllib mark.mtl\n")) ==
        Colour(0, 1, 0));
}

TEST_CASE("MTL: whatever a library holds, the scene is one that can be rendered") {
  const Folder folder;
  folder.Write("t.png", kRedPng);
  const std::string whole =
      "newmtl m\nKd 0.5 1 2\nKs 1 1 1\nNs 1e9\nKe 1e9 0 0\nd 0.5\nNi 1e-9\nillum 7\n"
      "map_Kd -s 4e5 -4e5 -o 1e30 0 -clamp on t.png\nmap_d -s 2 t.png\nmap_Bump -bm 9 t.png\n";
  Random random(7);
  for (int round = 0; round < 300; ++round) {
    std::string changed = whole;
    for (int flips = 0; flips < round % 5; ++flips) {
      changed[10 + random() % (changed.size() - 10)] = "0123456789.-e \n\\#\0\xff"[random() % 19];
    }
    folder.Write("a.mtl", changed);
    const auto read = ReadScene(folder.Write(
        "a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle + "vt 1e30 -1e30\nf 1/1 2/2 3/4\n"));
    CAPTURE(changed);
    REQUIRE(read.ok());
    const Status valid = Validate(read.value().scene);
    CAPTURE((valid ? "" : valid.error().message));
    CHECK(valid.ok());
  }
}

TEST_CASE("MTL: what is read can be written as scene JSON and read again") {
  const Folder folder;
  for (const char* statement :
       {"Kd 2e6 1 1\n", "Kd 1e6 1 1\n", "Ks 2e6 0 0\nNs 5\n", "Ke 1e7 0 0\n", "Ns 1e9\n",
        "Ns 2e9\n", "d 0.5\nNi 1e9\n", "Kd -5 0 0\n"}) {
    CAPTURE(statement);
    folder.Write("a.mtl", std::string("newmtl m\n") + statement);
    const auto read =
        ReadScene(folder.Write("a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle + kFace));
    REQUIRE(read.ok());
    const Result<Scene> again = ParseSceneJson(SceneJsonText(read.value().scene), "again.json");
    CAPTURE((again ? "" : again.error().message));
    CHECK(again.ok());
  }
}

#ifdef __linux__
TEST_CASE("MTL: a library that the disk fails to give is an error") {
  const Folder folder;
  // Nothing lies at address 0: reading there is an I/O error.
  std::filesystem::create_symlink("/proc/self/mem", folder / "a.mtl");
  ReadOptions options;
  options.outside = Outside::kAllowed;
  const auto read =
      ReadScene(folder.Write("a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle + kFace), options);
  REQUIRE_FALSE(read.ok());
  CHECK(read.error().kind == ErrorKind::kInputOutput);
  CHECK(read.error().message == (folder / "a.mtl") + ": cannot read: Input/output error");
}
#endif

TEST_CASE("MTL: libraries that are not there are warnings") {
  const Folder folder;
  folder.Write("b.mtl", "newmtl m\nKd 1 0 0\n");
  const auto warning = [&](const std::string& library) {
    const Read read = ReadObj(folder, library + "\nusemtl m\n" + kTriangle + kFace);
    REQUIRE(read.warnings.size() == 1);
    return read.warnings[0];
  };
  CHECK(warning("mtllib no.mtl") ==
        "a.obj:1: mtllib: " + (folder / "no.mtl") + ": cannot open: No such file or directory");
  CHECK(warning("mtllib no one.mtl").find("no one.mtl: cannot open") != std::string::npos);
  CHECK(warning("mtllib b.mtl no.mtl").find("/no.mtl: cannot open") != std::string::npos);
  CHECK(warning("mtllib ../secret.mtl").find("outside the scene's folder") != std::string::npos);
  CHECK(warning("mtllib").find("no name of a file") != std::string::npos);
}

}  // namespace
}  // namespace sheaf
