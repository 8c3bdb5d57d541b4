#include "src/render/pass_light.h"

#include "simd/query.h"
#include "src/scalar/pass_light.h"

namespace sheaf {
namespace {

template <typename Real>
scalar::Ray<Real> RayIn(const RayView<Real>& rays, std::uint32_t i, Real t_max) {
  return {{rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
          {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]},
          rays.source[i],
          kDefaultTMin<Real>,
          t_max};
}

template <typename Real>
void StoreRay(const scalar::Ray<Real>& ray, const RayOutput<Real>& rays, std::uint32_t i) {
  rays.origin_x[i] = ray.origin.x;
  rays.origin_y[i] = ray.origin.y;
  rays.origin_z[i] = ray.origin.z;
  rays.direction_x[i] = ray.direction.x;
  rays.direction_y[i] = ray.direction.y;
  rays.direction_z[i] = ray.direction.z;
  rays.source[i] = ray.source;
}

template <typename Real>
void StoreShare(Vec3<Real> share, const ColourOutput<Real>& shares, std::uint32_t i) {
  shares.r[i] = share.x;
  shares.g[i] = share.y;
  shares.b[i] = share.z;
}

}  // namespace

template <typename Real>
void LightPasser<Real>::Pass(const RayView<Real>& rays, Real t_max, const std::uint32_t* occluded,
                             std::uint32_t count, const ColourOutput<Real>& shares) {
  rays_.Reserve(count);
  hits_.Reserve(count);
  ray_of_.clear();
  const RayOutput<Real> next = rays_.output();
  for (std::uint32_t i = 0; i < count; ++i) {
    shares.r[i] = shares.g[i] = shares.b[i] = 1;
    if (!occluded[i]) continue;
    StoreRay(RayIn(rays, i, t_max), next, static_cast<std::uint32_t>(ray_of_.size()));
    ray_of_.push_back(i);
  }
  RayIntervals<Real> interval;
  interval.all_t_max = t_max;
  for (int pass = 0; pass < scalar::kMostPasses && !ray_of_.empty(); ++pass) {
    const auto left = static_cast<std::uint32_t>(ray_of_.size());
    kernels_.trace_closest(frame_.tree, rays_.view(), interval, left, Coherence::kUnknown,
                           hits_.output());
    const HitView<Real> hits = hits_.view();
    std::uint32_t kept = 0;
    for (std::uint32_t k = 0; k < left; ++k) {
      const scalar::Hit<Real> hit = {hits.t[k], hits.primitive[k], hits.u[k], hits.v[k]};
      scalar::Ray<Real> ray = RayIn(rays_.view(), k, t_max);
      const std::uint32_t i = ray_of_[k];
      Vec3<Real> share = {shares.r[i], shares.g[i], shares.b[i]};
      const scalar::Passing passing = scalar::PassOn(frame_, hit, ray, share);
      StoreShare(passing == scalar::Passing::kBlocked ? Vec3<Real>{0, 0, 0} : share, shares, i);
      if (passing != scalar::Passing::kGoesOn) continue;
      StoreRay(ray, next, kept);
      ray_of_[kept++] = i;
    }
    ray_of_.resize(kept);
  }
  for (const std::uint32_t i : ray_of_) StoreShare<Real>({0, 0, 0}, shares, i);
}

template class LightPasser<float>;
template class LightPasser<double>;

}  // namespace sheaf
