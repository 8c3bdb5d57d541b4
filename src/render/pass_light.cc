#include "src/render/pass_light.h"

#include <algorithm>

#include "simd/query.h"
#include "src/bvh/walk_instances.h"
#include "src/scalar/pass_light.h"

namespace sheaf {
namespace {

template <typename Real>
scalar::Ray<Real> RayIn(const RayView<Real>& rays, const std::uint32_t* instances, std::uint32_t i,
                        Real t_max) {
  scalar::Ray<Real> ray = scalar::RayAt(rays, i);
  ray.t_max = t_max;
  if (instances) ray.instance = instances[i];
  return ray;
}

template <typename Real>
void StoreShare(Vec3<Real> share, const ColourOutput<Real>& shares, std::uint32_t i) {
  shares.r[i] = share.x;
  shares.g[i] = share.y;
  shares.b[i] = share.z;
}

}  // namespace

template <typename Real>
void LightPasser<Real>::Pass(const ShadowRays<Real>& shadow, Real t_max,
                             const std::uint32_t* occluded, std::uint32_t count,
                             const ColourOutput<Real>& shares) {
  const bool has_instances = frame_.has_instances();
  const std::uint32_t* const given = has_instances ? shadow.source_instances : nullptr;
  const auto keep = [&](const scalar::Ray<Real>& ray, std::uint32_t k) {
    scalar::StoreRay(ray, rays_.output(), k);
    if (has_instances) source_instances_[k] = ray.instance;
  };
  if (has_instances) {
    source_instances_.resize(StreamCapacity(count));
    instances_.resize(StreamCapacity(count));
  }
  rays_.Reserve(count);
  hits_.Reserve(count);
  ray_of_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    shares.r[i] = shares.g[i] = shares.b[i] = 1;
    if (!occluded[i]) continue;
    keep(RayIn(shadow.rays, given, i, t_max), static_cast<std::uint32_t>(ray_of_.size()));
    ray_of_.push_back(i);
  }
  RayIntervals<Real> interval;
  interval.all_t_max = t_max;
  for (int pass = 0; pass < scalar::kMostPasses && !ray_of_.empty(); ++pass) {
    const auto left = static_cast<std::uint32_t>(ray_of_.size());
    kernels_.trace_closest(frame_.tree, rays_.view(), interval, left, Coherence::kUnknown,
                           hits_.output());
    const HitView<Real> hits = hits_.view();
    if (has_instances) {
      const HitOutput<Real> out = hits_.output();
      std::fill_n(instances_.begin(), left, kNoInstance);
      WalkClosest(frame_.instances, kernels_, rays_.view(), source_instances_.data(), interval,
                  left, {out.t, out.u, out.v, out.primitive, instances_.data()});
    }
    const std::uint32_t* const from = has_instances ? source_instances_.data() : nullptr;
    std::uint32_t kept = 0;
    for (std::uint32_t k = 0; k < left; ++k) {
      const scalar::Hit<Real> hit = {hits.t[k], hits.primitive[k], hits.u[k], hits.v[k],
                                     has_instances ? instances_[k] : kNoInstance};
      scalar::Ray<Real> ray = RayIn(rays_.view(), from, k, t_max);
      const std::uint32_t i = ray_of_[k];
      Vec3<Real> share = {shares.r[i], shares.g[i], shares.b[i]};
      const scalar::Passing passing = scalar::PassOn(frame_, hit, ray, share);
      StoreShare(passing == scalar::Passing::kBlocked ? Vec3<Real>{0, 0, 0} : share, shares, i);
      if (passing != scalar::Passing::kGoesOn) continue;
      keep(ray, kept);
      ray_of_[kept++] = i;
    }
    ray_of_.resize(kept);
  }
  for (const std::uint32_t i : ray_of_) StoreShare<Real>({0, 0, 0}, shares, i);
}

template class LightPasser<float>;
template class LightPasser<double>;

}  // namespace sheaf
