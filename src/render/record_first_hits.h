// What the first sample's primary rays hit: for layers, and for adaptive sampling's edges.
#ifndef SHEAF_RENDER_RECORD_FIRST_HITS_H_
#define SHEAF_RENDER_RECORD_FIRST_HITS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "sheaf/film.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/render/bin_hits.h"
#include "src/stream/first_hit.h"
#include "src/stream/frame_view.h"

namespace sheaf {

template <typename Real>
class FirstHitRecorder {
 public:
  // `frame` outlives it. Albedo is kept where the layers have it.
  FirstHitRecorder(const FrameView<Real>& frame, Layers layers)
      : frame_(frame), keeps_albedo_(layers.has(Layer::kAlbedo)) {}

  // `count` pixels that hit nothing yet.
  void Start(std::uint32_t count) { hits_.assign(count, {}); }

  // The bin's rays are the primary rays of the pixels since Start.
  void Record(const HitBin& bin, const HitView<Real>& hits, const SurfaceView<Real>& surfaces);
  void RecordColours(const ColourView<Real>& sample);

  std::size_t bytes() const { return hits_.capacity() * sizeof(FirstHit<Real>); }

  // By pixel.
  std::span<const FirstHit<Real>> hits() const { return hits_; }

 private:
  const FrameView<Real>& frame_;
  const bool keeps_albedo_;
  std::vector<FirstHit<Real>> hits_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_RECORD_FIRST_HITS_H_
