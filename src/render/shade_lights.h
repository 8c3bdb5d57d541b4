// The step from surfaces to what the lights add to them: light by light, so that the shadow rays of
// a batch share their origin.
#ifndef SHEAF_RENDER_SHADE_LIGHTS_H_
#define SHEAF_RENDER_SHADE_LIGHTS_H_

#include <cstdint>

#include "sheaf/stats.h"
#include "simd/kernels.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/core/aligned_array.h"
#include "src/render/pass_light.h"
#include "src/render/phase_clock.h"
#include "src/render/sample_source.h"
#include "src/stream/frame_view.h"
#include "src/stream/stream.h"

namespace sheaf {

// The fields of incidences that the lights of a frame ask for, as bits for Stream::Reserve.
template <typename Real>
std::uint64_t IncidenceFieldsFor(const FrameView<Real>& frame) {
  using Fields = IncidenceView<Real>;
  const auto bits = [](auto... field) { return (FieldBit(field) | ...); };
  const std::uint64_t ends = bits(&Fields::end_x, &Fields::end_y, &Fields::end_z);
  const std::uint64_t colours = bits(&Fields::r, &Fields::g, &Fields::b);
  std::uint64_t fields = ~(ends | colours);
  for (const LightData<Real>& light : frame.lights) {
    if (light.shape != LightShape::kPoint) fields |= ends;
    if (light.shape == LightShape::kEmitters) fields |= colours;
  }
  return fields;
}

// Owns the streams of shadow rays. What it is made with outlives it.
template <typename Real>
class LightShader {
 public:
  LightShader(const FrameView<Real>& frame, const Kernels<Real>& kernels,
              SampleSource<Real>& samples, RayCounts& rays, PhaseClock& clock)
      : frame_(frame),
        kernels_(kernels),
        samples_(samples),
        rays_(rays),
        clock_(clock),
        incidence_fields_(IncidenceFieldsFor(frame)),
        passer_(frame, kernels) {}

  // Adds to colours[0, count) what each light gives the surfaces that it reaches. Where lights are
  // drawn from, `samples` has been told of the surfaces. `instances`: what the surfaces' rays hit,
  // null where no frame has instances.
  void Shade(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
             const std::uint32_t* instances, std::uint32_t count,
             const ColourOutput<Real>& colours);
  std::size_t bytes() const {
    return passer_.bytes() + shares_.bytes() + ray_shares_.bytes() + lit_.bytes() +
           incidence_.bytes() + shadow_rays_.bytes() + surface_of_ray_.bytes() + occluded_.bytes() +
           source_instances_.bytes();
  }

 private:
  // What the light in work gives, of a light with a size at these points of it.
  void ShadeOne(const LightData<Real>& light, const MaterialData<Real>& material,
                const SurfaceView<Real>& surfaces, const SampleView<Real>& points,
                std::uint32_t count, const ColourOutput<Real>& colours);

  // Returns how many surfaces the light reaches.
  std::uint32_t FindShadows(const LightData<Real>& light, const SurfaceView<Real>& surfaces,
                            std::uint32_t count);

  // Whether anything lies on the way of shadow rays [0, count), into occluded_.
  void TraceShadows(const SurfaceView<Real>& surfaces, const RayIntervals<Real>& intervals,
                    std::uint32_t count);

  // The same where surfaces let light pass, from what FindShadows left by ray.
  std::uint32_t FindShares(const LightData<Real>& light, std::uint32_t rays, std::uint32_t count);

  const FrameView<Real>& frame_;
  const Kernels<Real>& kernels_;
  SampleSource<Real>& samples_;
  RayCounts& rays_;
  PhaseClock& clock_;

  AlignedArray<std::uint32_t> lit_;       // by surface: 1 where the light in work reaches it
  const std::uint64_t incidence_fields_;  // that the frame's lights ask for
  IncidenceStream<Real> incidence_;       // of the light in work
  RayStream<Real> shadow_rays_;
  AlignedArray<std::uint32_t> surface_of_ray_, occluded_, source_instances_;  // by shadow ray
  const std::uint32_t* instances_ = nullptr;  // by ray that hit a surface
  LightPasser<Real> passer_;
  // Where surfaces let light pass: the share of it that arrives, by surface and by ray.
  ColourStream<Real> shares_, ray_shares_;
};

}  // namespace sheaf

#endif  // SHEAF_RENDER_SHADE_LIGHTS_H_
