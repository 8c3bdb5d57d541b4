// From arrays of any length to the kernels, which take whole vectors: all but the last few rays in
// place, the rest through a padded copy.
#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "sheaf/geometry.h"
#include "simd/kernels.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "src/bvh/geometry_access.h"
#include "src/bvh/ray_batches.h"
#include "src/scalar/trace_tree.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kChunk = 256;  // rays at a time where a result is not wanted

RayView<float> Skip(RayView<float> rays, std::size_t first) {
  ForEachField(rays, [&](auto& field) {
    if (field) field += first;
  });
  return rays;
}

RayIntervals<float> Skip(RayIntervals<float> intervals, std::size_t first) {
  if (intervals.t_min) intervals.t_min += first;
  if (intervals.t_max) intervals.t_max += first;
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

template <typename T>
T* Skip(T* array, std::size_t first) {
  return array ? array + first : nullptr;
}

// The rays of one vector, of which `count` are copied; the lanes beyond have no direction.
class PaddedRays {
 public:
  PaddedRays(const RayView<float>& rays, const RayIntervals<float>& intervals, std::uint32_t count)
      : view_{}, intervals_(intervals) {
    std::uint32_t slot = 0;
    ForEachField(view_, rays, [&](auto& to, const auto& from) {
      if (!from) return;
      auto* const lanes = Lanes(from, slot++);
      std::copy(from, from + count, lanes);
      to = lanes;
    });
    CopyInterval(count, t_min_, intervals_.t_min);
    CopyInterval(count, t_max_, intervals_.t_max);
  }

  const RayView<float>& view() const { return view_; }
  const RayIntervals<float>& intervals() const { return intervals_; }

 private:
  float* Lanes(const float*, std::uint32_t slot) { return numbers_[slot]; }
  std::uint32_t* Lanes(const std::uint32_t*, std::uint32_t) { return source_; }

  static void CopyInterval(std::uint32_t count, float* lanes, const float*& array) {
    if (!array) return;
    std::copy(array, array + count, lanes);
    array = lanes;
  }

  float numbers_[6][kMaxLanes] = {};
  std::uint32_t source_[kMaxLanes] = {};
  float t_min_[kMaxLanes] = {}, t_max_[kMaxLanes] = {};
  RayView<float> view_;
  RayIntervals<float> intervals_;
};

scalar::Ray<float> RayAt(const RayView<float>& rays, const RayIntervals<float>& intervals,
                         std::uint32_t i) {
  return {{rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]},
          {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]},
          rays.source ? rays.source[i] : kNoPrimitive,
          intervals.t_min ? intervals.t_min[i] : intervals.all_t_min,
          intervals.t_max ? intervals.t_max[i] : intervals.all_t_max};
}

// The baseline, as the kernels are called.
void ScalarClosest(const TreeView<float>& tree, const RayView<float>& rays,
                   const RayIntervals<float>& intervals, std::uint32_t count,
                   Coherence /*coherence*/, const HitOutput<float>& hits) {
  for (std::uint32_t i = 0; i < count; ++i) {
    const scalar::Hit<float> hit = scalar::TraceClosest(tree, RayAt(rays, intervals, i));
    hits.t[i] = hit.t;
    hits.u[i] = hit.u;
    hits.v[i] = hit.v;
    hits.primitive[i] = hit.primitive;
  }
}

void ScalarOccluded(const TreeView<float>& tree, const RayView<float>& rays,
                    const RayIntervals<float>& intervals, std::uint32_t count,
                    Coherence /*coherence*/, std::uint32_t* occluded) {
  for (std::uint32_t i = 0; i < count; ++i) {
    occluded[i] = scalar::TraceOccluded(tree, RayAt(rays, intervals, i)) ? 1 : 0;
  }
}

struct TraceKernels {
  TraceClosestKernel<float>* closest;
  TraceOccludedKernel<float>* occluded;
};

TraceKernels KernelsOf(Target target) {
  if (target.is_scalar()) return {&ScalarClosest, &ScalarOccluded};
  // Looked up once: a batch may be one ray.
  static const Kernels<float> best = StrictKernels<float>(0);
  if (target == Target()) return {best.trace_closest, best.trace_occluded};
  const Kernels<float> kernels = StrictKernels<float>(target.id());
  return {kernels.trace_closest, kernels.trace_occluded};
}

struct HitScratch {
  float t[kChunk], u[kChunk], v[kChunk];
  std::uint32_t primitive[kChunk];
};

// Writes the objects of `count` primitives; neighbours tend to share one.
void FindObjects(const Geometry& geometry, const std::uint32_t* primitive, std::uint32_t count,
                 std::uint32_t* object) {
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

// At most kChunk rays, and whole vectors of them.
void TraceChunk(const Geometry& geometry, const RayView<float>& rays,
                const RayIntervals<float>& intervals, Coherence coherence, std::uint32_t count,
                const HitArrays& hits, const TraceKernels& kernels, HitScratch& scratch) {
  const HitOutput<float> output = {hits.t ? hits.t : scratch.t, hits.u ? hits.u : scratch.u,
                                   hits.v ? hits.v : scratch.v,
                                   hits.primitive ? hits.primitive : scratch.primitive};
  kernels.closest(GeometryAccess::TreeOf(geometry), rays, intervals, count, coherence, output);
  if (hits.object) FindObjects(geometry, output.primitive, count, hits.object);
}

Error NullArray(const char* name) { return {ErrorKind::kUsage, std::string(name) + " is null"}; }

// Names the array that is missing.
Status CheckRays(const RayArrays& rays, std::size_t count) {
  if (count == 0) return Done{};
  const std::pair<const char*, const float*> arrays[] = {
      {"origin_x", rays.origin_x},       {"origin_y", rays.origin_y},
      {"origin_z", rays.origin_z},       {"direction_x", rays.direction_x},
      {"direction_y", rays.direction_y}, {"direction_z", rays.direction_z}};
  for (const auto& [name, array] : arrays) {
    if (!array) return NullArray(name);
  }
  return Done{};
}

}  // namespace

RayView<float> ViewOf(const RayArrays& rays) {
  return {rays.origin_x,    rays.origin_y,    rays.origin_z, rays.direction_x,
          rays.direction_y, rays.direction_z, rays.source};
}

RayArrays ArraysOf(const RayView<float>& rays) {
  return {rays.origin_x,    rays.origin_y,    rays.origin_z, rays.direction_x,
          rays.direction_y, rays.direction_z, rays.source};
}

RayIntervals<float> IntervalsOf(const TraceInterval& interval) {
  return {interval.t_min, interval.t_max, interval.all_t_min, interval.all_t_max};
}

TraceInterval IntervalOf(const RayIntervals<float>& intervals) {
  return {intervals.t_min, intervals.t_max, intervals.all_t_min, intervals.all_t_max};
}

Status TraceClosest(const Geometry& geometry, const RayArrays& given, std::size_t count,
                    const HitArrays& hits, const TraceOptions& options) {
  if (Status checked = CheckRays(given, count); !checked) return checked;
  HitScratch scratch;
  const TraceKernels kernels = KernelsOf(options.target);
  const RayView<float> rays = ViewOf(given);
  const RayIntervals<float> intervals = IntervalsOf(options.interval);
  const Coherence coherence = CoherenceOf(options.coherence);
  const bool has_all = hits.t && hits.u && hits.v && hits.primitive;
  const std::size_t whole = count / kMaxLanes * kMaxLanes;
  ForEachBatch(whole, has_all ? kMaxBatch : kChunk, [&](std::size_t first, std::uint32_t n) {
    const HitArrays part = {Skip(hits.t, first), Skip(hits.primitive, first),
                            Skip(hits.object, first), Skip(hits.u, first), Skip(hits.v, first)};
    TraceChunk(geometry, Skip(rays, first), Skip(intervals, first), coherence, n, part, kernels,
               scratch);
  });
  const auto rest = static_cast<std::uint32_t>(count - whole);
  if (rest == 0) return Done{};
  const PaddedRays padded(Skip(rays, whole), Skip(intervals, whole), rest);
  std::uint32_t object[kMaxLanes];
  TraceChunk(geometry, padded.view(), padded.intervals(), coherence, rest,
             {.object = hits.object ? object : nullptr}, kernels, scratch);
  const auto copy = [&](const auto* from, auto* to) {
    if (to) std::copy(from, from + rest, to + whole);
  };
  copy(scratch.t, hits.t);
  copy(scratch.u, hits.u);
  copy(scratch.v, hits.v);
  copy(scratch.primitive, hits.primitive);
  copy(object, hits.object);
  return Done{};
}

Status TraceOccluded(const Geometry& geometry, const RayArrays& given, std::size_t count,
                     std::uint32_t* occluded, const TraceOptions& options) {
  if (Status checked = CheckRays(given, count); !checked) return checked;
  if (count > 0 && !occluded) return NullArray("occluded");
  const TraceKernels kernels = KernelsOf(options.target);
  const TreeView<float>& tree = GeometryAccess::TreeOf(geometry);
  const RayView<float> rays = ViewOf(given);
  const RayIntervals<float> intervals = IntervalsOf(options.interval);
  const Coherence coherence = CoherenceOf(options.coherence);
  const std::size_t whole = count / kMaxLanes * kMaxLanes;
  ForEachBatch(whole, kMaxBatch, [&](std::size_t first, std::uint32_t n) {
    kernels.occluded(tree, Skip(rays, first), Skip(intervals, first), n, coherence,
                     occluded + first);
  });
  const auto rest = static_cast<std::uint32_t>(count - whole);
  if (rest == 0) return Done{};
  const PaddedRays padded(Skip(rays, whole), Skip(intervals, whole), rest);
  std::uint32_t lanes[kMaxLanes];
  kernels.occluded(tree, padded.view(), padded.intervals(), rest, coherence, lanes);
  std::copy(lanes, lanes + rest, occluded + whole);
  return Done{};
}

}  // namespace sheaf
