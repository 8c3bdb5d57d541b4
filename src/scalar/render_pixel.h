// One pixel, one ray at a time: the specification of a whole frame.
//
// Whitted, "An Improved Illumination Model for Shaded Display" (CACM 1980), breadth first: a
// depth's rays are shaded in order, then all their reflections, then all their refractions make the
// next depth. Each ray's colour, times its throughput, is added to the sample in that order; simd/
// and src/render keep to it.
#ifndef SHEAF_SCALAR_RENDER_PIXEL_H_
#define SHEAF_SCALAR_RENDER_PIXEL_H_

#include <atomic>
#include <optional>
#include <vector>

#include "sheaf/stats.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "src/scalar/attenuate.h"
#include "src/scalar/camera_ray.h"
#include "src/scalar/environment.h"
#include "src/scalar/finish.h"
#include "src/scalar/footprint.h"
#include "src/scalar/pass_light.h"
#include "src/scalar/shadow_ray.h"
#include "src/scalar/spawn.h"
#include "src/scalar/trace_tree.h"
#include "src/stream/first_hit.h"
#include "src/stream/frame_view.h"

namespace sheaf::scalar {

// One depth's rays and the next one's, kept to spare allocations.
template <typename Real>
struct PixelScratch {
  std::vector<Path<Real>> paths, reflected, refracted;
};

// `here` is the material as it is at the surface, where its base colour is `base`.
template <typename Real>
Vec3<Real> LocalLight(const FrameView<Real>& frame, const MaterialData<Real>& material,
                      const MaterialData<Real>& here, Vec3<Real> base, const Surface<Real>& surface,
                      RayCounts& tally) {
  if (!HasLocalLight(material, surface)) return {0, 0, 0};
  Vec3<Real> colour = AmbientLight(here, base);
  if (!ReactsToLight(material)) return colour;
  for (const LightData<Real>& light : frame.lights) {
    const Incidence<Real> incidence = IncidenceOf(light, surface);
    if (!incidence.reaches) continue;
    Vec3<Real> share = {1, 1, 1};
    if (light.casts_shadows) {
      ++tally.shadow;
      share = LightShare(frame, ShadowRay(light, surface, incidence));
      if (!IsLight(share)) continue;
    }
    colour = colour + MultiplyColours(LitBy(light, here, surface, base, incidence), share);
  }
  return colour;
}

// SurfaceOf, with the ray's footprint and the normal that shading goes by.
template <typename Real>
Surface<Real> ShadedSurface(const FrameView<Real>& frame, const MaterialData<Real>& material,
                            const Path<Real>& path, const Hit<Real>& hit) {
  Surface<Real> surface = SurfaceOf(frame, material, path.ray, hit);
  const PrimitiveInfo& primitive = frame.primitives[hit.primitive];
  if (material.needs & kNeedsWidth) {
    MeasureFootprint(frame.geometry, primitive.place, path.width, frame.cone.spread, hit.t,
                     surface);
  }
  if (material.finish.normals != kNoTexture && primitive.kind() == PrimitiveKind::kTriangle) {
    const TextureData<Real>& map = frame.textures[material.finish.normals];
    surface.normal = BumpedNormal(material, map, SampleTexture(map, surface),
                                  frame.geometry.triangles, primitive.index(), surface);
  }
  return surface;
}

// Adds `colour`, seen with `throughput`, to `sum`.
template <typename Real>
void Accumulate(Vec3<Real>& sum, const Real (&throughput)[3], Vec3<Real> colour) {
  sum = sum +
        Vec3<Real>{throughput[0] * colour.x, throughput[1] * colour.y, throughput[2] * colour.z};
}

// The colour of one sample: breadth first from its primary ray, which has depth 0. Leaves in
// `first`, unless that is null, what the primary ray hit.
template <typename Real>
Vec3<Real> RenderSample(const FrameView<Real>& frame, const Ray<Real>& primary,
                        PixelScratch<Real>& scratch, RayCounts& tally,
                        const std::atomic<bool>& stop, FirstHit<Real>* first = nullptr) {
  Vec3<Real> sum = {0, 0, 0};
  scratch.paths.assign(1, {primary, {1, 1, 1}, frame.cone.width});
  ++tally.primary;
  for (int depth = 0; !scratch.paths.empty() && !stop.load(std::memory_order_relaxed); ++depth) {
    scratch.reflected.clear();
    scratch.refracted.clear();
    for (Path<Real>& path : scratch.paths) {
      const Hit<Real> hit = TraceClosest(frame.tree, path.ray);
      if (hit.primitive == kNoPrimitive) {
        Accumulate(sum, path.throughput, ColourBeyond(frame, path.ray.direction));
        continue;
      }
      if (frame.attenuates) {
        const Vec3<Real> left = TransmittanceOf(frame, path.ray.source, hit.t);
        for (int i = 0; i < 3; ++i) path.throughput[i] = path.throughput[i] * left[i];
      }
      const MaterialData<Real>& material =
          frame.materials[frame.primitives[hit.primitive].material];
      const Surface<Real> surface = ShadedSurface(frame, material, path, hit);
      const Vec3<Real> base = BaseColourAt(material, frame.textures, surface);
      std::optional<MaterialData<Real>> varied;
      if (material.needs & kNeedsTerms) {
        varied = MaterialAt(material, TexelsAt(material, frame.textures, surface), base);
      }
      const MaterialData<Real>& here = varied ? *varied : material;
      if (depth == 0 && first) {
        first->normal = surface.normal;
        first->surface = SurfaceIdOf(hit.primitive, frame.primitives[hit.primitive]);
        first->t = hit.t;
        first->albedo = base;
        first->primitive = hit.primitive;
      }
      Accumulate(sum, path.throughput, LocalLight(frame, material, here, base, surface, tally));
      if (!SpawnsRays(here)) continue;
      const Spawned<Real> spawned = Spawn(here, surface, path.throughput);
      if (spawned.reflected.counts(frame.min_throughput))
        scratch.reflected.push_back(spawned.reflected);
      if (spawned.refracted.counts(frame.min_throughput))
        scratch.refracted.push_back(spawned.refracted);
    }
    tally.reflected += scratch.reflected.size();
    tally.refracted += scratch.refracted.size();
    if (depth == frame.max_depth) {  // what is deeper counts, and is black
      tally.beyond_depth += scratch.reflected.size() + scratch.refracted.size();
      break;
    }
    scratch.paths.swap(scratch.reflected);
    scratch.paths.insert(scratch.paths.end(), scratch.refracted.begin(), scratch.refracted.end());
  }
  return sum;
}

// Rubbish after `stop` was set, which ends any pixel soon. The mean of the pixel's samples, added
// up in the order of the pattern. Leaves in `first`, unless that is null, what the first one hit.
template <typename Real>
Vec3<Real> RenderPixel(const FrameView<Real>& frame, int x, int y, PixelScratch<Real>& scratch,
                       RayCounts& tally, const std::atomic<bool>& stop,
                       FirstHit<Real>* first = nullptr) {
  Vec3<Real> sum = {0, 0, 0};
  const std::size_t samples = frame.sample_x.size();
  for (std::size_t i = 0; i < samples; ++i) {
    const Ray<Real> primary = CameraRay(frame.camera, static_cast<Real>(x), static_cast<Real>(y),
                                        frame.sample_x[i], frame.sample_y[i]);
    sum = sum + RenderSample(frame, primary, scratch, tally, stop, i == 0 ? first : nullptr);
  }
  return sum / static_cast<Real>(samples);
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_RENDER_PIXEL_H_
