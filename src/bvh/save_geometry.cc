// A built geometry to a file.
#include <algorithm>
#include <cstring>
#include <iterator>

#include "src/bvh/geometry_access.h"
#include "src/bvh/geometry_file.h"
#include "src/core/atomic_file.h"

namespace sheaf {
namespace {

using bvh::FileHeader;
using bvh::FileSections;

// What lies in each section.
template <typename Real>
std::array<const void*, bvh::kSectionCount> SectionsOf(
    const typename GeometryAccess::Data<Real>& data) {
  std::array<const void*, bvh::kSectionCount> sections;
  sections[bvh::kNodes] = data.view.nodes;
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    sections[bvh::kIds + k] = data.view.blocks[k].id;
    sections[bvh::kFields + k] = data.view.blocks[k].fields;
  }
  sections[bvh::kFirst] = data.first.data();
  sections[bvh::kFirstTriangle] = data.first_triangle.data();
  sections[bvh::kObjectKind] = data.kind.data();
  for (std::uint32_t k = 0; k < 9; ++k) sections[bvh::kNormals + k] = data.normals[k];
  return sections;
}

template <typename Real>
FileHeader HeaderOf(const typename GeometryAccess::Data<Real>& data) {
  FileHeader header{};
  std::copy(std::begin(bvh::kFileMagic), std::end(bvh::kFileMagic), header.magic);
  header.byte_order = bvh::kFileByteOrder;
  header.version = bvh::kFileVersion;
  header.real_bytes = sizeof(Real);
  std::copy(std::begin(bvh::kFileLayout), std::end(bvh::kFileLayout), header.layout);
  header.node_count = data.view.node_count;
  for (std::uint32_t k = 0; k < kKindCount; ++k) header.block_count[k] = data.view.blocks[k].count;
  header.object_count = static_cast<std::uint32_t>(data.kind.size());
  header.normal_count = data.normals[0] ? data.first_triangle.back() : 0;
  header.never_hit = data.never_hit;
  header.skipped = data.skipped;
  std::copy_n(data.view.lower, 3, header.lower);
  std::copy_n(data.view.upper, 3, header.upper);
  std::copy_n(data.tree.all_lower, 3, header.all_lower);
  std::copy_n(data.tree.all_upper, 3, header.all_upper);
  header.scale = static_cast<double>(data.scale);
  header.built_cost = data.built_cost;
  return header;
}

// With zeros up to where the next one begins.
Status WriteAligned(AtomicFile& file, const void* data, std::uint64_t bytes) {
  static constexpr std::byte kZeros[kAlignment] = {};
  if (Status status = file.Write(data, bytes); !status) return status;
  return file.Write(kZeros, FileSections::Aligned(bytes) - bytes);
}

}  // namespace

template <typename Real>
Status GeometryOf<Real>::Save(const std::string& path) const {
  FileHeader header = HeaderOf<Real>(data());
  const FileSections sections(header);
  auto shown = SectionsOf<Real>(data());
  // A geometry of nothing has no arrays, but readers may load a vector.
  static constexpr double kNothing[kMaxLanes] = {};
  for (std::uint32_t i = 0; i < bvh::kSectionCount; ++i) {
    if (!shown[i]) shown[i] = kNothing;
    header.checksums[i] =
        bvh::ChecksumOf(static_cast<const std::byte*>(shown[i]), sections.bytes[i]);
  }
  header.file_bytes = sections.file_bytes;
  header.header_checksum = bvh::ChecksumOf(header);

  Result<AtomicFile> file = AtomicFile::Create(path);
  if (!file) return file.error();
  if (Status status = WriteAligned(file.value(), &header, sizeof(header)); !status) return status;
  for (std::uint32_t i = 0; i < bvh::kSectionCount; ++i) {
    const Status status = WriteAligned(file.value(), shown[i], sections.bytes[i]);
    if (!status) return status;
  }
  return file.value().Commit();
}

template Status GeometryOf<float>::Save(const std::string&) const;
template Status GeometryOf<double>::Save(const std::string&) const;

}  // namespace sheaf
