#include "src/render/instanced_hits.h"

#include <algorithm>

#include "src/bvh/walk_instances.h"
#include "src/scalar/place_surface.h"

namespace sheaf {

template <typename Real>
RayBatch<Real> InstancedHits<Real>::Trace(const RayBatch<Real>& batch,
                                          const HitOutput<Real>& hits) {
  if (!frame_.has_instances()) return batch;
  instance_.assign(StreamCapacity(batch.count), kNoInstance);
  WalkClosest(frame_.instances, kernels_, batch.rays, batch.source_instances, {}, batch.count,
              {hits.t, hits.u, hits.v, hits.primitive, instance_.data()});
  rays_.Reserve(batch.count, ~FieldBit(&RayView<Real>::source));
  const RayOutput<Real> mapped = rays_.output();
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    scalar::StoreRay(scalar::RayAtHit(frame_, scalar::RayAt(batch.rays, i), instance_[i]), mapped,
                     i);
  }
  batch_rays_ = batch.rays;
  RayBatch<Real> result = batch;
  result.rays = rays_.view();
  result.rays.source = batch.rays.source;
  return result;
}

template <typename Real>
bool InstancedHits<Real>::IsAnyPlaced(const HitBin& bin) const {
  return !instance_.empty() &&
         std::any_of(bin.batch.ray, bin.batch.ray + bin.batch.count,
                     [&](std::uint32_t ray) { return instance_[ray] != kNoInstance; });
}

template <typename Real>
void InstancedHits<Real>::StretchFootprints(const HitBin& bin,
                                            const SurfaceOutput<Real>& surfaces) const {
  if (!IsAnyPlaced(bin)) return;
  const RayView<Real> rays = rays_.view();
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    if (instance_[bin.batch.ray[i]] == kNoInstance) continue;
    const Real stretch = scalar::StretchOf(scalar::RayAt(rays, bin.batch.ray[i]).direction);
    for (Real* const field : {surfaces.footprint_u, surfaces.footprint_v, surfaces.footprint_u2,
                              surfaces.footprint_v2}) {
      if (field) field[i] = field[i] * stretch;
    }
  }
}

template <typename Real>
void InstancedHits<Real>::Place(const HitBin& bin, const SurfaceView<Real>& surfaces,
                                const SurfaceOutput<Real>& placed) const {
  if (!IsAnyPlaced(bin)) return;
  const bool has_faces = surfaces.face_x != surfaces.normal_x;
  const bool is_curved = surfaces.bend != nullptr;
  for (std::uint32_t i = 0; i < bin.batch.count; ++i) {
    const std::uint32_t ray = bin.batch.ray[i], instance = instance_[ray];
    if (instance == kNoInstance) continue;
    scalar::Surface<Real> surface{};
    surface.position = {surfaces.position_x[i], surfaces.position_y[i], surfaces.position_z[i]};
    surface.normal = {surfaces.normal_x[i], surfaces.normal_y[i], surfaces.normal_z[i]};
    surface.face = {surfaces.face_x[i], surfaces.face_y[i], surfaces.face_z[i]};
    surface.offset = surfaces.offset[i];
    if (is_curved) {
      surface.shadow_end = {surfaces.shadow_x[i], surfaces.shadow_y[i], surfaces.shadow_z[i]};
    }
    scalar::PlaceSurface(frame_, scalar::RayAt(batch_rays_, ray), instance, surface);
    placed.position_x[i] = surface.position.x;
    placed.position_y[i] = surface.position.y;
    placed.position_z[i] = surface.position.z;
    placed.normal_x[i] = surface.normal.x;
    placed.normal_y[i] = surface.normal.y;
    placed.normal_z[i] = surface.normal.z;
    placed.direction_x[i] = surface.direction.x;
    placed.direction_y[i] = surface.direction.y;
    placed.direction_z[i] = surface.direction.z;
    placed.offset[i] = surface.offset;
    if (has_faces) {
      placed.face_x[i] = surface.face.x;
      placed.face_y[i] = surface.face.y;
      placed.face_z[i] = surface.face.z;
    }
    if (is_curved) {
      placed.shadow_x[i] = surface.shadow_end.x;
      placed.shadow_y[i] = surface.shadow_end.y;
      placed.shadow_z[i] = surface.shadow_end.z;
    }
  }
}

template class InstancedHits<float>;
template class InstancedHits<double>;

}  // namespace sheaf
