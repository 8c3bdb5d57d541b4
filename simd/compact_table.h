// The order that compaction brings lanes into, for up to eight lanes.
#ifndef SHEAF_SIMD_COMPACT_TABLE_H_
#define SHEAF_SIMD_COMPACT_TABLE_H_

#include <array>
#include <cstdint>

namespace sheaf {

// lane[mask][i] is the lane that moves to place i: first the lanes of `mask`, ascending, then the
// others. With fewer than eight lanes the first entries still name lanes below their number.
struct CompactTable {
  alignas(64) std::array<std::array<std::uint8_t, 8>, 256> lane;
};

constexpr CompactTable MakeCompactTable() {
  CompactTable table{};
  for (std::uint32_t mask = 0; mask < 256; ++mask) {
    std::uint32_t place = 0;
    for (const std::uint32_t wanted : {1u, 0u}) {
      for (std::uint8_t lane = 0; lane < 8; ++lane) {
        if ((mask >> lane & 1u) == wanted) table.lane[mask][place++] = lane;
      }
    }
  }
  return table;
}

inline constexpr CompactTable kCompactTable = MakeCompactTable();

}  // namespace sheaf

#endif  // SHEAF_SIMD_COMPACT_TABLE_H_
