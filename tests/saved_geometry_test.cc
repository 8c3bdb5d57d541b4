// A geometry that is saved and mapped has the same hits; a file that is not sound is refused.
#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "folder.h"
#include "random_rays.h"
#include "same_geometry.h"
#include "sheaf/geometry.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/geometry_file.h"

namespace sheaf {
namespace {

std::string BytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// What Map says of such a file, without its path.
std::string Refusal(const Folder& folder, const std::string& bytes,
                    MapCheck check = MapCheck::kAll) {
  const std::string path = folder.Write("changed", bytes);
  const Result<Geometry> mapped = Geometry::Map(path, check);
  if (mapped) return "";
  CHECK(mapped.error().kind == ErrorKind::kInputOutput);
  REQUIRE(mapped.error().message.starts_with(path + ": "));
  return mapped.error().message.substr(path.size() + 2);
}

// A file whose bytes can be changed and its checksums made to fit again.
struct Forged {
  std::string bytes;
  bvh::FileHeader header;

  explicit Forged(const std::string& given) : bytes(given) {
    std::memcpy(&header, bytes.data(), sizeof(header));
  }
  template <typename T>
  T* Section(std::uint32_t section) {
    return reinterpret_cast<T*>(bytes.data() + bvh::FileSections(header).offset[section]);
  }
  const std::string& Sealed() {
    const bvh::FileSections sections(header);
    for (std::uint32_t i = 0; i < bvh::kSectionCount; ++i) {
      if (sections.offset[i] + sections.bytes[i] > bytes.size()) continue;
      header.checksums[i] = bvh::ChecksumOf(
          reinterpret_cast<const std::byte*>(bytes.data()) + sections.offset[i], sections.bytes[i]);
    }
    header.header_checksum = bvh::ChecksumOf(header);
    std::memcpy(bytes.data(), &header, sizeof(header));
    return bytes;
  }
};

TEST_CASE_TEMPLATE("a mapped geometry has the same hits", Real, float, double) {
  const Folder folder;
  Random random(31);
  for (const std::uint32_t count : {0u, 1u, 700u}) {
    RandomObjects<Real> objects(random, count);
    if (count > 1) objects.spheres[3] = 0;
    const RandomObjects<Real> original = objects;
    const auto built = GeometryOf<Real>::Build(objects.Input()).value();
    const std::string path = folder / "geometry";
    built.Save(path).value();
    for (const MapCheck check : {MapCheck::kAll, MapCheck::kHeader}) {
      auto mapped = GeometryOf<Real>::Map(path, check).value();
      CheckSame(mapped, built, random);
      CHECK(mapped.object_count() == built.object_count());
      // What it maps outlives the name, and it can be saved and updated like any other.
      mapped.Save(folder / "again").value();
      CHECK(BytesOf(folder / "again") == BytesOf(path));
      if (count == 0) continue;
      MoveObjects(random, 0.05, objects);
      const UpdateOptions options{.rebuild_ratio = std::numeric_limits<double>::infinity()};
      CHECK(mapped.Update(objects.Input(), options).value() == Updated::kRefitted);
      CheckSame(mapped, GeometryOf<Real>::Build(objects.Input()).value(), random);
      objects = original;
    }
    CHECK(folder.FileCount() == 2);
  }
  GeometryOf<Real>().Save(folder / "empty").value();
  CHECK(GeometryOf<Real>::Map(folder / "empty").value().object_count() == 0);
}

TEST_CASE("what is no such file is refused") {
  const Folder folder;
  Random random(2);
  const RandomObjects<float> objects(random, 50);
  Geometry::Build(objects.Input()).value().Save(folder / "g").value();
  const std::string bytes = BytesOf(folder / "g");
  CHECK(Refusal(folder, bytes) == "");
  CHECK(Refusal(folder, "") == "is no saved geometry");
  CHECK(Refusal(folder, "ply\n" + bytes) == "is no saved geometry");
  CHECK(Refusal(folder, bytes.substr(0, 300)) == "is no saved geometry");
  CHECK(Refusal(folder, bytes + "x", MapCheck::kHeader) ==
        std::to_string(bytes.size() + 1) + " bytes, " + std::to_string(bytes.size()) + " expected");
  CHECK(Refusal(folder, bytes.substr(0, bytes.size() - 64), MapCheck::kHeader) ==
        std::to_string(bytes.size() - 64) + " bytes, " + std::to_string(bytes.size()) +
            " expected");
  const Result<GeometryD> doubles = GeometryD::Map(folder / "g");
  REQUIRE(!doubles);
  CHECK(doubles.error().message == folder / "g" + ": has numbers of 4 bytes, not of 8");
  CHECK(!Geometry::Map(folder / "absent").ok());
  CHECK(!Geometry::Map(folder / ".").ok());

  Forged version(bytes);
  version.header.version = 2;
  CHECK(Refusal(folder, version.Sealed()) == "is of version 2 of the format, this reads 1");
  Forged order(bytes);
  order.header.byte_order = 0x04030201;
  CHECK(Refusal(folder, order.Sealed()) == "was saved in another byte order");
  Forged layout(bytes);
  layout.header.layout[0] = 4;
  CHECK(Refusal(folder, layout.Sealed()) == "was saved with another layout of trees");
}

TEST_CASE("a changed byte is found wherever it is") {
  const Folder folder;
  Random random(4);
  const RandomObjects<float> objects(random, 20);
  Geometry::Build(objects.Input()).value().Save(folder / "g").value();
  const std::string bytes = BytesOf(folder / "g");
  const bvh::FileSections sections(Forged(bytes).header);
  std::size_t tried = 0;
  for (std::uint32_t i = 0; i < bvh::kSectionCount; ++i) {
    for (std::uint64_t k = 0; k < sections.bytes[i]; k += 31) {
      std::string changed = bytes;
      changed[sections.offset[i] + k] ^= 0x10;
      CHECK(Refusal(folder, changed).ends_with(" are damaged"));
      ++tried;
    }
  }
  CHECK(tried > 100);
  for (std::size_t k = 24; k < sizeof(bvh::FileHeader); k += 5) {
    std::string changed = bytes;
    changed[k] ^= 0x10;
    CHECK(Refusal(folder, changed, MapCheck::kHeader) == "the header is damaged");
  }
}

TEST_CASE("a forged file cannot lead rays astray") {
  const Folder folder;
  Random random(6);
  const RandomObjects<float> objects(random, 50);
  Geometry::Build(objects.Input()).value().Save(folder / "g").value();
  const std::string bytes = BytesOf(folder / "g");
  const auto refusal = [&](auto change) {
    Forged forged(bytes);
    change(forged);
    return Refusal(folder, forged.Sealed());
  };
  const auto node = [](Forged& forged) { return forged.Section<TreeNode>(bvh::kNodes); };
  const std::uint32_t count = Forged(bytes).header.node_count;
  REQUIRE(count > 2);
  CHECK(refusal([&](Forged& f) { node(f)->child[0] = count; }).find("no node") !=
        std::string::npos);
  CHECK(refusal([&](Forged& f) { node(f)->child[0] = 0; }).find("is a child twice") !=
        std::string::npos);
  CHECK(refusal([&](Forged& f) {
          node(f)->child[0] = MakeLeaf(PrimitiveKind::kDisk, kMaxTreePrimitives - 1, 1);
        }) == "node 0: a leaf beyond the last primitive");
  CHECK(refusal([&](Forged& f) {
          node(f)->child[0] = MakeLeaf(static_cast<PrimitiveKind>(3), 0, 1);
        }) == "node 0: a leaf of no kind");
  CHECK(refusal([&](Forged& f) { node(f)->order[3] = 0; }) ==
        "node 0 has an order that is no permutation");
  CHECK(refusal([&](Forged& f) { node(f)->bounds[0][0] += 100; }) != "");
  CHECK(refusal([&](Forged& f) { f.Section<std::uint32_t>(bvh::kIds)[0] = 1u << 30; }) ==
        "primitive 1073741824 is of another kind");
  CHECK(refusal([&](Forged& f) {
          auto* ids = f.Section<std::uint32_t>(bvh::kIds);
          ids[0] = ids[1];
        }) != "");
  CHECK(refusal([&](Forged& f) { f.Section<float>(bvh::kFields)[0] += 1000; }) != "");
  CHECK(refusal([&](Forged& f) { f.Section<std::uint32_t>(bvh::kFirst)[1] = 7; }) != "");
  CHECK(refusal([&](Forged& f) { f.Section<std::uint32_t>(bvh::kObjectKind)[0] = 9; }) ==
        "object 0 is of no kind");
  CHECK(refusal([&](Forged& f) { f.header.scale = 3; }) == "has a scale that is no power of two");
  CHECK(refusal([&](Forged& f) { f.header.block_count[0] = 0xffffffffu; }).find(" expected") !=
        std::string::npos);
}

}  // namespace
}  // namespace sheaf
