// Sorts the hits of a stream into batches that are treated alike.
#ifndef SHEAF_RENDER_BIN_HITS_H_
#define SHEAF_RENDER_BIN_HITS_H_

#include <span>
#include <vector>

#include "simd/streams.h"
#include "src/core/aligned_array.h"
#include "src/stream/frame_view.h"

namespace sheaf {

enum class ShapeKind : std::uint32_t { kSphere, kTriangle };

// The hits of one material on one kind of shape, in the order of their rays.
struct HitBin {
  std::uint32_t material;
  ShapeKind shape;
  HitBatch batch;
};

// A stable counting sort by material and shape. Keeps its arrays from stream to stream.
class HitBinner {
 public:
  explicit HitBinner(std::size_t material_count) : counts_(2 * material_count + 1) {}

  // Valid until the next call. `primitives` tells a hit primitive's material and shape.
  void Bin(const std::uint32_t* hit_primitives, std::uint32_t count,
           std::span<const PrimitiveInfo> primitives);

  std::span<const HitBin> bins() const { return bins_; }
  std::span<const std::uint32_t> missed_rays() const { return missed_rays_; }

 private:
  // Consecutive rays that hit the same primitive.
  struct Run {
    std::uint32_t first, size, primitive, key, local;
  };

  std::vector<std::uint32_t> counts_;  // by key: 0 for misses, then 1 + 2 * material + shape
  std::vector<std::uint32_t> keys_;    // that this stream met, ascending; 0 always
  std::vector<Run> runs_;
  AlignedArray<std::uint32_t> ray_, local_, primitive_;
  std::vector<HitBin> bins_;
  std::span<const std::uint32_t> missed_rays_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_BIN_HITS_H_
