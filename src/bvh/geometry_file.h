// How a geometry lies in a file: a header, and the arrays as memory has them. docs/geometry.md
// describes it.
#ifndef SHEAF_BVH_GEOMETRY_FILE_H_
#define SHEAF_BVH_GEOMETRY_FILE_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "simd/tree.h"
#include "src/core/checksum.h"
#include "src/core/parallel.h"

namespace sheaf::bvh {

inline constexpr char kFileMagic[8] = {'S', 'H', 'E', 'A', 'F', 'G', 'E', 'O'};
inline constexpr std::uint32_t kFileByteOrder = 0x01020304;
inline constexpr std::uint32_t kFileVersion = 1;
// What arrays are laid out for.
inline constexpr std::uint32_t kFileLayout[] = {kTreeWidth, kMaxLeafSize,    kMaxTreeDepth,
                                                kMaxLanes,  kIndexBits,      kLeafKindShift,
                                                kAlignment, sizeof(TreeNode)};

// The parts of the file after the header, in this order: nodes, ids and fields of each kind, first
// primitive, first triangle and kind of each object, normals by vertex and axis.
enum FileSection : std::uint32_t {
  kNodes,
  kIds,
  kFields = kIds + kKindCount,
  kFirst = kFields + kKindCount,
  kFirstTriangle,
  kObjectKind,
  kNormals,
  kSectionCount = kNormals + 9,
};

struct FileHeader {
  char magic[8];
  std::uint32_t byte_order, version;
  std::uint32_t real_bytes;  // 4: floats, 8: doubles
  std::uint32_t layout[8];
  std::uint32_t node_count, block_count[kKindCount];
  std::uint32_t object_count, normal_count;  // triangles with normals: all or none
  std::uint32_t never_hit, skipped;
  float lower[3], upper[3], all_lower[3], all_upper[3];  // as Tree has them
  std::uint32_t unused;                                  // 0
  double scale, built_cost;
  std::uint64_t file_bytes;
  std::uint64_t checksums[kSectionCount];
  std::uint64_t header_checksum;  // of what is above
};
static_assert(offsetof(FileHeader, scale) == 136 &&
              sizeof(FileHeader) == 136 + 24 + 8 * kSectionCount + 8);  // without gaps

inline std::uint64_t ChecksumOf(const FileHeader& header) {
  Checksum sum;
  sum.Add(&header, offsetof(FileHeader, header_checksum));
  return sum.value();
}

// Of a section: of the checksums of its parts, which threads share.
inline std::uint64_t ChecksumOf(const std::byte* data, std::size_t size) {
  constexpr std::size_t kPart = std::size_t{1} << 20;
  const std::size_t parts = (size + kPart - 1) / kPart;
  std::vector<std::uint64_t> sums(parts);
  ParallelFor(ThreadCount(0), parts, [&](int, std::uint64_t i) {
    Checksum sum;
    sum.Add(data + i * kPart, std::min(kPart, size - static_cast<std::size_t>(i) * kPart));
    sums[i] = sum.value();
  });
  Checksum whole;
  whole.Add(sums.data(), parts * sizeof(std::uint64_t));
  return whole.value();
}

// Where sections lie follows from the counts, so that no offset can be wrong.
struct FileSections {
  std::array<std::uint64_t, kSectionCount> offset, bytes;
  std::uint64_t file_bytes;

  explicit FileSections(const FileHeader& header) {
    const std::uint64_t real = header.real_bytes, word = sizeof(std::uint32_t);
    bytes[kNodes] = header.node_count * std::uint64_t{sizeof(TreeNode)};
    for (std::uint32_t k = 0; k < kKindCount; ++k) {
      const std::uint64_t count = header.block_count[k];
      bytes[kIds + k] = (count + kMaxLanes) * word;
      bytes[kFields + k] = (FieldCountOf(static_cast<PrimitiveKind>(k)) * count + kMaxLanes) * real;
    }
    bytes[kFirst] = bytes[kFirstTriangle] = (std::uint64_t{header.object_count} + 1) * word;
    bytes[kObjectKind] = header.object_count * word;
    for (std::uint32_t k = 0; k < 9; ++k) bytes[kNormals + k] = header.normal_count * real;
    file_bytes = Aligned(sizeof(FileHeader));
    for (std::uint32_t i = 0; i < kSectionCount; ++i) {
      offset[i] = file_bytes;
      file_bytes += Aligned(bytes[i]);
    }
  }

  static constexpr std::uint64_t Aligned(std::uint64_t bytes) {
    return (bytes + kAlignment - 1) / kAlignment * kAlignment;
  }
};

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_GEOMETRY_FILE_H_
