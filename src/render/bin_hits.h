// Sorts the hits of a stream into batches that are treated alike.
#ifndef SHEAF_RENDER_BIN_HITS_H_
#define SHEAF_RENDER_BIN_HITS_H_

#include <span>
#include <vector>

#include "simd/primitives.h"
#include "simd/streams.h"
#include "src/core/aligned_array.h"
#include "src/stream/frame_view.h"

namespace sheaf {

// The hits of one material on one kind of primitive, in the order of their rays.
struct HitBin {
  std::uint32_t material;
  PrimitiveKind kind;
  HitBatch batch;
};

// A stable counting sort by material and kind. Keeps its arrays from stream to stream.
class HitBinner {
 public:
  explicit HitBinner(std::size_t material_count) : counts_(kKindCount * material_count + 1) {}

  // Valid until the next call, and as long as `hit_primitives` are. `primitives` tells a hit
  // primitive's material and kind.
  void Bin(const std::uint32_t* hit_primitives, std::uint32_t count,
           std::span<const PrimitiveInfo> primitives);

  std::size_t bytes() const {
    return ray_.bytes() + index_.bytes() + primitive_.bytes() + runs_.capacity() * sizeof(Run);
  }

  std::span<const HitBin> bins() const { return bins_; }
  std::span<const std::uint32_t> missed_rays() const { return missed_rays_; }

 private:
  // Consecutive rays that hit the same primitive.
  struct Run {
    std::uint32_t first, size, primitive, key, index;
  };

  void BinAlike(std::uint32_t key, const std::uint32_t* hit_primitives, std::uint32_t count);

  std::vector<std::uint32_t> counts_;  // by key: see KeyOf; 0 for misses
  std::vector<std::uint32_t> keys_;    // that this stream met, ascending; 0 always
  std::vector<Run> runs_;
  AlignedArray<std::uint32_t> ray_, index_, primitive_;
  std::vector<HitBin> bins_;
  std::span<const std::uint32_t> missed_rays_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_BIN_HITS_H_
