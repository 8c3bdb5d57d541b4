// One pixel, one ray at a time: the specification of a whole frame.
//
// Whitted, "An Improved Illumination Model for Shaded Display" (CACM 1980), breadth first: a
// depth's rays are shaded in order, then all their reflections, refractions and diffuse rays make
// the next depth. Each ray's colour, times its throughput, is added to the sample in that order;
// simd/ and src/render keep to it.
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
#include "src/scalar/choose_lobe.h"
#include "src/scalar/converge.h"
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
  std::vector<Path<Real>> paths;
  std::vector<Path<Real>> children[kChildKinds];
};

// What random numbers are drawn by: a ray's seed, and which of the pixel's samples it is of.
struct SampleKey {
  std::uint32_t seed, index;
};

// Where a ray arrived: `here` is its material as it is at the surface, where its base colour is
// `base`.
template <typename Real>
struct ShadedPoint {
  const MaterialData<Real>&material, &here;
  Vec3<Real> base;
  Surface<Real>& surface;
};

// The light of one point of a light with a size, or all of another light.
template <typename Real>
Vec3<Real> LightFrom(const FrameView<Real>& frame, const LightData<Real>& light,
                     SamplePoint<Real> drawn, const ShadedPoint<Real>& at, RayCounts& tally) {
  const Incidence<Real> incidence = IncidenceOf(light, at.surface, drawn);
  if (!incidence.reaches) return {0, 0, 0};
  Vec3<Real> share = {1, 1, 1};
  if (light.casts_shadows) {
    ++tally.shadow;
    Ray<Real> ray = ShadowRay(light, at.surface, incidence);
    ray.instance = at.surface.instance;
    // Rays find lamps behind glass themselves.
    if (light.shape == LightShape::kEmitters) {
      if (TraceOccluded(frame, ray)) return {0, 0, 0};
      share = incidence.colour;
    } else {
      share = LightShare(frame, ray);
    }
    if (!IsLight(share)) return {0, 0, 0};
  }
  return MultiplyColours(LitBy(light, at.here, at.surface, at.base, incidence), share);
}

// What the surface's own light counts for the ray that found it.
template <typename Real>
Real EmissionWeight(const FrameView<Real>& frame, const Path<Real>& path, const Hit<Real>& hit,
                    const ShadedPoint<Real>& at) {
  const Real density = at.material.emitter_density;
  const bool is_triangle = frame.primitives[hit.primitive].kind() == PrimitiveKind::kTriangle;
  // Of instances no lamp is drawn.
  const bool is_drawn = is_triangle && hit.instance == kNoInstance;
  if (!(path.density > 0 && density > 0 && is_drawn)) return 1;
  return FoundWeight(path.density, density, at.surface, hit.t);
}

template <typename Real>
Vec3<Real> LocalLight(const FrameView<Real>& frame, const ShadedPoint<Real>& at, SampleKey key,
                      RayCounts& tally, Real emission_weight = 1) {
  if (!HasLocalLight(at.material, at.surface)) return {0, 0, 0};
  Vec3<Real> colour = AmbientLight(at.here, at.base) * emission_weight;
  if (!ReactsToLight(at.material)) return colour;
  for (std::size_t i = 0; i < frame.lights.size(); ++i) {
    const LightData<Real>& light = frame.lights[i];
    if (light.shape == LightShape::kEmitters && !(at.material.needs & kNeedsChoice)) continue;
    const std::uint32_t dimension = kLightDimension + static_cast<std::uint32_t>(i);
    for (std::uint32_t draw = 0; draw < light.samples; ++draw) {
      SamplePoint<Real> drawn;
      if (light.shape != LightShape::kPoint) {
        drawn = DrawSample<Real>(key.seed, key.index * light.samples + draw, dimension);
      }
      colour = colour + LightFrom(frame, light, drawn, at, tally);
    }
  }
  return colour;
}

// SurfaceOf, with the ray's footprint and the normal that shading goes by.
template <typename Real>
Surface<Real> ShadedSurface(const FrameView<Real>& frame, const MaterialData<Real>& material,
                            const Path<Real>& path, const Hit<Real>& hit) {
  const bool is_placed = hit.instance != kNoInstance;
  const Ray<Real> ray = RayAtHit(frame, path.ray, hit.instance);
  Surface<Real> surface = SurfaceOf(frame, material, ray, hit);
  const PrimitiveInfo& primitive = frame.primitives[hit.primitive];
  if (material.needs & kNeedsWidth) {
    MeasureFootprint(frame.geometry, primitive.place, path.width, frame.cone.spread, hit.t,
                     surface);
    if (is_placed) {
      const Real stretch = StretchOf(ray.direction);
      surface.footprint_u = surface.footprint_u * stretch;
      surface.footprint_v = surface.footprint_v * stretch;
      surface.footprint_u2 = surface.footprint_u2 * stretch;
      surface.footprint_v2 = surface.footprint_v2 * stretch;
    }
  }
  if (material.finish.normals != kNoTexture && primitive.kind() == PrimitiveKind::kTriangle) {
    const TextureData<Real>& map = frame.textures[material.finish.normals];
    surface.normal = BumpedNormal(material, map, SampleTexture(map, surface),
                                  frame.geometry.triangles, primitive.index(), surface);
  }
  if (is_placed) PlaceSurface(frame, path.ray, hit.instance, surface);
  return surface;
}

template <typename Real>
bool SendsRays(const FrameView<Real>& frame, const MaterialData<Real>& here) {
  return SpawnsRays(here) || (frame.follows_paths && here.kd > 0);
}

// Leaves in the surface the facet that rays are sent on by. Of a path, which ray that will be.
template <typename Real>
Lobes<Real> ChooseRays(const FrameView<Real>& frame, const Path<Real>& path, SampleKey key,
                       int depth, const ShadedPoint<Real>& at) {
  const auto& [material, here, base, surface] = at;
  if (!SendsRays(frame, here)) return {};
  const auto draw = [&](std::uint32_t dimension) {
    return DrawSample<Real>(key.seed, key.index, dimension);
  };
  if (HasFacets(material)) {
    surface.facet = DrawFacet(here.slope_width, surface, draw(kGlossDimension));
    surface.gloss = GlossAt(here, surface);
  }
  if (!frame.follows_paths) return {};
  const Roulette roulette = depth >= kRouletteDepth ? Roulette::kOn : Roulette::kOff;
  const Lobes<Real> lobes =
      ChooseLobe(material, here, surface, base, path.throughput, roulette, draw(kLobeDimension).u);
  // A ray that will not be traced finds no lamp.
  surface.scatter = depth < frame.max_depth ? lobes.scatter : Real(0);
  return lobes;
}

// The rays that the surface sends on: those of mirror and interface, or the one that was chosen.
template <typename Real>
void SendOn(const FrameView<Real>& frame, const Path<Real>& path, SampleKey key,
            const Lobes<Real>& lobes, const ShadedPoint<Real>& at,
            std::vector<Path<Real>> (&children)[kChildKinds]) {
  const auto& [material, here, base, surface] = at;
  if (!SendsRays(frame, here)) return;
  const auto append = [&, instance = at.surface.instance](ChildKind kind, Path<Real>& child) {
    if (!child.counts(frame.min_throughput)) return;
    child.ray.instance = instance;
    if (frame.is_distributed) child.seed = ChildSeed(path.seed, kind);
    children[static_cast<std::size_t>(kind)].push_back(child);
  };
  Spawned<Real> spawned = Spawn(here, surface, path.throughput);
  if (frame.follows_paths) {
    for (int i = 0; i < 3; ++i) {
      spawned.reflected.throughput[i] = spawned.reflected.throughput[i] * lobes.reflect;
      spawned.refracted.throughput[i] = spawned.refracted.throughput[i] * lobes.refract;
    }
    if (lobes.diffuse > 0) {
      const auto point = DrawSample<Real>(key.seed, key.index, kDiffuseDimension);
      Path<Real> diffuse =
          ScatterDiffuse(here, surface, base, path.throughput, lobes.diffuse, point);
      append(ChildKind::kDiffuse, diffuse);
    }
  }
  append(ChildKind::kReflected, spawned.reflected);
  append(ChildKind::kRefracted, spawned.refracted);
}

// Adds `colour`, seen with `throughput`, to `sum`.
template <typename Real>
void Accumulate(Vec3<Real>& sum, const Real (&throughput)[3], Vec3<Real> colour) {
  sum = sum +
        Vec3<Real>{throughput[0] * colour.x, throughput[1] * colour.y, throughput[2] * colour.z};
}

// The path of the primary ray of the sample `index` of a pixel.
template <typename Real>
Path<Real> PrimaryPath(const FrameView<Real>& frame, int x, int y, std::uint32_t index) {
  Path<Real> path{{}, {1, 1, 1}, frame.cone.width};
  SamplePoint<Real> lens;
  if (frame.is_distributed) {
    path.seed = PixelSeed(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
    lens = DrawSample<Real>(path.seed, index, kLensDimension);
  }
  path.ray = CameraRay(frame.camera, static_cast<Real>(x), static_cast<Real>(y),
                       frame.sample_x[index], frame.sample_y[index], lens);
  return path;
}

// The colour of the sample `index` of a pixel: breadth first from its primary ray, which has depth
// 0. Leaves in `first`, unless that is null, what the primary ray hit.
template <typename Real>
Vec3<Real> RenderSample(const FrameView<Real>& frame, int x, int y, std::size_t sample,
                        PixelScratch<Real>& scratch, RayCounts& tally,
                        const std::atomic<bool>& stop, FirstHit<Real>* first = nullptr) {
  const auto index = static_cast<std::uint32_t>(sample);
  Vec3<Real> sum = {0, 0, 0};
  scratch.paths.assign(1, PrimaryPath(frame, x, y, index));
  ++tally.primary;
  for (int depth = 0; !scratch.paths.empty() && !stop.load(std::memory_order_relaxed); ++depth) {
    for (auto& children : scratch.children) children.clear();
    for (Path<Real>& path : scratch.paths) {
      const Hit<Real> hit = TraceClosest(frame, path.ray);
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
      Surface<Real> surface = ShadedSurface(frame, material, path, hit);
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
      const SampleKey key{path.seed, index};
      const ShadedPoint<Real> at{material, here, base, surface};
      const Lobes<Real> lobes = ChooseRays(frame, path, key, depth, at);
      const Real weight = EmissionWeight(frame, path, hit, at);
      Accumulate(sum, path.throughput, LocalLight(frame, at, key, tally, weight));
      SendOn(frame, path, key, lobes, at, scratch.children);
    }
    const std::size_t spawned =
        scratch.children[0].size() + scratch.children[1].size() + scratch.children[2].size();
    tally.reflected += scratch.children[0].size();
    tally.refracted += scratch.children[1].size();
    tally.diffuse += scratch.children[2].size();
    if (depth == frame.max_depth) {  // what is deeper counts, and is black
      tally.beyond_depth += spawned;
      break;
    }
    scratch.paths.clear();
    for (const auto& children : scratch.children) {
      scratch.paths.insert(scratch.paths.end(), children.begin(), children.end());
    }
  }
  return sum;
}

// Rubbish after `stop` was set, which ends any pixel soon. Adds a pixel's further samples to its
// `sums`, in the order of the pattern: all, or with an error to reach as many as that takes. Leaves
// in `first`, unless that is null, what the first one hit.
template <typename Real>
void SamplePixel(const FrameView<Real>& frame, int x, int y, PixelSums<Real>& sums,
                 PixelScratch<Real>& scratch, RayCounts& tally, const std::atomic<bool>& stop,
                 FirstHit<Real>* first = nullptr) {
  while (sums.samples < frame.sample_x.size() &&
         !(frame.converges() && sums.IsConverged(frame.error))) {
    const std::uint32_t index = sums.samples;
    sums.Add(RenderSample(frame, x, y, index, scratch, tally, stop, index == 0 ? first : nullptr));
  }
}

// The mean of the pixel's samples.
template <typename Real>
Vec3<Real> RenderPixel(const FrameView<Real>& frame, int x, int y, PixelScratch<Real>& scratch,
                       RayCounts& tally, const std::atomic<bool>& stop,
                       FirstHit<Real>* first = nullptr) {
  PixelSums<Real> sums;
  SamplePixel(frame, x, y, sums, scratch, tally, stop, first);
  return sums.mean();
}

}  // namespace sheaf::scalar

#endif  // SHEAF_SCALAR_RENDER_PIXEL_H_
