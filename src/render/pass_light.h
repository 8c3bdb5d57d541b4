// The shadow rays that go on through surfaces which are not all there, or which transmit.
#ifndef SHEAF_RENDER_PASS_LIGHT_H_
#define SHEAF_RENDER_PASS_LIGHT_H_

#include <cstdint>
#include <vector>

#include "simd/kernels.h"
#include "simd/streams.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// Shadow rays, and the instances that their sources belong to where a frame has any.
template <typename Real>
struct ShadowRays {
  RayView<Real> rays;
  const std::uint32_t* source_instances;
};

// Owns the streams of such rays. What it is made with outlives it.
template <typename Real>
class LightPasser {
 public:
  LightPasser(const FrameView<Real>& frame, const Kernels<Real>& kernels)
      : frame_(frame), kernels_(kernels) {}

  // What arrives along each shadow ray: shares[0, count) are 1 where `occluded` is 0, else what
  // the surfaces on the way let pass. Bits: as sheaf::scalar::LightShare. One round of tracing a
  // surface on the way; what each lets pass is found ray by ray.
  void Pass(const ShadowRays<Real>& shadow, Real t_max, const std::uint32_t* occluded,
            std::uint32_t count, const ColourOutput<Real>& shares);

  std::size_t bytes() const {
    return rays_.bytes() + hits_.bytes() +
           (ray_of_.capacity() + source_instances_.capacity() + instances_.capacity()) *
               sizeof(std::uint32_t);
  }

 private:
  const FrameView<Real>& frame_;
  const Kernels<Real>& kernels_;
  RayStream<Real> rays_;  // on their way
  HitStream<Real> hits_;
  std::vector<std::uint32_t> ray_of_;                        // the shadow ray of each
  std::vector<std::uint32_t> source_instances_, instances_;  // of each ray and of its hit
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_PASS_LIGHT_H_
