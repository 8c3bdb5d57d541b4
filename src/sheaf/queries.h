// What else can be asked of a geometry than its nearest hits: all hits of rays in order, and hits
// by masks, exclusions and filters of one's own.
//
// Threads, arrays, rays and failures are as in <sheaf/geometry.h>; every result is the same bits on
// every target and with any number of threads.
#ifndef SHEAF_SHEAF_QUERIES_H_
#define SHEAF_SHEAF_QUERIES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/geometry.h"
#include "sheaf/target.h"
#include "sheaf/version.h"

namespace sheaf {

// ---- Rays: all hits, masks, filters ----

// Which hits count, besides those within the interval. What is null rules nothing out.
struct HitRules {
  // A hit on object k counts for ray i where object_mask[k] & ray_mask[i] is not 0: an element an
  // object, and an element a ray; without `ray_mask`, all_ray_mask for all.
  const std::uint32_t* object_mask = nullptr;
  const std::uint32_t* ray_mask = nullptr;
  std::uint32_t all_ray_mask = 0xffffffffu;
  // Primitives that ray i does not hit, excluded[i * excluded_per_ray, (i + 1) * excluded_per_ray);
  // Geometry::kNoPrimitive for none.
  const std::uint32_t* excluded = nullptr;
  std::uint32_t excluded_per_ray = 0;
};

template <typename Real>
struct RuledTraceOptionsOf {
  TraceIntervalOf<Real> interval = {};
  HitRules rules = {};
  Target target = {};
};
using RuledTraceOptions = RuledTraceOptionsOf<float>;
using RuledTraceOptionsD = RuledTraceOptionsOf<double>;

// What TraceAll writes; arrays that are null are left out. They do not overlap each other nor the
// rays.
template <typename Real>
struct AllHitsOf {
  // Room for so many hits a ray; 0: none is listed.
  std::uint32_t capacity = 0;
  // The nearest hits of ray i are elements [i * capacity, i * capacity + listed[i]), in order. The
  // next one, where there is room, is as of a ray that misses; what follows is left alone.
  HitArraysOf<Real> hits = {};
  std::uint32_t* listed = nullptr;  // a ray: how many hits its list has, at most `capacity`
  // A ray: how many hits it has, listed or not. Null: nobody asks, which is faster where rays have
  // more hits than are listed.
  std::uint32_t* total = nullptr;
};
using AllHits = AllHitsOf<float>;
using AllHitsD = AllHitsOf<double>;

// All hits of each of `count` rays within its interval, by t, of equal t the lowest primitive
// first: one of a triangle or a disk; two of a sphere, where the ray enters it (u is 0) and where
// it leaves it (u is 1). A ray through an edge that two triangles share hits both: CountCrossings
// counts it once. Fails with kUsage where an origin or a direction is null, or `excluded` is null
// and `excluded_per_ray` is not 0; before anything is written.
template <typename Real>
SHEAF_API Status TraceAll(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                          std::size_t count, const AllHitsOf<Real>& lists,
                          const RuledTraceOptionsOf<Real>& options = {});

// All hits of rays, one ray's after the other's: those of ray i are elements [first[i], first[i +
// 1]) of the other arrays, in order.
template <typename Real>
struct HitRunsOf {
  std::vector<std::size_t> first;
  std::vector<Real> t, u, v;
  std::vector<std::uint32_t> primitive, object;
};
using HitRuns = HitRunsOf<float>;
using HitRunsD = HitRunsOf<double>;

// The same hits as TraceAll, as many as there are, or the nearest `most` of each ray.
template <typename Real>
SHEAF_API Result<HitRunsOf<Real>> ListAllHits(const GeometryOf<Real>& geometry,
                                              const RayArraysOf<Real>& rays, std::size_t count,
                                              const RuledTraceOptionsOf<Real>& options = {},
                                              std::uint32_t most = 0xffffffffu);

// Hits that a filter is asked about, an element each of every array; those of a ray in their order.
template <typename Real>
struct CandidateHitsOf {
  std::size_t count = 0;
  const std::size_t* ray = nullptr;  // by its place in the rays of the call
  const Real *t = nullptr, *u = nullptr, *v = nullptr;
  const std::uint32_t* primitive = nullptr;
  const std::uint32_t* object = nullptr;
};
using CandidateHits = CandidateHitsOf<float>;
using CandidateHitsD = CandidateHitsOf<double>;

// Sets accepted[k] to 1 for each candidate k that is a hit; all are 0 before. It is called on
// batches, from the thread that called, with hits of several rays at a time: some hits of a ray
// beyond its first accepted one may be among them, none comes twice. What it throws comes out of
// the call, and what is written then is undefined.
template <typename Real>
using HitFilterOf =
    std::function<void(const CandidateHitsOf<Real>& candidates, std::uint8_t* accepted)>;
using HitFilter = HitFilterOf<float>;
using HitFilterD = HitFilterOf<double>;

// The nearest hit of each ray that the rules admit and the filter accepts; an empty filter accepts
// all. Otherwise as TraceClosest, which has neither and is faster.
template <typename Real>
SHEAF_API Status TraceRuledClosest(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                                   std::size_t count, const HitArraysOf<Real>& hits,
                                   const RuledTraceOptionsOf<Real>& options,
                                   const HitFilterOf<Real>& filter = {});

// Whether each ray has such a hit: 1 or 0, as TraceOccluded.
template <typename Real>
SHEAF_API Status TraceRuledOccluded(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                                    std::size_t count, std::uint32_t* occluded,
                                    const RuledTraceOptionsOf<Real>& options,
                                    const HitFilterOf<Real>& filter = {});

// ---- Inside and outside ----

// Writes to crossings[0, count) how often each ray passes through surfaces within its interval: a
// triangle counts where TraceAll lists it, but an edge or a vertex that triangles share counts
// exactly once where the ray passes through the surface there, and an even number of times where it
// only touches it. So a ray crosses a closed mesh (each edge belongs to two triangles, or four,
// ...) an odd number of times exactly if it starts inside, wherever it goes: through vertices,
// along edges, in the planes of faces. What decides on the inside is only whether t is positive,
// which rounding may change for origins within a few roundoffs of the surface. Triangles without
// area are left out: the mesh is to be closed without them. Spheres count twice, disks once. Fails
// as TraceAll does, and where `crossings` is null. The first call for a geometry makes an index of
// five bytes a primitive.
template <typename Real>
SHEAF_API Status CountCrossings(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                                std::size_t count, std::uint32_t* crossings,
                                const RuledTraceOptionsOf<Real>& options = {});

// Points, an element each of every array, as RayArrays.
template <typename Real>
struct PointArraysOf {
  const Real* x = nullptr;
  const Real* y = nullptr;
  const Real* z = nullptr;
  std::size_t stride = 0;
};
using PointArrays = PointArraysOf<float>;
using PointArraysD = PointArraysOf<double>;

// Writes to inside[0, count): 1 where a point is inside an odd number of closed surfaces, meshes
// and spheres, else 0. Disks have no inside. Which objects count, and for which points, is up to
// `rules`, whose rays are the points. Points with a coordinate that is not finite are outside.
// Fails with kUsage where a coordinate or `inside` is null. Otherwise as CountCrossings.
template <typename Real>
SHEAF_API Status FindInside(const GeometryOf<Real>& geometry, const PointArraysOf<Real>& points,
                            std::size_t count, std::uint32_t* inside, const HitRules& rules = {},
                            Target target = {});

// ---- Nearest points ----

// What a distance says besides how far it is.
enum class DistanceSign {
  kNone,
  kInside,  // below 0 for points that FindInside finds inside
};

template <typename Real>
struct NearestOptionsOf {
  // Nothing beyond counts: an element a point, or one value for all.
  const Real* max_distance = nullptr;
  Real all_max_distance = std::numeric_limits<Real>::infinity();
  HitRules rules = {};  // which primitives count; its rays are the points
  DistanceSign sign = DistanceSign::kNone;
};
using NearestOptions = NearestOptionsOf<float>;
using NearestOptionsD = NearestOptionsOf<double>;

// What FindNearest writes, an element a point; arrays that are null are left out.
template <typename Real>
struct NearestArraysOf {
  Real* distance = nullptr;            // max_distance where nothing is as near
  std::uint32_t* primitive = nullptr;  // Geometry::kNoPrimitive where nothing is as near
  std::uint32_t* object = nullptr;     // likewise
  std::array<Real*, 3> position = {};  // x, y, z of the nearest point of its surface; else 0
};
using NearestArrays = NearestArraysOf<float>;
using NearestArraysD = NearestArraysOf<double>;

// The nearest point of any surface to each of `count` points, of equal distance the lowest
// primitive. A sphere is its shell, from inside too. It is computed in double and rounded once:
// floats are within 2 ULP of what double gives over every primitive. What no ray can hit is not
// near. Of a point with a coordinate that is not finite, or whose max_distance is NaN, nothing is.
// Fails with kUsage where a coordinate is null.
template <typename Real>
SHEAF_API Status FindNearest(const GeometryOf<Real>& geometry, const PointArraysOf<Real>& points,
                             std::size_t count, const NearestArraysOf<Real>& nearest,
                             const NearestOptionsOf<Real>& options = {});

// ---- Overlap ----

// Which primitives meet a region, ascending; arrays that are null are left out.
struct OverlapLists {
  std::uint32_t capacity = 0;  // room for so many primitives a region
  std::uint32_t* primitive =
      nullptr;                      // those of region i: [i * capacity, i * capacity + listed[i])
  std::uint32_t* listed = nullptr;  // a region: at most `capacity`
  std::uint32_t* total = nullptr;   // a region: how many meet it, listed or not
};

// Boxes along the axes, an element each of every array; one with lower > upper meets nothing.
template <typename Real>
struct BoxArraysOf {
  std::array<const Real*, 3> lower = {}, upper = {};
  std::size_t stride = 0;  // as in RayArrays
};
using BoxArrays = BoxArraysOf<float>;
using BoxArraysD = BoxArraysOf<double>;

// The primitives that meet each box, touching it from outside or lying inside it. A sphere is its
// shell: a box within it does not meet it. Decided in double: what touches to a rounding may go
// either way. What no ray can hit meets nothing. Fails with kUsage where a coordinate is null.
template <typename Real>
SHEAF_API Status FindInBoxes(const GeometryOf<Real>& geometry, const BoxArraysOf<Real>& boxes,
                             std::size_t count, const OverlapLists& lists);

// The primitives whose nearest point is at most radius[i] away from point i, with the same words.
// `radius` has the stride of the points.
template <typename Real>
SHEAF_API Status FindInBalls(const GeometryOf<Real>& geometry, const PointArraysOf<Real>& points,
                             const Real* radius, std::size_t count, const OverlapLists& lists);

}  // namespace sheaf

#endif  // SHEAF_SHEAF_QUERIES_H_
