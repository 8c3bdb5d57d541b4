#include "src/render/shade_lights.h"

#include "simd/query.h"
#include "simd/sample_terms.h"
#include "src/bvh/walk_instances.h"
#include "src/scalar/pass_light.h"

namespace sheaf {

template <typename Real>
void LightShader<Real>::Shade(const MaterialData<Real>& material, const SurfaceView<Real>& surfaces,
                              const std::uint32_t* instances, std::uint32_t count,
                              const ColourOutput<Real>& colours) {
  if (frame_.lights.empty()) return;
  instances_ = instances;
  lit_.Reserve(StreamCapacity(count));
  incidence_.Reserve(count, incidence_fields_);
  for (std::size_t i = 0; i < frame_.lights.size(); ++i) {
    const LightData<Real>& light = frame_.lights[i];
    if (light.shape == LightShape::kPoint) {
      ShadeOne(light, material, surfaces, {}, count, colours);
      continue;
    }
    if (light.shape == LightShape::kEmitters && !(material.needs & kNeedsChoice)) continue;
    const std::uint32_t dimension = kLightDimension + static_cast<std::uint32_t>(i);
    for (std::uint32_t draw = 0; draw < light.samples; ++draw) {
      const SampleView<Real> points = samples_.DrawForSurfaces(dimension, draw, light.samples);
      ShadeOne(light, material, surfaces, points, count, colours);
    }
  }
}

template <typename Real>
void LightShader<Real>::ShadeOne(const LightData<Real>& light, const MaterialData<Real>& material,
                                 const SurfaceView<Real>& surfaces, const SampleView<Real>& points,
                                 std::uint32_t count, const ColourOutput<Real>& colours) {
  const std::uint32_t facing = kernels_.face_light(light, material, surfaces, points, count,
                                                   lit_.data(), incidence_.output());
  clock_.Charge(Phase::kShade, count, count);
  if (facing == 0) return;
  const std::uint32_t lit = light.casts_shadows ? FindShadows(light, surfaces, count) : facing;
  if (lit == 0) return;
  ColourView<Real> shares{};
  if (light.shape == LightShape::kEmitters) {
    shares = {incidence_.view().r, incidence_.view().g, incidence_.view().b};
  } else if (frame_.passes_light && light.casts_shadows) {
    shares = shares_.view();
  }
  kernels_.shade_light(light, material, surfaces, incidence_.view(), lit_.data(), shares, count,
                       colours);
  clock_.Charge(Phase::kShade, lit, count);
}

template <typename Real>
std::uint32_t LightShader<Real>::FindShadows(const LightData<Real>& light,
                                             const SurfaceView<Real>& surfaces,
                                             std::uint32_t count) {
  shadow_rays_.Reserve(count);
  surface_of_ray_.Reserve(StreamCapacity(count));
  occluded_.Reserve(StreamCapacity(count));
  const std::uint32_t size =
      kernels_.generate_shadow(light, surfaces, incidence_.view(), lit_.data(), count,
                               shadow_rays_.output(), surface_of_ray_.data());
  rays_.shadow += size;
  RayIntervals<Real> intervals;
  if (light.kind != LightKind::kDirectional) intervals.all_t_max = 1;
  TraceShadows(surfaces, intervals, size);
  // Rays find lamps behind glass themselves.
  if (frame_.passes_light && light.shape != LightShape::kEmitters) {
    return FindShares(light, size, count);
  }
  std::uint32_t lit = size;
  for (std::uint32_t i = 0; i < size; ++i) lit -= occluded_[i];
  if (size == count) {  // ray i is that of surface i
    for (std::uint32_t i = 0; i < size; ++i) lit_[i] = 1 - occluded_[i];
  } else {
    for (std::uint32_t i = 0; i < size; ++i) lit_[surface_of_ray_[i]] = 1 - occluded_[i];
  }
  clock_.Charge(Phase::kShadow, size, size);
  return lit;
}

template <typename Real>
void LightShader<Real>::TraceShadows(const SurfaceView<Real>& surfaces,
                                     const RayIntervals<Real>& intervals, std::uint32_t count) {
  const RayView<Real> rays = shadow_rays_.view();
  kernels_.trace_occluded(frame_.tree, rays, intervals, count, Coherence::kUnknown,
                          occluded_.data());
  if (!frame_.has_instances()) return;
  source_instances_.Reserve(StreamCapacity(count));
  for (std::uint32_t i = 0; i < count; ++i) {
    source_instances_[i] = instances_[surfaces.ray[surface_of_ray_[i]]];
  }
  WalkOccluded(frame_.instances, kernels_, rays, source_instances_.data(), intervals, count,
               occluded_.data());
}

template <typename Real>
std::uint32_t LightShader<Real>::FindShares(const LightData<Real>& light, std::uint32_t rays,
                                            std::uint32_t count) {
  shares_.Reserve(count);
  ray_shares_.Reserve(rays);
  const ColourOutput<Real> by_ray = ray_shares_.output(), by_surface = shares_.output();
  const Real t_max = light.kind == LightKind::kDirectional ? kDefaultTMax<Real> : Real(1);
  passer_.Pass({shadow_rays_.view(), source_instances_.data()}, t_max, occluded_.data(), rays,
               by_ray);
  std::uint32_t lit = 0;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const std::uint32_t surface = rays == count ? i : surface_of_ray_[i];
    by_surface.r[surface] = by_ray.r[i];
    by_surface.g[surface] = by_ray.g[i];
    by_surface.b[surface] = by_ray.b[i];
    const Vec3<Real> share = {by_ray.r[i], by_ray.g[i], by_ray.b[i]};
    lit_[surface] = scalar::IsLight(share) ? 1 : 0;
    lit += lit_[surface];
  }
  clock_.Charge(Phase::kShadow, rays, rays);
  return lit;
}

template class LightShader<float>;
template class LightShader<double>;

}  // namespace sheaf
