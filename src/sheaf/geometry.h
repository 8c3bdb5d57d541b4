// Triangles, spheres and disks to trace rays against: the library without the renderer.
//
//   GeometryInput input;
//   input.AddTriangles(vertices, indices);
//   Result<Geometry> geometry = Geometry::Build(input);
//   TraceClosest(geometry.value(), rays, count, hits).value();
//
// Lengths are in any one unit. Geometry, RayArrays and their like are of floats, GeometryD,
// RayArraysD and their like of doubles; both are templates over the number. The hits are those of
// strict arithmetic, the same bits on every processor. Memory that runs out throws std::bad_alloc,
// and leaves whatever there was as it was; nothing else throws.
//
// Whether the processor flushes denormals to zero (FTZ, DAZ) is up to the host: the library neither
// needs nor changes it. Hits depend on it only where coordinates themselves, or differences of
// coordinates, are below the smallest normal number.
#ifndef SHEAF_SHEAF_GEOMETRY_H_
#define SHEAF_SHEAF_GEOMETRY_H_

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/target.h"
#include "sheaf/version.h"

namespace sheaf {

// Anything that std::span<const double> can show: an array or a vector of doubles.
template <typename Numbers>
concept Doubles = std::convertible_to<const Numbers&, std::span<const double>>;

// The objects of a geometry, by reference: what the spans show must live until Build has returned.
// Objects are numbered from 0 in the order of the calls, primitives from 0 through all objects.
// Numbers are floats or doubles, object by object; Build rounds to what it builds of. Nothing is
// checked before Build.
class GeometryInput {
 public:
  // A mesh. `vertices`: x, y, z of each, any finite number; `indices`: three vertices a triangle,
  // each below the number of vertices. A triangle without area is never hit. `normals`: x, y, z for
  // each vertex, of any length and either side, for HitPoint::normal; 0 stands for the face's own,
  // and so do none. Returns the object's id.
  std::uint32_t AddTriangles(std::span<const float> vertices,
                             std::span<const std::uint32_t> indices,
                             std::span<const float> normals = {}) {
    return Add(0, Numbers(vertices), indices, Numbers(normals));
  }
  template <Doubles Vertices>
  std::uint32_t AddTriangles(const Vertices& vertices, std::span<const std::uint32_t> indices,
                             std::span<const double> normals = {}) {
    return Add(0, Numbers(std::span<const double>(vertices)), indices, Numbers(normals));
  }
  // `spheres`: center x, y, z and radius of each, finite, the radius >= 0. A sphere of radius 0 is
  // never hit. Returns the object's id.
  std::uint32_t AddSpheres(std::span<const float> spheres) { return Add(1, Numbers(spheres)); }
  template <Doubles Spheres>
  std::uint32_t AddSpheres(const Spheres& spheres) {
    return Add(1, Numbers(std::span<const double>(spheres)));
  }
  // `disks`: center x, y, z, radius and normal x, y, z of each, finite, the radius >= 0, the normal
  // of any length but 0. A disk of radius 0 is never hit. Returns the object's id.
  std::uint32_t AddDisks(std::span<const float> disks) { return Add(2, Numbers(disks)); }
  template <Doubles Disks>
  std::uint32_t AddDisks(const Disks& disks) {
    return Add(2, Numbers(std::span<const double>(disks)));
  }

 private:
  friend struct GeometryAccess;

  // Floats or doubles.
  struct Numbers {
    std::span<const float> floats;
    std::span<const double> doubles;

    Numbers() = default;
    explicit Numbers(std::span<const float> given) : floats(given) {}
    explicit Numbers(std::span<const double> given) : doubles(given) {}
  };
  struct Object {
    std::uint32_t kind;
    Numbers numbers;                         // vertices, or the fields of primitives in turn
    std::span<const std::uint32_t> indices;  // of a mesh
    Numbers normals;                         // likewise, or none
  };

  // Primitives of a kind, by the library's own number for it.
  SHEAF_API std::uint32_t Add(std::uint32_t kind, Numbers numbers,
                              std::span<const std::uint32_t> indices = {},
                              Numbers normals = Numbers());

  std::vector<Object> objects_;
};

// What a build does with a primitive that has a number that is not finite.
enum class NotFinite {
  kRefused,  // fails, and names the primitive
  kSkipped,  // leaves it out, and counts it; it keeps its id, which no ray hits
};

struct BuildOptions {
  int threads = 0;  // at most so many; 0: one a core
  NotFinite not_finite = NotFinite::kRefused;
};

// Update builds the tree anew where moving has made rays so many times as dear as right after the
// last build, by the surface area heuristic: boxes that overlap more are met more often.
inline constexpr double kRebuildRatio = 1.5;

struct UpdateOptions {
  int threads = 0;  // as in BuildOptions, and so the next
  NotFinite not_finite = NotFinite::kRefused;
  // 0 always builds, infinity does not as long as a refit is possible.
  double rebuild_ratio = kRebuildRatio;
};

// What an update did.
enum class Updated {
  kRefitted,  // the tree is the old one with new boxes
  kRebuilt,   // built anew
};

// What Map looks at. A file that is only opened is read where rays need it.
enum class MapCheck {
  kAll,     // reads all of it: checksums, every index, and that boxes hold what is in them
  kHeader,  // header and sizes alone, for a file that is known to be sound: takes no time
};

// What a geometry is made of, and takes.
struct GeometryStatistics {
  std::uint32_t primitives;                 // in the tree, of all kinds
  std::uint32_t triangles, spheres, disks;  // of these
  // Left out, because no ray can hit it: without area, of radius 0, or so small beside the largest
  // triangle that its area is 0 in the arithmetic (docs/numerics.md has the numbers).
  std::uint32_t never_hit;
  std::uint32_t skipped;               // left out by NotFinite::kSkipped
  std::uint32_t nodes, leaves, depth;  // of the tree
  std::size_t bytes;                   // of memory, all that the geometry holds
};

// Objects with a tree over their primitives; needs nothing of the input any more. Nothing but
// Update and assignment changes one, so that any number of threads may use it; it can be moved, and
// is then empty.
template <typename Real>
class GeometryOf {
 public:
  // In place of a primitive's id: none. Ids are below it.
  static constexpr std::uint32_t kNoPrimitive = 0x7fffffffu;
  // With a sphere's id as a ray's source: the ray runs inside the sphere (see RayArrays::source).
  static constexpr std::uint32_t kInsideBit = 0x80000000u;

  // Without objects: every ray misses it.
  SHEAF_API GeometryOf();
  SHEAF_API GeometryOf(GeometryOf&& other) noexcept;
  SHEAF_API GeometryOf& operator=(GeometryOf&& other) noexcept;
  SHEAF_API ~GeometryOf();

  // Builds in an arena of oneTBB of its own: of more threads than the process allows oneTBB, which
  // is one a core unless the host sets another limit, the rest is left out. The geometry does not
  // depend on how many there are. Fails with kUsage and the object's and the primitive's number
  // where an array is null, an index is out of range, a coordinate is not finite, a radius is
  // negative or a count does not divide, and with kUsage where there are more than 2^26 primitives
  // of a kind.
  SHEAF_API static Result<GeometryOf> Build(const GeometryInput& input,
                                            const BuildOptions& options);
  static Result<GeometryOf> Build(const GeometryInput& input, int threads = 0) {
    return Build(input, BuildOptions{.threads = threads});
  }

  // Makes the geometry that Build makes of `input`, with the same hits to the bit, whatever it was
  // before. Where the objects have the same kinds and as many primitives as now, and the same of
  // these can be hit, as when vertices move, the tree is kept and its boxes are fitted to them,
  // which takes a fraction of a build. Fails as Build does, and the geometry is what it was before;
  // so it is where memory runs out. No other call may use the geometry meanwhile, nor instances of
  // it, which have to be built again after it: where pictures go on, build or update a second one.
  SHEAF_API Result<Updated> Update(const GeometryInput& input, const UpdateOptions& options = {});

  // Writes the geometry with its tree to a file, for Map. The old file or the whole new one is
  // there, whatever happens. Fails with kInputOutput. docs/geometry.md has the format, which
  // belongs to the version of Sheaf and the kind of machine.
  SHEAF_API Status Save(const std::string& path) const;
  // The geometry of a file that Save wrote: the same hits to the bit. The file is mapped read-only,
  // and its pages shared with all that map it; it must not be written to meanwhile, but may be
  // replaced by Save, renamed or removed. Fails with kInputOutput, the path and what is wrong where
  // it cannot be read or is not such a file: cut off, damaged, of another version, of the other
  // kind of numbers.
  SHEAF_API static Result<GeometryOf> Map(const std::string& path, MapCheck check = MapCheck::kAll);

  // The smallest box around the primitives, up to a millionth of its size; lower > upper where
  // there are none. x, y, z; the largest float for what is larger.
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

  std::unique_ptr<Data> data_;  // null: without objects
};
using Geometry = GeometryOf<float>;
using GeometryD = GeometryOf<double>;

// Rays, an element each of every array. Not owned; no array needs padding or alignment.
template <typename Real>
struct RayArraysOf {
  const Real* origin_x = nullptr;
  const Real* origin_y = nullptr;
  const Real* origin_z = nullptr;
  const Real* direction_x = nullptr;  // of any length but 0; t counts in lengths of it
  const Real* direction_y = nullptr;
  const Real* direction_z = nullptr;
  // The primitive that a ray starts on, Geometry::kNoPrimitive for none; null: none for all. A
  // triangle or a disk is never hit by its own ray. A sphere is not either, or with
  // Geometry::kInsideBit in the far root alone.
  const std::uint32_t* source = nullptr;
  // Bytes from a ray to the next, the same in all arrays, where rays are structures:
  // {&rays[0].x, &rays[0].y, ..., .stride = sizeof(rays[0])}. 0: the arrays hold nothing else,
  // which is faster, as nothing is copied.
  std::size_t stride = 0;
};
using RayArrays = RayArraysOf<float>;
using RayArraysD = RayArraysOf<double>;

// A hit at t counts where t_min <= t <= t_max. An array where each ray has its own interval, else
// one value for all. By default every hit in front of the origin counts, but none at 0 nor below
// the smallest normal number, which is 0 to a host that flushes denormals.
template <typename Real>
struct TraceIntervalOf {
  const Real* t_min = nullptr;
  const Real* t_max = nullptr;
  Real all_t_min = std::numeric_limits<Real>::min();
  Real all_t_max = std::numeric_limits<Real>::max();
  std::size_t stride = 0;  // as in RayArrays, of both arrays
};
using TraceInterval = TraceIntervalOf<float>;
using TraceIntervalD = TraceIntervalOf<double>;

// What is known of a batch of rays. It may change the time a batch takes, never a hit.
enum class RayCoherence {
  kUnknown,       // measured, 16 rays at a time
  kCommonOrigin,  // the same, where rays share their origin
  kCoherent,      // neighbours go similar ways from different origins
  kIncoherent,    // neighbours go different ways
};

template <typename Real>
struct TraceOptionsOf {
  TraceIntervalOf<Real> interval = {};
  RayCoherence coherence = RayCoherence::kUnknown;
  Target target = {};  // what computes it; the bits are the same on all
};
using TraceOptions = TraceOptionsOf<float>;
using TraceOptionsD = TraceOptionsOf<double>;

// What TraceClosest writes, `count` elements each; arrays that are null are left out. They do not
// overlap each other nor the rays.
template <typename Real>
struct HitArraysOf {
  Real* t = nullptr;                   // in lengths of the direction; t_max where the ray misses
  std::uint32_t* primitive = nullptr;  // Geometry::kNoPrimitive where the ray misses
  std::uint32_t* object = nullptr;     // likewise
  // Where on the primitive; 0 where the ray misses.
  // Triangle: the barycentric weights of the second and the third vertex.
  // Sphere: u is 0 where the ray enters and 1 where it leaves; v is what rounding took from t, so
  // that t + v, summed in double, is the distance to twice the digits (0 of doubles).
  // Disk: its surface coordinates, 0 to 1 across the square around it, (0.5, 0.5) in the middle.
  Real* u = nullptr;
  Real* v = nullptr;
  std::size_t stride = 0;  // as in RayArrays, of all that are there
};
using HitArrays = HitArraysOf<float>;
using HitArraysD = HitArraysOf<double>;

// The nearest hit of each of `count` rays; of equal t the lowest primitive. Rays with a component
// that is not finite, with no direction or with t_min > t_max miss. Rays with t_min < 0 or with
// directions of odd length take a little longer; rays from further away than 5e11 are tested
// against every primitive. Takes at most 64 KiB of stack where rays are arrays of floats. Fails
// with kUsage where an origin or a direction is null, before anything is written. Safe to call from
// any number of threads at once.
template <typename Real>
SHEAF_API Status TraceClosest(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                              std::size_t count, const HitArraysOf<Real>& hits,
                              const TraceOptionsOf<Real>& options = {});

// Writes to occluded[0, count): 1 where a ray hits anything within its interval, else 0. Rays,
// threads and failures as with TraceClosest; fails where `occluded` is null too.
template <typename Real>
SHEAF_API Status TraceOccluded(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                               std::size_t count, std::uint32_t* occluded,
                               const TraceOptionsOf<Real>& options = {});

// ---- Going on from a hit ----

// What a hit is, and where to start rays from it. `front` is a little off the surface on the side
// that the ray came from, `back` on the other, by a bound on every rounding error: a ray from
// `front` with `front_source` that leaves on that side does not meet the primitive again, nor a
// neighbour in its plane; one from `back` with `back_source` likewise. So start shadows and mirrors
// in front, what passes through at the back. (The bound is docs/numerics.md's, the renderer's own.)
template <typename Real>
struct HitPointOf {
  std::array<Real, 3> position = {};  // x, y, z: on the surface, to a rounding
  std::array<Real, 3> face = {};      // normal of the surface: unit, towards the ray
  std::array<Real, 3> normal = {};    // for shading: unit, on the side of `face`; where no normals
                                      // were given, `face`
  std::array<Real, 3> front = {}, back = {};
  // What RayArrays::source has to be for rays from there; kNoPrimitive where there was no hit.
  std::uint32_t front_source = GeometryOf<Real>::kNoPrimitive;
  std::uint32_t back_source = GeometryOf<Real>::kNoPrimitive;
  // 0: the ray came from outside: a triangle's side where its vertices run counter-clockwise, a
  // disk's that its normal shows to. 1: from inside.
  std::uint32_t side = 0;
};
using HitPoint = HitPointOf<float>;
using HitPointD = HitPointOf<double>;

// The same as arrays, x, y and z apart; what is null is left out. All 0, and sources kNoPrimitive,
// where the ray missed. They overlap neither each other nor what is read.
template <typename Real>
struct HitPointArraysOf {
  std::array<Real*, 3> position = {}, face = {}, normal = {}, front = {}, back = {};
  std::uint32_t* front_source = nullptr;
  std::uint32_t* back_source = nullptr;
  std::uint32_t* side = nullptr;
};
using HitPointArrays = HitPointArraysOf<float>;
using HitPointArraysD = HitPointArraysOf<double>;

// The points of `count` hits, which TraceClosest found for these rays: t, u, v and primitive of
// each are read. Fails with kUsage where one of these arrays, an origin or a direction is null, or
// a primitive is none that rays of this geometry hit; what is written then is undefined. The first
// call for a geometry makes an index of five bytes a primitive. Safe to call from any number of
// threads at once; the bits are the same on every target.
template <typename Real>
SHEAF_API Status FindHitPoints(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                               const HitArraysOf<Real>& hits, std::size_t count,
                               const HitPointArraysOf<Real>& points, Target target = {});

// The point of one hit, number `i` of the arrays.
template <typename Real>
SHEAF_API Result<HitPointOf<Real>> FindHitPoint(const GeometryOf<Real>& geometry,
                                                const RayArraysOf<Real>& rays,
                                                const HitArraysOf<Real>& hits, std::size_t i);

}  // namespace sheaf

#endif  // SHEAF_SHEAF_GEOMETRY_H_
