// What else can be asked of a geometry than its nearest hits: all hits of rays in order, and hits
// by masks, exclusions and filters of one's own.
//
// Threads, arrays, rays and failures are as in <sheaf/geometry.h>; every result is the same bits on
// every target and with any number of threads.
#ifndef SHEAF_SHEAF_QUERIES_H_
#define SHEAF_SHEAF_QUERIES_H_

#include <cstddef>
#include <cstdint>
#include <functional>

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
  // The nearest hits of ray i are elements [i * capacity, i * capacity + listed[i]), in order;
  // those from there to (i + 1) * capacity are written as of a ray that misses.
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

}  // namespace sheaf

#endif  // SHEAF_SHEAF_QUERIES_H_
