// From arrays of any length, stride and scale to the kernels, which take whole vectors: in place
// what can be, the last few rays and whatever is not in plain arrays through a padded copy.
#include <algorithm>
#include <cstddef>

#include "sheaf/geometry.h"
#include "simd/kernels.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/ray_batches.h"
#include "src/bvh/ray_block.h"
#include "src/scalar/trace_tree.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kChunk = 256;  // rays at a time where a result is not wanted
constexpr std::uint32_t kBlock = 128;  // rays that are gathered, or whose hits are, at a time
static_assert(kBlock <= kChunk);

template <typename T>
T* Skip(T* array, std::size_t first) {
  return array ? array + first : nullptr;
}

template <typename Real>
RayView<Real> Skip(RayView<Real> rays, std::size_t first) {
  ForEachField(rays, [&](auto& field) { field = Skip(field, first); });
  return rays;
}

template <typename Real>
RayIntervals<Real> Skip(RayIntervals<Real> intervals, std::size_t first) {
  intervals.t_min = Skip(intervals.t_min, first);
  intervals.t_max = Skip(intervals.t_max, first);
  return intervals;
}

Coherence CoherenceOf(RayCoherence coherence) {
  switch (coherence) {
    case RayCoherence::kCommonOrigin:
      return Coherence::kCommonOrigin;
    case RayCoherence::kCoherent:
      return Coherence::kCoherent;
    case RayCoherence::kIncoherent:
      return Coherence::kIncoherent;
    case RayCoherence::kUnknown:
      break;
  }
  return Coherence::kUnknown;
}

template <typename Real>
RayView<Real> ViewOf(const RayArraysOf<Real>& rays) {
  return {rays.origin_x,    rays.origin_y,    rays.origin_z, rays.direction_x,
          rays.direction_y, rays.direction_z, rays.source};
}

template <typename Real>
RayIntervals<Real> IntervalsOf(const TraceIntervalOf<Real>& interval) {
  return {interval.t_min, interval.t_max, interval.all_t_min, interval.all_t_max};
}

template <typename Real>
scalar::Ray<Real> RayIn(const RayView<Real>& rays, const RayIntervals<Real>& intervals,
                        std::uint32_t i) {
  scalar::Ray<Real> ray = scalar::RayAt(rays, i);
  ray.t_min = intervals.t_min ? intervals.t_min[i] : intervals.all_t_min;
  ray.t_max = intervals.t_max ? intervals.t_max[i] : intervals.all_t_max;
  return ray;
}

// The baseline, as the kernels are called.
template <typename Real>
void ScalarClosest(const TreeView<Real>& tree, const RayView<Real>& rays,
                   const RayIntervals<Real>& intervals, std::uint32_t count,
                   Coherence /*coherence*/, const HitOutput<Real>& hits) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const scalar::Hit<Real> hit = scalar::TraceClosest(tree, RayIn(rays, intervals, i));
    hits.t[i] = hit.t;
    hits.u[i] = hit.u;
    hits.v[i] = hit.v;
    hits.primitive[i] = hit.primitive;
  }
}

template <typename Real>
void ScalarOccluded(const TreeView<Real>& tree, const RayView<Real>& rays,
                    const RayIntervals<Real>& intervals, std::uint32_t count,
                    Coherence /*coherence*/, std::uint32_t* occluded) {
  for (std::uint32_t i = 0; i < count; ++i) {
    occluded[i] = scalar::TraceOccluded(tree, RayIn(rays, intervals, i)) ? 1 : 0;
  }
}

template <typename Real>
struct TraceKernels {
  TraceClosestKernel<Real>* closest;
  TraceOccludedKernel<Real>* occluded;
};

template <typename Real>
TraceKernels<Real> KernelsOf(Target target) {
  if (target.is_scalar()) return {&ScalarClosest<Real>, &ScalarOccluded<Real>};
  // Looked up once: a batch may be one ray.
  static const Kernels<Real> best = StrictKernels<Real>(0);
  if (target == Target()) return {best.trace_closest, best.trace_occluded};
  const Kernels<Real> kernels = StrictKernels<Real>(target.id());
  return {kernels.trace_closest, kernels.trace_occluded};
}

// Writes the objects of `count` primitives; neighbours tend to share one.
template <typename Real>
void FindObjects(const GeometryOf<Real>& geometry, const std::uint32_t* primitive,
                 std::uint32_t count, std::uint32_t* object) {
  std::uint32_t begin = 0, end = 0, current = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t id = primitive[i];
    if (id != kNoPrimitive && !(id >= begin && id < end)) {
      current = geometry.object_of(id);
      begin = geometry.first_primitive(current);
      end = geometry.first_primitive(current + 1);
    }
    object[i] = id == kNoPrimitive ? kNoPrimitive : current;
  }
}

// Copies rays and hands them to `apart`, at most kBlock at a time. A function of its own, so that
// only who needs the copies has them on its stack.
template <typename Real, typename Apart>
[[gnu::noinline]] void ForEachCopy(const RayArraysOf<Real>& rays,
                                   const TraceIntervalOf<Real>& interval, std::size_t count,
                                   Real scale, const Apart& apart) {
  RayBlock<Real, kBlock> block;
  ForEachBatch(count, kBlock, [&](std::size_t first, std::uint32_t n) {
    block.Take(rays, interval, first, n, scale);
    apart(block.view(), block.intervals(), first, n);
  });
}

// Hands rays to `in_place` or to `apart`, as f(rays, intervals, first, count): at most `step` at a
// time in place, whole vectors of them; at most kBlock that were copied, for which only `count`
// results may be written in place.
template <typename Real, typename InPlace, typename Apart>
void ForEachPart(const RayArraysOf<Real>& rays, const TraceIntervalOf<Real>& interval,
                 std::size_t count, Real scale, std::size_t step, const InPlace& in_place,
                 const Apart& apart) {
  if (rays.stride != 0 || interval.stride != 0 || scale != 1) {
    return ForEachCopy(rays, interval, count, scale, apart);
  }
  const RayView<Real> view = ViewOf(rays);
  const RayIntervals<Real> intervals = IntervalsOf(interval);
  const std::size_t whole = count / kMaxLanes * kMaxLanes;
  ForEachBatch(whole, step, [&](std::size_t first, std::uint32_t n) {
    in_place(Skip(view, first), Skip(intervals, first), first, n);
  });
  if (whole == count) return;
  const auto rest = static_cast<std::uint32_t>(count - whole);
  RayBlock<Real, kMaxLanes> block;
  block.Take(rays, interval, whole, rest, scale);
  apart(block.view(), block.intervals(), whole, rest);
}

// Nearest hits of parts of a batch.
template <typename Real>
class ClosestTracer {
 public:
  using View = const RayView<Real>&;
  using Intervals = const RayIntervals<Real>&;

  ClosestTracer(const GeometryOf<Real>& geometry, const HitArraysOf<Real>& hits,
                const TraceOptionsOf<Real>& options)
      : geometry_(geometry),
        hits_(hits),
        kernel_(KernelsOf<Real>(options.target).closest),
        coherence_(CoherenceOf(options.coherence)) {}

  // Writes what is wanted where it is wanted, and what is not aside.
  void InPlace(View rays, Intervals intervals, std::size_t first, std::uint32_t n) {
    const auto at = [&](auto* array, auto* aside) { return array ? array + first : aside; };
    const HitOutput<Real> output = {at(hits_.t, t_), at(hits_.u, u_), at(hits_.v, v_),
                                    at(hits_.primitive, primitive_)};
    kernel_(GeometryAccess::TreeOf(geometry_), rays, intervals, n, coherence_, output);
    if (hits_.object) FindObjects(geometry_, output.primitive, n, hits_.object + first);
  }

  // Writes aside, then copies what is wanted. At most kBlock rays.
  void Apart(View rays, Intervals intervals, std::size_t first, std::uint32_t n) {
    kernel_(GeometryAccess::TreeOf(geometry_), rays, intervals, n, coherence_,
            {t_, u_, v_, primitive_});
    Scatter(t_, n, hits_.t, hits_.stride, first);
    Scatter(u_, n, hits_.u, hits_.stride, first);
    Scatter(v_, n, hits_.v, hits_.stride, first);
    Scatter(primitive_, n, hits_.primitive, hits_.stride, first);
    if (!hits_.object) return;
    FindObjects(geometry_, primitive_, n, object_);
    Scatter(object_, n, hits_.object, hits_.stride, first);
  }

 private:
  const GeometryOf<Real>& geometry_;
  const HitArraysOf<Real>& hits_;
  TraceClosestKernel<Real>* kernel_;
  Coherence coherence_;
  Real t_[kChunk], u_[kChunk], v_[kChunk];
  std::uint32_t primitive_[kChunk], object_[kBlock];
};

}  // namespace

RayArrays ArraysOf(const RayView<float>& rays) {
  return {rays.origin_x,    rays.origin_y,    rays.origin_z, rays.direction_x,
          rays.direction_y, rays.direction_z, rays.source};
}

TraceInterval IntervalOf(const RayIntervals<float>& intervals) {
  return {intervals.t_min, intervals.t_max, intervals.all_t_min, intervals.all_t_max};
}

template <typename Real>
Status TraceClosest(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                    std::size_t count, const HitArraysOf<Real>& hits,
                    const TraceOptionsOf<Real>& options) {
  if (Status checked = CheckRays(rays, count); !checked) return checked;
  ClosestTracer<Real> tracer(geometry, hits, options);
  const auto apart = [&](auto&&... part) { tracer.Apart(part...); };
  const auto in_place = [&](auto&&... part) {
    hits.stride == 0 ? tracer.InPlace(part...) : tracer.Apart(part...);
  };
  const bool has_all = hits.t && hits.u && hits.v && hits.primitive;
  const std::size_t step = hits.stride != 0 ? kBlock : has_all ? kMaxBatch : kChunk;
  ForEachPart(rays, options.interval, count, GeometryAccess::ScaleOf(geometry), step, in_place,
              apart);
  return Done{};
}

template <typename Real>
Status TraceOccluded(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                     std::size_t count, std::uint32_t* occluded,
                     const TraceOptionsOf<Real>& options) {
  if (Status checked = CheckRays(rays, count); !checked) return checked;
  if (count > 0 && !occluded) return NullArray("occluded");
  TraceOccludedKernel<Real>* const kernel = KernelsOf<Real>(options.target).occluded;
  const TreeView<Real>& tree = GeometryAccess::TreeOf(geometry);
  const Coherence coherence = CoherenceOf(options.coherence);
  ForEachPart(
      rays, options.interval, count, GeometryAccess::ScaleOf(geometry), kMaxBatch,
      [&](const auto& part, const auto& intervals, std::size_t first, std::uint32_t n) {
        kernel(tree, part, intervals, n, coherence, occluded + first);
      },
      [&](const auto& part, const auto& intervals, std::size_t first, std::uint32_t n) {
        std::uint32_t lanes[kBlock];
        kernel(tree, part, intervals, n, coherence, lanes);
        std::copy(lanes, lanes + n, occluded + first);
      });
  return Done{};
}

template Status TraceClosest(const GeometryOf<float>&, const RayArraysOf<float>&, std::size_t,
                             const HitArraysOf<float>&, const TraceOptionsOf<float>&);
template Status TraceClosest(const GeometryOf<double>&, const RayArraysOf<double>&, std::size_t,
                             const HitArraysOf<double>&, const TraceOptionsOf<double>&);
template Status TraceOccluded(const GeometryOf<float>&, const RayArraysOf<float>&, std::size_t,
                              std::uint32_t*, const TraceOptionsOf<float>&);
template Status TraceOccluded(const GeometryOf<double>&, const RayArraysOf<double>&, std::size_t,
                              std::uint32_t*, const TraceOptionsOf<double>&);

}  // namespace sheaf
