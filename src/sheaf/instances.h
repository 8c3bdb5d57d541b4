// Geometries that stand in many places: a forest of a few trees.
//
//   Result<Instances> instances = Instances::Build(geometries, places);
//   TraceClosest(instances.value(), rays, count, hits).value();
//
// What a geometry holds is there once, however often it stands somewhere; a place takes some 150
// bytes. A ray is mapped into a geometry and traced there in strict arithmetic, so that hits are
// the same bits on every processor, and neither cracks nor gaps open between a geometry's
// triangles. Numbers, memory and threads are as in <sheaf/geometry.h>.
#ifndef SHEAF_SHEAF_INSTANCES_H_
#define SHEAF_SHEAF_INSTANCES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "sheaf/error.h"
#include "sheaf/geometry.h"
#include "sheaf/version.h"

namespace sheaf {

// Where a geometry stands.
struct Place {
  std::uint32_t geometry = 0;  // position among the geometries
  // The first three rows of a 4 x 4 matrix, row by row, which takes points of the geometry to the
  // world: x' = m[0] x + m[1] y + m[2] z + m[3], and so on. Finite. It may turn, move, scale, shear
  // and mirror, but not flatten: |M| |M^-1| has no row whose sum is above a million.
  std::array<double, 12> to_world = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
};

// What InstancesOf is made of, and takes.
struct InstanceStatistics {
  std::uint32_t instances;  // all, those of empty geometries too
  std::uint32_t geometries;
  std::uint32_t nodes, depth;  // of the tree over instances
  std::size_t bytes;           // of memory, without the geometries
};

// Geometries with a tree over the places where they stand. Immutable, so that any number of threads
// may use one; it can be moved, and is then empty.
template <typename Real>
class InstancesOf {
 public:
  using Geometries = std::span<const std::shared_ptr<const GeometryOf<Real>>>;
  // In place of an instance's number, where a ray hit nothing or starts on none.
  static constexpr std::uint32_t kNoInstance = 0xffffffffu;

  // Without places: every ray misses it.
  SHEAF_API InstancesOf();
  SHEAF_API InstancesOf(InstancesOf&& other) noexcept;
  SHEAF_API InstancesOf& operator=(InstancesOf&& other) noexcept;
  SHEAF_API ~InstancesOf();

  // Instances are numbered in the order of `places`, from 0. Shares the geometries. `threads` as of
  // BuildOptions. Fails with kUsage, and the number of what is wrong, where a geometry is null or
  // out of range, a number is not finite, a map flattens, or there are more than 2^26 places.
  SHEAF_API static Result<InstancesOf> Build(Geometries geometries, std::span<const Place> places,
                                             int threads = 0);

  // A box around all; lower > upper where there is nothing. x, y, z.
  SHEAF_API std::array<float, 3> lower() const;
  SHEAF_API std::array<float, 3> upper() const;
  SHEAF_API InstanceStatistics statistics() const;

 private:
  friend struct InstancesAccess;
  struct Data;
  std::unique_ptr<const Data> data_;  // null: without places
};
using Instances = InstancesOf<float>;
using InstancesD = InstancesOf<double>;

// Rays besides what RayArrays has of them.
struct InstanceRayArrays {
  // The instance that a ray starts on, whose primitive RayArrays::source is then; kNoInstance for
  // none; null: none for all. With the same stride as the rays.
  const std::uint32_t* source_instance = nullptr;
};

// The nearest hit of each of `count` rays; of equal t the lowest instance, then the lowest
// primitive. `instance`: where it is not null, receives the number of the instance, kNoInstance
// where the ray misses; with the stride of the hits. Primitives and objects are numbered within
// their geometry, t counts in lengths of the ray's direction. Rays that TraceClosest of a geometry
// tests against every primitive go through every instance here. The rest as there; takes at most
// 160 KiB of stack where rays are floats.
template <typename Real>
SHEAF_API Status TraceClosest(const InstancesOf<Real>& instances, const RayArraysOf<Real>& rays,
                              std::size_t count, const HitArraysOf<Real>& hits,
                              std::uint32_t* instance, const TraceOptionsOf<Real>& options = {},
                              const InstanceRayArrays& sources = {});

// Writes to occluded[0, count): 1 where a ray hits anything within its interval, else 0.
template <typename Real>
SHEAF_API Status TraceOccluded(const InstancesOf<Real>& instances, const RayArraysOf<Real>& rays,
                               std::size_t count, std::uint32_t* occluded,
                               const TraceOptionsOf<Real>& options = {},
                               const InstanceRayArrays& sources = {});

}  // namespace sheaf

#endif  // SHEAF_SHEAF_INSTANCES_H_
