// Triangles, spheres and disks to trace rays against: the library without the renderer.
//
//   GeometryInput input;
//   input.AddTriangles(vertices, indices);
//   Result<Geometry> geometry = Geometry::Build(input);
//   TraceClosest(geometry.value(), rays, count, hits).value();
//
// Lengths are in any one unit. Everything is single precision; the hits are those of strict
// arithmetic, the same bits on every processor. Memory that runs out throws std::bad_alloc, and
// leaves whatever there was as it was; nothing else throws.
//
// Whether the processor flushes denormals to zero (FTZ, DAZ) is up to the host: the library neither
// needs nor changes it. Hits depend on it only where coordinates themselves, or differences of
// coordinates, are below the smallest normal number.
#ifndef SHEAF_SHEAF_GEOMETRY_H_
#define SHEAF_SHEAF_GEOMETRY_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/target.h"
#include "sheaf/version.h"

namespace sheaf {

// The objects of a geometry, by reference: what the spans show must live until Build has returned.
// Objects are numbered from 0 in the order of the calls, primitives from 0 through all objects.
// Nothing is checked before Build.
class GeometryInput {
 public:
  // A mesh. `vertices`: x, y, z of each, any finite number; `indices`: three vertices a triangle,
  // each below the number of vertices. A triangle without area is never hit. Returns the object's
  // id.
  SHEAF_API std::uint32_t AddTriangles(std::span<const float> vertices,
                                       std::span<const std::uint32_t> indices);
  // `spheres`: center x, y, z and radius of each, finite, the radius >= 0. A sphere of radius 0 is
  // never hit. Returns the object's id.
  std::uint32_t AddSpheres(std::span<const float> spheres) { return Add(1, spheres); }
  // `disks`: center x, y, z, radius and normal x, y, z of each, finite, the radius >= 0, the normal
  // of any length but 0. A disk of radius 0 is never hit. Returns the object's id.
  std::uint32_t AddDisks(std::span<const float> disks) { return Add(2, disks); }

 private:
  friend struct GeometryAccess;
  // Primitives of a kind, by the library's own number for it.
  SHEAF_API std::uint32_t Add(std::uint32_t kind, std::span<const float> fields);

  struct Object {
    std::uint32_t kind;
    std::span<const float> numbers;          // vertices, or the fields of primitives in turn
    std::span<const std::uint32_t> indices;  // of a mesh
  };
  std::vector<Object> objects_;
};

// What a geometry is made of, and takes.
struct GeometryStatistics {
  std::uint32_t primitives;            // in the tree, of all kinds
  std::uint32_t triangles, spheres;    // of these
  std::uint32_t never_hit;             // left out: without area, of radius 0
  std::uint32_t nodes, leaves, depth;  // of the tree
  std::size_t bytes;                   // of memory, all that the geometry holds
};

// Objects with a tree over their primitives; needs nothing of the input any more. Immutable, so
// that any number of threads may use one; it can be moved, and is then empty.
class Geometry {
 public:
  // In place of a primitive's id: none. Ids are below it.
  static constexpr std::uint32_t kNoPrimitive = 0x7fffffffu;
  // With a sphere's id as a ray's source: the ray runs inside the sphere (see RayArrays::source).
  static constexpr std::uint32_t kInsideBit = 0x80000000u;

  // Without objects: every ray misses it.
  SHEAF_API Geometry();
  SHEAF_API Geometry(Geometry&& other) noexcept;
  SHEAF_API Geometry& operator=(Geometry&& other) noexcept;
  SHEAF_API ~Geometry();

  // Builds on `threads` threads (0: one a core), in an arena of oneTBB of its own: of more than the
  // process allows oneTBB, which is one a core unless the host sets another limit, the rest is left
  // out. The geometry does not depend on how many. Fails with kUsage and the object's and the
  // primitive's number where an array is null, an index is out of range, a coordinate is not
  // finite, a radius is negative or a count does not divide, and with kUsage where there are more
  // than 2^26 primitives of a kind.
  SHEAF_API static Result<Geometry> Build(const GeometryInput& input, int threads = 0);

  // The smallest box around the primitives, up to a millionth of its size; lower > upper where
  // there are none. x, y, z.
  SHEAF_API std::array<float, 3> lower() const;
  SHEAF_API std::array<float, 3> upper() const;
  // Walks the whole tree.
  SHEAF_API GeometryStatistics statistics() const;

  SHEAF_API std::uint32_t object_count() const;
  // The object that a primitive belongs to. `primitive` is below the number of all given.
  SHEAF_API std::uint32_t object_of(std::uint32_t primitive) const;
  // The first primitive of an object, or for object_count() the number of all primitives given.
  SHEAF_API std::uint32_t first_primitive(std::uint32_t object) const;

 private:
  friend struct GeometryAccess;
  struct Data;
  const Data& data() const;

  std::unique_ptr<const Data> data_;  // null: without objects
};

// Rays, an element each of every array. Not owned; no array needs padding or alignment.
struct RayArrays {
  const float* origin_x = nullptr;
  const float* origin_y = nullptr;
  const float* origin_z = nullptr;
  const float* direction_x = nullptr;  // of any length but 0; t counts in lengths of it
  const float* direction_y = nullptr;
  const float* direction_z = nullptr;
  // The primitive that a ray starts on, Geometry::kNoPrimitive for none; null: none for all. A
  // triangle or a disk is never hit by its own ray. A sphere is not either, or with
  // Geometry::kInsideBit in the far root alone.
  const std::uint32_t* source = nullptr;
};

// A hit at t counts where t_min <= t <= t_max. An array where each ray has its own interval, else
// one value for all. By default every hit in front of the origin counts, but none at 0 nor below
// the smallest normal number, which is 0 to a host that flushes denormals.
struct TraceInterval {
  const float* t_min = nullptr;
  const float* t_max = nullptr;
  float all_t_min = std::numeric_limits<float>::min();
  float all_t_max = std::numeric_limits<float>::max();
};

// What is known of a batch of rays. It may change the time a batch takes, never a hit.
enum class RayCoherence {
  kUnknown,       // measured, 16 rays at a time
  kCommonOrigin,  // the same, where rays share their origin
  kCoherent,      // neighbours go similar ways from different origins
  kIncoherent,    // neighbours go different ways
};

struct TraceOptions {
  TraceInterval interval;
  RayCoherence coherence = RayCoherence::kUnknown;
  Target target = {};  // what computes it; the bits are the same on all
};

// What TraceClosest writes, `count` elements each; arrays that are null are left out. They do not
// overlap each other nor the rays.
struct HitArrays {
  float* t = nullptr;                  // in lengths of the direction; t_max where the ray misses
  std::uint32_t* primitive = nullptr;  // Geometry::kNoPrimitive where the ray misses
  std::uint32_t* object = nullptr;     // likewise
  // Where on the primitive; 0 where the ray misses.
  // Triangle: the barycentric weights of the second and the third vertex.
  // Sphere: u is 0 where the ray enters and 1 where it leaves; v is what rounding took from t, so
  // that t + v, summed in double, is the distance to twice the digits.
  // Disk: its surface coordinates, 0 to 1 across the square around it, (0.5, 0.5) in the middle.
  float* u = nullptr;
  float* v = nullptr;
};

// The nearest hit of each of `count` rays; of equal t the lowest primitive. Rays with a component
// that is not finite, with no direction or with t_min > t_max miss. Rays with t_min < 0 or with
// directions of odd length take a little longer; rays from further away than 5e11 are tested
// against every primitive. Takes at most 64 KiB of stack. Fails with kUsage where an origin or a
// direction is null, before anything is written. Safe to call from any number of threads at once.
SHEAF_API Status TraceClosest(const Geometry& geometry, const RayArrays& rays, std::size_t count,
                              const HitArrays& hits, const TraceOptions& options = {});

// Writes to occluded[0, count): 1 where a ray hits anything within its interval, else 0. Rays,
// threads and failures as with TraceClosest; fails where `occluded` is null too.
SHEAF_API Status TraceOccluded(const Geometry& geometry, const RayArrays& rays, std::size_t count,
                               std::uint32_t* occluded, const TraceOptions& options = {});

}  // namespace sheaf

#endif  // SHEAF_SHEAF_GEOMETRY_H_
