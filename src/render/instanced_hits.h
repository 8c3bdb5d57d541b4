// What rays of a batch hit in instances, and the way there and back.
#ifndef SHEAF_RENDER_INSTANCED_HITS_H_
#define SHEAF_RENDER_INSTANCED_HITS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/render/ray_queue.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// Does nothing, and has no memory, in frames without instances. `frame` and `kernels` outlive it.
template <typename Real>
class InstancedHits {
 public:
  InstancedHits(const FrameView<Real>& frame, const Kernels<Real>& kernels)
      : frame_(frame), kernels_(kernels) {}

  // Puts those hits in instances that are nearer into `hits`, which has all others. Returns the
  // batch with each ray as what it hits sees it: what surfaces are computed from.
  RayBatch<Real> Trace(const RayBatch<Real>& batch, const HitOutput<Real>& hits);

  // By ray of the batch that was traced last; null where no frame has instances.
  const std::uint32_t* instances() const { return instance_.empty() ? nullptr : instance_.data(); }

  // Brings what the cones of surfaces[0, bin.batch.count) cover to the objects' measure.
  void StretchFootprints(const HitBin& bin, const SurfaceOutput<Real>& surfaces) const;
  // Takes surfaces[0, bin.batch.count) to where they stand. Bits: as sheaf::scalar::PlaceSurface.
  // Faces, shadow ends and shading normals may be one field.
  void Place(const HitBin& bin, const SurfaceView<Real>& surfaces,
             const SurfaceOutput<Real>& placed) const;

  std::size_t bytes() const { return rays_.bytes() + instance_.capacity() * sizeof(instance_[0]); }

 private:
  // Whether any ray of the bin hit an instance.
  bool IsAnyPlaced(const HitBin& bin) const;

  const FrameView<Real>& frame_;
  const Kernels<Real>& kernels_;
  RayView<Real> batch_rays_{};
  std::vector<std::uint32_t> instance_;  // by ray
  RayStream<Real> rays_;                 // mapped
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_INSTANCED_HITS_H_
