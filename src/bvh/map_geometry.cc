// A saved geometry where it lies in its file. Nothing is believed of it before it is checked.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <utility>

#include "src/bvh/geometry_access.h"
#include "src/bvh/geometry_file.h"
#include "src/bvh/validate_tree.h"
#include "src/core/mapped_file.h"

namespace sheaf {
namespace {

using bvh::FileHeader;
using bvh::FileSections;

// "" or what is wrong with the header of a file of so many bytes.
std::string HeaderFault(const FileHeader& header, std::size_t size, std::size_t real_bytes) {
  if (std::memcmp(header.magic, bvh::kFileMagic, sizeof(header.magic)) != 0) {
    return "is no saved geometry";
  }
  if (header.byte_order != bvh::kFileByteOrder) return "was saved in another byte order";
  if (header.version != bvh::kFileVersion) {
    return "is of version " + std::to_string(header.version) + " of the format, this reads " +
           std::to_string(bvh::kFileVersion);
  }
  if (header.header_checksum != bvh::ChecksumOf(header)) return "the header is damaged";
  if (header.real_bytes != real_bytes) {
    return std::string("has numbers of ") + std::to_string(header.real_bytes) + " bytes, not of " +
           std::to_string(real_bytes);
  }
  if (!std::equal(std::begin(bvh::kFileLayout), std::end(bvh::kFileLayout), header.layout)) {
    return "was saved with another layout of trees";
  }
  const std::uint64_t expected = FileSections(header).file_bytes;
  if (size != expected || header.file_bytes != expected) {
    return std::to_string(size) + " bytes, " + std::to_string(expected) + " expected";
  }
  const bool is_in_range =
      header.node_count < kLeafBit &&
      std::all_of(std::begin(header.block_count), std::end(header.block_count),
                  [](std::uint32_t count) { return count <= kMaxTreePrimitives; });
  if (!is_in_range) return "has more than is possible";
  int exponent;
  const bool is_scale = std::isfinite(header.scale) && std::frexp(header.scale, &exponent) == 0.5;
  return is_scale ? "" : "has a scale that is no power of two";
}

const char* NameOfSection(std::uint32_t section) {
  return section < bvh::kIds       ? "nodes"
         : section < bvh::kFields  ? "ids"
         : section < bvh::kFirst   ? "primitives"
         : section < bvh::kNormals ? "objects"
                                   : "normals";
}

// What the tree was built from, out of its leaves; "" or what is wrong with a leaf.
template <typename Real>
std::string ReadLeaves(const TreeView<Real>& tree, GeometryArrays<Real>& arrays) {
  for (std::uint32_t node = 0; node < tree.node_count; ++node) {
    for (const std::uint32_t child : tree.nodes[node].child) {
      if (!IsLeaf(child) || child == kNoChild) continue;
      const std::string place = "node " + std::to_string(node) + ": ";
      const PrimitiveKind kind = LeafKind(child);
      if (IndexOf(kind) >= kKindCount) return place + "a leaf of no kind";
      const std::uint32_t first = LeafFirst(child), count = LeafCount(child);
      if (first + count > tree.of(kind).count) return place + "a leaf beyond the last primitive";
      const std::size_t fields = FieldCountOf(kind);
      for (std::size_t k = 0; k < fields; ++k) {
        std::copy_n(tree.of(kind).fields + fields * first + k * count, count,
                    arrays.field(kind, k) + first);
      }
      std::copy_n(tree.of(kind).id + first, count, arrays.ids(kind) + first);
    }
  }
  return "";
}

// "" or what is wrong with the lists of objects.
template <typename Real>
std::string ObjectFault(const typename GeometryAccess::Data<Real>& data) {
  std::uint64_t triangles = 0;
  for (std::size_t i = 0; i < data.kind.size(); ++i) {
    const std::string place = "object " + std::to_string(i);
    if (IndexOf(data.kind[i]) >= kKindCount) return place + " is of no kind";
    if (data.first[i] > data.first[i + 1]) return place + " ends before it begins";
    if (data.first_triangle[i] != triangles) return place + " begins at a wrong triangle";
    const bool is_mesh = data.kind[i] == PrimitiveKind::kTriangle;
    if (is_mesh) triangles += data.first[i + 1] - data.first[i];
  }
  if (data.first[0] != 0) return "object 0 does not begin at primitive 0";
  if (data.first_triangle.back() != triangles) return "a wrong number of triangles";
  const std::uint64_t in_tree = data.view.primitive_count();
  if (data.first.back() != in_tree + data.never_hit + data.skipped) {
    return "a wrong number of primitives";
  }
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    const BlockView<Real>& block = data.view.blocks[k];
    for (std::uint32_t i = 0; i < block.count; ++i) {
      const auto after = std::upper_bound(data.first.begin(), data.first.end(), block.id[i]);
      if (after == data.first.end() ||
          IndexOf(data.kind[static_cast<std::size_t>(after - data.first.begin() - 1)]) != k) {
        return "primitive " + std::to_string(block.id[i]) + " is of another kind";
      }
    }
  }
  return "";
}

template <typename Real>
std::string BodyFault(const FileHeader& header, const FileSections& sections,
                      const std::byte* bytes, const typename GeometryAccess::Data<Real>& data) {
  for (std::uint32_t i = 0; i < bvh::kSectionCount; ++i) {
    const std::uint64_t sum = bvh::ChecksumOf(bytes + sections.offset[i], sections.bytes[i]);
    if (sum != header.checksums[i]) return std::string("the ") + NameOfSection(i) + " are damaged";
  }
  if (std::string fault = ObjectFault<Real>(data); !fault.empty()) return fault;
  PrimitiveCounts counts;
  std::copy_n(header.block_count, kKindCount, counts.of);
  GeometryArrays<Real> arrays(counts);
  if (std::string fault = ReadLeaves(data.view, arrays); !fault.empty()) return fault;
  return FindTreeDefect(data.view, arrays.view());
}

}  // namespace

template <typename Real>
Result<GeometryOf<Real>> GeometryOf<Real>::Map(const std::string& path, MapCheck check) {
  const auto failed = [&](const std::string& what) {
    return Error{ErrorKind::kInputOutput, path + ": " + what};
  };
  Result<MappedFile> opened = MappedFile::Open(path);
  if (!opened) return opened.error();
  const auto file = std::make_shared<const MappedFile>(std::move(opened).value());
  FileHeader header;
  if (file->size() < sizeof(header)) return failed("is no saved geometry");
  std::memcpy(&header, file->data(), sizeof(header));
  const std::string header_fault = HeaderFault(header, file->size(), sizeof(Real));
  if (!header_fault.empty()) return failed(header_fault);

  const FileSections sections(header);
  const auto show = [&]<typename T>(const T*& to, std::uint32_t section) {
    to = reinterpret_cast<const T*>(file->data() + sections.offset[section]);
  };
  const auto copy = [&]<typename T>(std::vector<T>& to, std::uint32_t section) {
    const T* from;
    show(from, section);
    to.assign(from, from + sections.bytes[section] / sizeof(T));
  };
  auto data = std::make_unique<Data>();
  data->file = file;
  data->file_bytes = file->size();
  TreeView<Real>& view = data->view;
  show(view.nodes, bvh::kNodes);
  view.node_count = header.node_count;
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    show(view.blocks[k].id, bvh::kIds + k);
    show(view.blocks[k].fields, bvh::kFields + k);
    view.blocks[k].count = header.block_count[k];
  }
  std::copy_n(header.lower, 3, view.lower);
  std::copy_n(header.upper, 3, view.upper);
  view.skips_boxes = view.node_count <= 1;
  std::copy_n(header.all_lower, 3, data->tree.all_lower);
  std::copy_n(header.all_upper, 3, data->tree.all_upper);
  data->scale = static_cast<Real>(header.scale);
  data->never_hit = header.never_hit;
  data->skipped = header.skipped;
  data->built_cost = header.built_cost;
  copy(data->first, bvh::kFirst);
  copy(data->first_triangle, bvh::kFirstTriangle);
  copy(data->kind, bvh::kObjectKind);
  if (header.normal_count > 0) {
    if (header.normal_count != data->first_triangle.back()) return failed("normals are missing");
    for (std::uint32_t k = 0; k < 9; ++k) show(data->normals[k], bvh::kNormals + k);
  }
  if (check == MapCheck::kAll) {
    const std::string fault = BodyFault<Real>(header, sections, file->data(), *data);
    if (!fault.empty()) return failed(fault);
  }
  GeometryOf geometry;
  geometry.data_ = std::move(data);
  return geometry;
}

template Result<Geometry> Geometry::Map(const std::string&, MapCheck);
template Result<GeometryD> GeometryD::Map(const std::string&, MapCheck);

}  // namespace sheaf
