// All hits of rays, and the nearest hit by rules and filters, for the library's users.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sheaf/queries.h"
#include "src/bvh/check_arrays.h"
#include "src/bvh/list_hits.h"
#include "src/bvh/ray_batches.h"

namespace sheaf {
namespace {

// A filter is asked about so many hits of a ray at a time.
constexpr std::uint32_t kCandidates = 4;
// Lists of any length grow by so many hits at a time.
constexpr std::uint32_t kRunStep = 32;

// Writes elements of arrays that have a stride, one by one.
template <typename Real>
class HitWriter {
 public:
  HitWriter(const GeometryOf<Real>& geometry, const HitArraysOf<Real>& hits)
      : geometry_(geometry), hits_(hits) {}

  void Write(std::size_t i, const ListedHit<Real>& hit) {
    Put(hits_.t, i, hit.t);
    Put(hits_.primitive, i, hit.primitive);
    Put(hits_.u, i, hit.u);
    Put(hits_.v, i, hit.v);
    if (!hits_.object) return;
    const bool is_hit = hit.primitive != kNoPrimitive;
    Put(hits_.object, i, is_hit ? geometry_.object_of(hit.primitive) : kNoPrimitive);
  }

 private:
  template <typename T>
  void Put(T* array, std::size_t i, T value) {
    Scatter(&value, 1, array, hits_.stride, i);
  }

  const GeometryOf<Real>& geometry_;
  const HitArraysOf<Real>& hits_;
};

// The filter's answers for the lists of a block.
template <typename Real>
class Candidates {
 public:
  Candidates(const GeometryOf<Real>& geometry, const HitFilterOf<Real>& filter)
      : geometry_(geometry), filter_(filter) {}

  // Calls found(i, hit) with the first accepted hit of each list.
  template <typename Found>
  void Ask(const HitLister<Real>& lister, std::size_t first, std::uint32_t count, Found found) {
    rays_.clear();
    for (auto* numbers : {&t_, &u_, &v_}) numbers->clear();
    primitives_.clear();
    objects_.clear();
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t k = 0; k < lister.listed[i]; ++k) Add(first + i, lister.list(i)[k]);
    }
    accepted_.assign(rays_.size(), 0);
    if (rays_.empty()) return;
    filter_({rays_.size(), rays_.data(), t_.data(), u_.data(), v_.data(), primitives_.data(),
             objects_.data()},
            accepted_.data());
    std::size_t at = 0;
    for (std::uint32_t i = 0; i < count; at += lister.listed[i++]) {
      for (std::uint32_t k = 0; k < lister.listed[i]; ++k) {
        if (accepted_[at + k] == 0) continue;
        found(i, lister.list(i)[k]);
        break;
      }
    }
  }

 private:
  void Add(std::size_t ray, const ListedHit<Real>& hit) {
    rays_.push_back(ray);
    t_.push_back(hit.t);
    u_.push_back(hit.u);
    v_.push_back(hit.v);
    primitives_.push_back(hit.primitive);
    objects_.push_back(geometry_.object_of(hit.primitive));
  }

  const GeometryOf<Real>& geometry_;
  const HitFilterOf<Real>& filter_;
  std::vector<std::size_t> rays_;
  std::vector<Real> t_, u_, v_;
  std::vector<std::uint32_t> primitives_, objects_;
  std::vector<std::uint8_t> accepted_;
};

// Adds the hits of the next ray.
template <typename Real>
void Append(const GeometryOf<Real>& geometry, const std::vector<ListedHit<Real>>& hits,
            HitRunsOf<Real>* runs) {
  for (const ListedHit<Real>& hit : hits) {
    runs->t.push_back(hit.t);
    runs->u.push_back(hit.u);
    runs->v.push_back(hit.v);
    runs->primitive.push_back(hit.primitive);
    runs->object.push_back(geometry.object_of(hit.primitive));
  }
  runs->first.push_back(runs->t.size());
}

// Calls put(ray, hit) for the first hit of each ray that rules and filter let pass, and miss(ray,
// t_max) for the others. By rules alone, `order` says whether any hit will do.
template <typename Real, typename Put, typename Miss>
void ForEachFirst(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                  std::size_t count, const RuledTraceOptionsOf<Real>& options,
                  const HitFilterOf<Real>& filter, ListOrder order, Put put, Miss miss) {
  HitLister<Real> lister(geometry, rays, options, filter ? kCandidates : 1);
  if (!filter) lister.order = order;
  Candidates<Real> candidates(geometry, filter);
  ForEachBatch(count, kListBlock, [&](std::size_t first, std::uint32_t n) {
    bool is_found[kListBlock] = {};
    lister.Take(first, n);
    const auto find = [&](std::uint32_t i, const ListedHit<Real>& hit) {
      is_found[i] = true;
      put(first + i, hit);
    };
    if (filter) {
      do {
        candidates.Ask(lister, first, n, find);
      } while (lister.Next([&](std::uint32_t i) { return !is_found[i]; }));
    } else {
      for (std::uint32_t i = 0; i < n; ++i) {
        if (lister.listed[i] > 0) find(i, lister.list(i)[0]);
      }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!is_found[i]) miss(first + i, lister.end(i));
    }
  });
}

}  // namespace

template <typename Real>
Status TraceAll(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays, std::size_t count,
                const AllHitsOf<Real>& lists, const RuledTraceOptionsOf<Real>& options) {
  if (Status checked = CheckRules(rays, count, options); !checked) return checked;
  HitLister<Real> lister(geometry, rays, options, lists.capacity);
  lister.counts = lists.total != nullptr;
  HitWriter<Real> writer(geometry, lists.hits);
  ForEachBatch(count, kListBlock, [&](std::size_t first, std::uint32_t n) {
    lister.Take(first, n);
    if (lists.listed) std::copy(lister.listed, lister.listed + n, lists.listed + first);
    if (lists.total) std::copy(lister.total, lister.total + n, lists.total + first);
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::size_t at = (first + i) * lists.capacity;
      const std::uint32_t n_listed = lister.listed[i];
      for (std::uint32_t k = 0; k < n_listed; ++k) writer.Write(at + k, lister.list(i)[k]);
      if (n_listed < lists.capacity) {
        writer.Write(at + n_listed, {lister.end(i), kNoPrimitive, 0, 0});
      }
    }
  });
  return Done{};
}

template <typename Real>
Result<HitRunsOf<Real>> ListAllHits(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                                    std::size_t count, const RuledTraceOptionsOf<Real>& options,
                                    std::uint32_t most) {
  if (Status checked = CheckRules(rays, count, options); !checked) return checked.error();
  HitRunsOf<Real> runs;
  runs.first.push_back(0);
  HitLister<Real> lister(geometry, rays, options, std::min(most, kRunStep));
  ForEachBatch(count, kListBlock, [&](std::size_t first, std::uint32_t n) {
    std::vector<ListedHit<Real>> hits[kListBlock];
    lister.Take(first, n);
    do {
      for (std::uint32_t i = 0; i < n; ++i) {
        const std::size_t room = most - hits[i].size();
        const ListedHit<Real>* const list = lister.list(i);
        hits[i].insert(hits[i].end(), list, list + std::min<std::size_t>(lister.listed[i], room));
      }
    } while (most > 0 && lister.Next([&](std::uint32_t i) { return hits[i].size() < most; }));
    for (std::uint32_t i = 0; i < n; ++i) Append(geometry, hits[i], &runs);
  });
  return runs;
}

template <typename Real>
Status TraceRuledClosest(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                         std::size_t count, const HitArraysOf<Real>& hits,
                         const RuledTraceOptionsOf<Real>& options,
                         const HitFilterOf<Real>& filter) {
  if (Status checked = CheckRules(rays, count, options); !checked) return checked;
  HitWriter<Real> writer(geometry, hits);
  ForEachFirst(
      geometry, rays, count, options, filter, ListOrder::kNearest,
      [&](std::size_t i, const ListedHit<Real>& hit) { writer.Write(i, hit); },
      [&](std::size_t i, Real end) {
        writer.Write(i, {end, kNoPrimitive, 0, 0});
      });
  return Done{};
}

template <typename Real>
Status TraceRuledOccluded(const GeometryOf<Real>& geometry, const RayArraysOf<Real>& rays,
                          std::size_t count, std::uint32_t* occluded,
                          const RuledTraceOptionsOf<Real>& options,
                          const HitFilterOf<Real>& filter) {
  if (Status checked = CheckRules(rays, count, options); !checked) return checked;
  if (count > 0 && !occluded) return NullArray("occluded");
  ForEachFirst(
      geometry, rays, count, options, filter, ListOrder::kAny,
      [&](std::size_t i, const ListedHit<Real>&) { occluded[i] = 1; },
      [&](std::size_t i, Real) { occluded[i] = 0; });
  return Done{};
}

#define SHEAF_INSTANTIATE(Real)                                                                   \
  template Status TraceAll(const GeometryOf<Real>&, const RayArraysOf<Real>&, std::size_t,        \
                           const AllHitsOf<Real>&, const RuledTraceOptionsOf<Real>&);             \
  template Result<HitRunsOf<Real>> ListAllHits(const GeometryOf<Real>&, const RayArraysOf<Real>&, \
                                               std::size_t, const RuledTraceOptionsOf<Real>&,     \
                                               std::uint32_t);                                    \
  template Status TraceRuledClosest(const GeometryOf<Real>&, const RayArraysOf<Real>&,            \
                                    std::size_t, const HitArraysOf<Real>&,                        \
                                    const RuledTraceOptionsOf<Real>&, const HitFilterOf<Real>&);  \
  template Status TraceRuledOccluded(const GeometryOf<Real>&, const RayArraysOf<Real>&,           \
                                     std::size_t, std::uint32_t*,                                 \
                                     const RuledTraceOptionsOf<Real>&, const HitFilterOf<Real>&)
SHEAF_INSTANTIATE(float);
SHEAF_INSTANTIATE(double);
#undef SHEAF_INSTANTIATE

}  // namespace sheaf
