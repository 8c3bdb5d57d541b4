// What was hit, and where to go on from there: the renderer's own surfaces for a user's rays.
#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <type_traits>

#include "sheaf/geometry.h"
#include "simd/kernels.h"
#include "simd/shading.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/ray_block.h"
#include "src/scalar/primitives.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kBlock = 64;  // hits at a time: all that is copied of them fits a stack
constexpr std::uint32_t kRoom = kBlock + kMaxLanes;

// The hits of a block, with copies of what they hit, kind by kind.
template <typename Real>
class HitBlock {
 public:
  HitBlock(const GeometryOf<Real>& geometry, Target target)
      : data_(GeometryAccess::DataOf(geometry)),
        target_(target),
        kernels_(StrictKernels<Real>(target.is_scalar() ? 0 : target.id())) {
    std::size_t number = 0, id = 0;
    ForEachField(surfaces_, [&]<typename T>(T*& field) {
      if constexpr (std::is_same_v<T, Real>) {
        // What comes last is for lights and textures alone: no kernel here writes it.
        field = number < std::size(numbers_) ? numbers_[number++] : nullptr;
      } else {
        field = ids_[id++];
      }
    });
  }

  // Takes hits [first, first + count). Returns the first of them whose primitive no ray hits, or
  // the end.
  std::size_t Take(const RayArraysOf<Real>& rays, const HitArraysOf<Real>& hits, std::size_t first,
                   std::uint32_t count) {
    count_ = count;
    rays_.Take(rays, {}, first, count, data_.scale);
    Gather(hits.t, hits.stride, first, count, t_);
    Gather(hits.u, hits.stride, first, count, u_);
    Gather(hits.v, hits.stride, first, count, v_);
    Gather(hits.primitive, hits.stride, first, count, hit_primitive_);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t id = hit_primitive_[i];
      if (id != kNoPrimitive && data_.index.leaf(id) == kNoChild) return first + i;
    }
    return first + count;
  }

  // Calls put(hit, surface) for each hit that is one: its place in the block.
  template <typename Put>
  void ForEachSurface(const Put& put) {
    for (std::uint32_t k = 0; k < kKindCount; ++k) {
      WithKind<Real>(static_cast<PrimitiveKind>(k), [&](auto arrays) {
        Copy(arrays);
        if (arrays.count == 0) return;
        target_.is_scalar() ? PutByScalar(arrays, put) : PutByKernel(arrays, put);
      });
    }
  }

 private:
  // Shows as `arrays` copies of those primitives of their kind that were hit.
  template <typename Arrays>
  void Copy(Arrays& arrays) {
    std::uint32_t n = 0;
    const BlockView<Real>& block = data_.view.of(Arrays::kKind);
    for (std::uint32_t i = 0; i < count_; ++i) {
      const std::uint32_t id = hit_primitive_[i];
      if (id == kNoPrimitive) continue;
      const std::uint32_t leaf = data_.index.leaf(id);
      if (LeafKind(leaf) != Arrays::kKind) continue;
      const Real* from =
          block.fields + std::size_t{Arrays::kFieldCount} * LeafFirst(leaf) + data_.index.lane(id);
      for (std::uint32_t k = 0; k < Arrays::kFieldCount; ++k, from += LeafCount(leaf)) {
        fields_[k][n] = *from;
      }
      ray_[n] = i;
      index_[n] = n;
      primitive_[n++] = id;
    }
    std::uint32_t k = 0;
    Arrays::ForEachField(arrays, [&](const Real*& field) { field = fields_[k++]; });
    arrays.id = primitive_;
    arrays.count = n;
    if constexpr (Arrays::kKind == PrimitiveKind::kTriangle) CopyNormals(arrays);
  }

  void CopyNormals(TriangleArrays<Real>& triangles) {
    if (!data_.normals[0]) return;
    for (std::uint32_t n = 0; n < triangles.count; ++n) {
      const std::uint32_t id = primitive_[n];
      const auto object = std::upper_bound(data_.first.begin(), data_.first.end(), id) - 1;
      const std::uint32_t triangle =
          data_.first_triangle[static_cast<std::size_t>(object - data_.first.begin())] + id -
          *object;
      for (std::size_t k = 0; k < 9; ++k) normals_[k][n] = data_.normals[k][triangle];
    }
    for (std::size_t k = 0; k < 9; ++k) triangles.normal[k / 3][k % 3] = normals_[k];
  }

  template <typename Arrays, typename Put>
  void PutByScalar(const Arrays& arrays, const Put& put) {
    const RayView<Real>& rays = rays_.view();
    for (std::uint32_t n = 0; n < arrays.count; ++n) {
      const std::uint32_t i = ray_[n];
      const scalar::Ray<Real> ray = {
          {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
          {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]}};
      put(i,
          scalar::SurfaceAt(ray, scalar::Hit<Real>{t_[i], primitive_[n], u_[i], v_[i]}, arrays, n));
    }
  }

  template <typename Arrays, typename Put>
  void PutByKernel(const Arrays& arrays, const Put& put) {
    GeometryView<Real> geometry{};
    ForEachKind(geometry, [&](auto& kind) {
      if constexpr (std::is_same_v<decltype(kind), Arrays&>) kind = arrays;
    });
    const HitView<Real> hits = {t_, u_, v_, hit_primitive_};
    const HitBatch batch = {ray_, index_, primitive_, arrays.count};
    kernels_.surfaces_of(Arrays::kKind)(geometry, rays_.view(), hits, batch, 0, surfaces_);
    bool has_normals = false;
    if constexpr (Arrays::kKind == PrimitiveKind::kTriangle) {
      has_normals = arrays.normal[0][0] != nullptr;
      if (has_normals) {
        kernels_.blend_vertices(arrays, hits, batch, kNeedsNormals, surfaces_);
      }
    }
    const SurfaceOutput<Real>& s = surfaces_;
    for (std::uint32_t n = 0; n < arrays.count; ++n) {
      scalar::Surface<Real> surface{};
      surface.position = {s.position_x[n], s.position_y[n], s.position_z[n]};
      surface.normal = {s.normal_x[n], s.normal_y[n], s.normal_z[n]};
      surface.face = surface.normal;
      if (has_normals) surface.face = {s.face_x[n], s.face_y[n], s.face_z[n]};
      surface.offset = s.offset[n];
      surface.source = s.source[n];
      put(ray_[n], surface);
    }
  }

  const GeometryAccess::Data<Real>& data_;
  Target target_;
  Kernels<Real> kernels_;
  std::uint32_t count_ = 0;
  RayBlock<Real, kBlock> rays_;
  Real t_[kRoom], u_[kRoom], v_[kRoom];
  std::uint32_t hit_primitive_[kRoom];
  std::uint32_t ray_[kRoom], index_[kRoom], primitive_[kRoom];
  Real fields_[kMaxFields][kRoom], normals_[9][kRoom];
  SurfaceOutput<Real> surfaces_;
  Real numbers_[18][kRoom];
  std::uint32_t ids_[2][kRoom];
};

// A null pointer stays one.
template <typename T>
void PutAt(T* array, std::size_t i, T value) {
  if (array) array[i] = value;
}

template <typename Real>
void PutAt(const std::array<Real*, 3>& arrays, std::size_t i, Vec3<Real> value) {
  for (int axis = 0; axis < 3; ++axis) {
    PutAt(arrays[static_cast<std::size_t>(axis)], i, value[axis]);
  }
}

// The surface is that of rays and geometry at `scale`.
template <typename Real>
void PutPoint(const HitPointArraysOf<Real>& points, std::size_t i,
              const scalar::Surface<Real>& surface, Real scale) {
  const bool is_hit = surface.source != kNoPrimitive;
  // As src/scalar/spawn.h starts rays.
  const Vec3<Real> away = surface.face * surface.offset;
  PutAt(points.position, i, surface.position / scale);
  PutAt(points.face, i, surface.face);
  PutAt(points.normal, i, surface.normal);
  PutAt(points.front, i, (surface.position + away) / scale);
  PutAt(points.back, i, (surface.position - away) / scale);
  PutAt(points.front_source, i, surface.source);
  PutAt(points.back_source, i, is_hit ? surface.source ^ kInsideBit : kNoPrimitive);
  PutAt(points.side, i, is_hit && surface.inside() ? 1u : 0u);
}

template <typename Real>
Status CheckHits(const HitArraysOf<Real>& hits, std::size_t count) {
  if (count == 0) return Done{};
  if (!hits.t) return NullArray("t");
  if (!hits.primitive) return NullArray("primitive");
  if (!hits.u) return NullArray("u");
  if (!hits.v) return NullArray("v");
  return Done{};
}

}  // namespace

template <typename Real>
Status FindHitPoints(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                     const HitArraysOf<Real>& hits, std::size_t count,
                     const HitPointArraysOf<Real>& points, Target target) {
  if (Status checked = CheckRays(rays, count); !checked) return checked;
  if (Status checked = CheckHits(hits, count); !checked) return checked;
  const auto& data = GeometryAccess::DataOf(geometry);
  data.index.Ensure(data.view, data.first.back());
  HitBlock<Real> block(geometry, target);
  for (std::size_t first = 0; first < count; first += kBlock) {
    const auto n = static_cast<std::uint32_t>(std::min<std::size_t>(kBlock, count - first));
    const std::size_t wrong = block.Take(rays, hits, first, n);
    if (wrong < first + n) {
      return Error{ErrorKind::kUsage,
                   "hit " + std::to_string(wrong) + ": no ray hits its primitive in this geometry"};
    }
    scalar::Surface<Real> none{};
    none.source = kNoPrimitive;
    for (std::uint32_t i = 0; i < n; ++i) PutPoint(points, first + i, none, Real(1));
    block.ForEachSurface([&](std::uint32_t i, const scalar::Surface<Real>& surface) {
      PutPoint(points, first + i, surface, data.scale);
    });
  }
  return Done{};
}

template <typename Real>
Result<HitPointOf<Real>> FindHitPoint(const GeometryOf<Real>& geometry,
                                      const RayArraysOf<Real>& rays, const HitArraysOf<Real>& hits,
                                      std::size_t i) {
  const auto skip = [&]<typename T>(T*& array, std::size_t stride) {
    using Byte = std::conditional_t<std::is_const_v<T>, const std::byte, std::byte>;
    if (array)
      array = reinterpret_cast<T*>(reinterpret_cast<Byte*>(array) + StrideOf<T>(stride) * i);
  };
  RayArraysOf<Real> ray = rays;
  for (const Real** array : {&ray.origin_x, &ray.origin_y, &ray.origin_z, &ray.direction_x,
                             &ray.direction_y, &ray.direction_z}) {
    skip(*array, rays.stride);
  }
  HitArraysOf<Real> hit = hits;
  for (Real** array : {&hit.t, &hit.u, &hit.v}) skip(*array, hits.stride);
  skip(hit.primitive, hits.stride);
  HitPointOf<Real> point;
  const auto all = [](std::array<Real, 3>& a) { return std::array<Real*, 3>{&a[0], &a[1], &a[2]}; };
  const HitPointArraysOf<Real> arrays = {all(point.position), all(point.face), all(point.normal),
                                         all(point.front),    all(point.back), &point.front_source,
                                         &point.back_source,  &point.side};
  const Status found = FindHitPoints(geometry, ray, hit, 1, arrays);
  if (!found) return found.error();
  return point;
}

template Status FindHitPoints(const GeometryOf<float>&, const RayArraysOf<float>&,
                              const HitArraysOf<float>&, std::size_t,
                              const HitPointArraysOf<float>&, Target);
template Status FindHitPoints(const GeometryOf<double>&, const RayArraysOf<double>&,
                              const HitArraysOf<double>&, std::size_t,
                              const HitPointArraysOf<double>&, Target);
template Result<HitPointOf<float>> FindHitPoint(const GeometryOf<float>&, const RayArraysOf<float>&,
                                                const HitArraysOf<float>&, std::size_t);
template Result<HitPointOf<double>> FindHitPoint(const GeometryOf<double>&,
                                                 const RayArraysOf<double>&,
                                                 const HitArraysOf<double>&, std::size_t);

}  // namespace sheaf
