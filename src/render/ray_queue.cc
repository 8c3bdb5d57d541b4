#include "src/render/ray_queue.h"

#include <type_traits>

#include "src/scalar/draw_sample.h"

namespace sheaf {
namespace {

// field[i] becomes field[order[i]]. A null pointer is no field.
template <typename T>
void Permute(T* field, const std::vector<std::uint32_t>& order, std::vector<T>& scratch) {
  if (!field) return;
  scratch.assign(field, field + order.size());
  for (std::size_t i = 0; i < order.size(); ++i) field[i] = scratch[order[i]];
}

}  // namespace

template <typename Real>
void ParentOrder<Real>::Apply(const RayOutput<Real>& rays, const PathOutput<Real>& paths,
                              std::uint32_t count, std::uint32_t parent_count) {
  constexpr std::uint32_t kNone = 0xffffffffu;
  ray_of_parent_.assign(parent_count, kNone);
  for (std::uint32_t i = 0; i < count; ++i) ray_of_parent_[paths.parent[i]] = i;
  order_.clear();
  for (const std::uint32_t ray : ray_of_parent_) {
    if (ray != kNone) order_.push_back(ray);
  }

  const auto permute = [&](auto* field) {
    if constexpr (std::is_same_v<decltype(field), Real*>) {
      Permute(field, order_, numbers_);
    } else {
      Permute(field, order_, ids_);
    }
  };
  ForEachField(rays, permute);
  ForEachField(paths, permute);
}

template <typename Real>
void RayQueue<Real>::FinishParents(const RayBatch<Real>& parents, ChildKind kind,
                                   const std::uint32_t* hit_instances, ParentOrder<Real>& order) {
  const std::uint32_t spawned = count_ - first_;
  const PathOutput<Real> paths = paths_.output(first_);
  // One bin leaves its rays in the order of their parents; several have to be merged into it.
  if (bins_ > 1) order.Apply(rays_.output(first_), paths, spawned, parents.count);
  const std::uint32_t* pixel = parents.paths.pixel;
  for (std::uint32_t i = 0; i < spawned; ++i) {
    paths.pixel[i] = pixel ? pixel[paths.parent[i]] : paths.parent[i];
  }
  for (std::uint32_t i = 0; hit_instances && i < spawned; ++i) {
    source_instances_.push_back(hit_instances[paths.parent[i]]);
  }
  const std::uint32_t* seed = parents.paths.seed;
  if (!seed || !paths.seed) return;
  for (std::uint32_t i = 0; i < spawned; ++i) {
    paths.seed[i] = scalar::ChildSeed(seed[paths.parent[i]], kind);
  }
}

template <typename Real>
void RayQueue<Real>::MoveFrom(std::uint32_t pixel, std::vector<std::uint8_t>& stays, RayQueue& to) {
  const PathOutput<Real> from_paths = paths_.output();
  stays.resize(count_);
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    stays[i] = from_paths.pixel[i] < pixel;
    kept += stays[i];
  }
  to.count_ = count_ - kept;
  const auto move = [&](auto*& from, auto*& other) {
    if (!from) return;
    std::uint32_t stayed = 0, moved = 0;
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (stays[i]) {
        from[stayed++] = from[i];
      } else {
        other[moved++] = from[i];
      }
    }
  };
  if (count_ > 0) {
    std::uint64_t fields = 0, bit = 1;
    ForEachField(from_paths, [&](auto* field) {
      if (field) fields |= bit;
      bit <<= 1;
    });
    to.rays_.Reserve(to.count_);
    to.paths_.Reserve(to.count_, fields);
    RayOutput<Real> rays = rays_.output(), to_rays = to.rays_.output();
    PathOutput<Real> paths = from_paths, to_paths = to.paths_.output();
    ForEachField(rays, to_rays, move);
    ForEachField(paths, to_paths, move);
    to.source_instances_.resize(source_instances_.empty() ? 0 : to.count_);
    std::uint32_t* instances = source_instances_.empty() ? nullptr : source_instances_.data();
    std::uint32_t* to_instances = to.source_instances_.data();
    move(instances, to_instances);
    if (instances) source_instances_.resize(kept);
  }
  count_ = kept;
}

template class ParentOrder<float>;
template class ParentOrder<double>;
template class RayQueue<float>;
template class RayQueue<double>;

}  // namespace sheaf
