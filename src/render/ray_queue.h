// Streams of rays together with where their light goes.
#ifndef SHEAF_RENDER_RAY_QUEUE_H_
#define SHEAF_RENDER_RAY_QUEUE_H_

#include <cstdint>
#include <vector>

#include "simd/shading.h"
#include "simd/streams.h"
#include "src/stream/stream.h"

namespace sheaf {

// Rays that pass the steps of a depth together.
template <typename Real>
struct RayBatch {
  RayView<Real> rays;
  // Null pointers but for the seed: ray i is of pixel i, with a throughput of 1.
  PathView<Real> paths;
  std::uint32_t count = 0;
  // Those that the rays' sources belong to; null where there are none.
  const std::uint32_t* source_instances = nullptr;
};

// The fields of paths in frames whose materials have `needs`, as bits for Stream::Reserve; diffuse
// ones have their density besides.
template <typename Real>
constexpr std::uint64_t PathFieldsFor(std::uint32_t needs) {
  return ~(FieldBit(&PathView<Real>::density) |
           (needs & kNeedsWidth ? 0 : FieldBit(&PathView<Real>::width)) |
           (needs & kNeedsSeed ? 0 : FieldBit(&PathView<Real>::seed)));
}

// A sample's primary rays: one a pixel, from no surface, so that they need no paths.
template <typename Real>
class PrimaryRays {
 public:
  // Room for `n` rays, to be written by the caller.
  RayOutput<Real> Start(std::uint32_t n) {
    rays_.Reserve(n, ~FieldBit(&RayView<Real>::source));
    count_ = n;
    return rays_.output();
  }

  // `seeds` may be null.
  RayBatch<Real> batch(const std::uint32_t* seeds) const {
    RayBatch<Real> batch{rays_.view(), {}, count_};
    batch.paths.seed = seeds;
    return batch;
  }
  std::size_t bytes() const { return rays_.bytes(); }

 private:
  RayStream<Real> rays_;
  std::uint32_t count_ = 0;
};

// Brings rays into the order of their parents, no two of which share one.
template <typename Real>
class ParentOrder {
 public:
  // `parent_count` bounds paths.parent.
  void Apply(const RayOutput<Real>& rays, const PathOutput<Real>& paths, std::uint32_t count,
             std::uint32_t parent_count);
  std::size_t bytes() const {
    const std::size_t ids = ray_of_parent_.capacity() + order_.capacity() + ids_.capacity();
    return ids * sizeof(std::uint32_t) + numbers_.capacity() * sizeof(Real);
  }

 private:
  // Kept from call to call.
  std::vector<std::uint32_t> ray_of_parent_, order_, ids_;
  std::vector<Real> numbers_;
};

// The secondary rays of one depth. They are appended bin by bin, for one batch of parents after the
// other: StartParents, then Append for each bin, then FinishParents.
template <typename Real>
class RayQueue {
 public:
  // Empties the queue. At most `n` rays will come.
  void Reset(std::uint32_t n) {
    count_ = 0;
    most_ = n;
    source_instances_.clear();
  }
  // Makes room for them: before the first is written, so that scenes without such rays have no
  // memory for them. `path_fields` are those of PathFieldsFor.
  void MakeRoom(std::uint64_t path_fields) {
    rays_.Reserve(most_);
    paths_.Reserve(most_, path_fields);
  }

  void StartParents() {
    first_ = count_;
    bins_ = 0;
  }
  // Where the next rays go; null pointers where there is no room.
  RayOutput<Real> next_rays() { return rays_.output(count_); }
  PathOutput<Real> next_paths() { return paths_.output(count_); }
  // A bin's rays are written there, all but their pixels, in the order of their parents.
  void Append(std::uint32_t spawned) {
    count_ += spawned;
    bins_ += spawned > 0;
  }
  // Gives the rays since StartParents their pixels, the order of their parents and, where those
  // have any, seeds. `hit_instances`: what the parents hit, null where no frame has instances.
  void FinishParents(const RayBatch<Real>& parents, ChildKind kind,
                     const std::uint32_t* hit_instances, ParentOrder<Real>& order);

  // Moves the rays of the pixels from `pixel` on to `to`, in their order. `stays` is scratch.
  void MoveFrom(std::uint32_t pixel, std::vector<std::uint8_t>& stays, RayQueue& to);

  std::uint32_t count() const { return count_; }
  std::size_t bytes() const {
    return rays_.bytes() + paths_.bytes() + source_instances_.capacity() * sizeof(std::uint32_t);
  }
  // `count` rays from `first` on.
  RayBatch<Real> batch(std::uint32_t first, std::uint32_t count) const {
    const bool has_instances = !source_instances_.empty();
    return {rays_.view(first), paths_.view(first), count,
            has_instances ? source_instances_.data() + first : nullptr};
  }
  PathOutput<Real> paths(std::uint32_t first) { return paths_.output(first); }

 private:
  RayStream<Real> rays_;
  PathStream<Real> paths_;
  std::vector<std::uint32_t> source_instances_;
  std::uint32_t count_ = 0, most_ = 0;
  std::uint32_t first_ = 0;  // ray of the parents in work
  int bins_ = 0;             // of the parents in work that have rays
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_RAY_QUEUE_H_
