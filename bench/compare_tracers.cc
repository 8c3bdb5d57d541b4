#include "bench/compare_tracers.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>

#include "bench/interleave.h"
#include "sheaf/target.h"
#include "simd/query.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/core/aligned_array.h"
#include "src/core/running_target.h"
#include "src/scalar/trace_tree.h"

namespace sheaf::bench {
namespace {

constexpr double kSameT = 1e-4;  // relative

Query QueryOf(RayKind kind) {
  return kind == RayKind::kShadow ? Query::kOccluded : Query::kClosest;
}

RayCoherence CoherenceOf(RayKind kind) {
  switch (kind) {
    case RayKind::kPrimary:
    case RayKind::kShadow:
      return RayCoherence::kCommonOrigin;
    case RayKind::kMirror:
      return RayCoherence::kUnknown;
    case RayKind::kDiffuse:
      return RayCoherence::kIncoherent;
  }
  return RayCoherence::kUnknown;
}

// What a tracer answers. Of shadow rays, `primitive` is 0 where something was hit. In memory of the
// same kind as Embree's rays.
struct Answers {
  std::uint32_t count;
  AlignedArray<float> t, u, v;
  AlignedArray<std::uint32_t> primitive;

  explicit Answers(std::uint32_t n) : count(n) {
    for (auto* array : {&t, &u, &v}) array->Allocate(n);
    primitive.Allocate(n);
    std::fill_n(primitive.data(), n, kNoPrimitive);
  }
};

void TraceSheaf(const Geometry& geometry, const RayBatch& batch, Query query,
                const TraceOptions& options, Answers& answers) {
  if (query == Query::kClosest) {
    TraceClosest(geometry, ArraysOf(batch.view()), batch.count,
                 {.t = answers.t.data(),
                  .primitive = answers.primitive.data(),
                  .u = answers.u.data(),
                  .v = answers.v.data()},
                 options)
        .value();
  } else {
    TraceOccluded(geometry, ArraysOf(batch.view()), batch.count, answers.primitive.data(), options)
        .value();
  }
}

// Makes the 1 and 0 of TraceOccluded what Answers says.
void NumberOccluded(Query query, Answers& answers) {
  if (query == Query::kClosest) return;
  for (std::uint32_t i = 0; i < answers.count; ++i) {
    answers.primitive[i] = answers.primitive[i] ? 0 : kNoPrimitive;
  }
}

void TraceScalar(const TreeView<float>& tree, const RayBatch& batch, Query query,
                 Answers& answers) {
  const RayView<float> rays = batch.view();
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    scalar::Ray<float> ray;
    ray.origin = {rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]};
    ray.direction = {rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]};
    ray.t_min = batch.intervals.all_t_min;
    ray.t_max = batch.intervals.all_t_max;
    if (query == Query::kClosest) {
      const scalar::Hit<float> hit = scalar::TraceClosest(tree, ray);
      answers.t[i] = hit.t;
      answers.u[i] = hit.u;
      answers.v[i] = hit.v;
      answers.primitive[i] = hit.primitive;
    } else {
      answers.primitive[i] = scalar::TraceOccluded(tree, ray) ? 0 : kNoPrimitive;
    }
  }
}

Answers AnswersOf(const EmbreeRays& rays, std::uint32_t count, Query query,
                  const BenchScene& scene) {
  Answers answers(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    if (query == Query::kClosest) {
      answers.t[i] = rays.t(i);
      answers.primitive[i] = rays.Primitive(i, scene);
    } else {
      answers.primitive[i] = rays.IsOccluded(i) ? 0 : kNoPrimitive;
    }
  }
  return answers;
}

Differences Compare(const Answers& sheaf, const Answers& embree, Query query) {
  Differences differences;
  for (std::uint32_t i = 0; i < sheaf.count; ++i) {
    const std::uint32_t ours = sheaf.primitive[i], theirs = embree.primitive[i];
    if (ours == kNoPrimitive || theirs == kNoPrimitive) {
      if (theirs != ours)
        ++(theirs == kNoPrimitive ? differences.embree_missed : differences.sheaf_missed);
    } else if (query == Query::kClosest) {
      if (std::abs(sheaf.t[i] - embree.t[i]) > kSameT * std::abs(sheaf.t[i])) {
        ++differences.other_t;
      } else if (ours != theirs) {
        ++differences.other_tie;
      }
    }
  }
  return differences;
}

std::uint32_t CountScalarDifferences(const Answers& sheaf, const Answers& scalar, Query query) {
  auto differ = [](float a, float b) {
    return std::bit_cast<std::uint32_t>(a) != std::bit_cast<std::uint32_t>(b);
  };
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < sheaf.count; ++i) {
    count += sheaf.primitive[i] != scalar.primitive[i] ||
             (query == Query::kClosest &&
              (differ(sheaf.t[i], scalar.t[i]) || differ(sheaf.u[i], scalar.u[i]) ||
               differ(sheaf.v[i], scalar.v[i])));
  }
  return count;
}

Target TargetOrExit(const std::string& target) {
  const std::optional<Target> named = Target::Named(target);
  if (named && RunningTarget(*named) == target) return *named;
  fmt::print(stderr, "embree_bench: the target {} is not usable\n", target);
  std::exit(EXIT_FAILURE);
}

// One way to hand rays to Embree.
struct EmbreeMethod {
  EmbreeCall call;
  RTCIntersectContextFlags flags;
  const EmbreeScene* scene;
  const char* quality;

  std::string name() const {
    return fmt::format("{} {}{}", NameOf(call),
                       flags == RTC_INTERSECT_CONTEXT_FLAG_COHERENT ? "coherent " : "", quality);
  }
};

// Embree's two trees of a scene, and its rays of one batch in each layout.
class EmbreeSide {
 public:
  EmbreeSide(const BenchScene& scene, const std::string& isa)
      : device_(1, isa),
        medium_(device_, scene, RTC_BUILD_QUALITY_MEDIUM),
        high_(device_, scene, RTC_BUILD_QUALITY_HIGH) {
    medium_.Commit();
    high_.Commit();
  }

  void SetRays(const RayBatch& batch, RayKind kind) {
    rays_.clear();
    for (const EmbreeCall call : kEmbreeCalls) {
      auto& rays = rays_[WidthOf(call)];
      if (!rays) rays = std::make_unique<EmbreeRays>(batch, QueryOf(kind), WidthOf(call));
    }
  }

  EmbreeRays& RaysOf(const EmbreeMethod& method) { return *rays_.at(WidthOf(method.call)); }

  // The two fastest ways to trace the rays, the fastest first, each tried twice.
  std::array<EmbreeMethod, 2> FindBest(RayKind kind) {
    std::vector<std::pair<double, EmbreeMethod>> tried;
    const auto try_method = [&](const EmbreeMethod& method) {
      double best = HUGE_VAL;
      for (int attempt = 0; attempt < 2; ++attempt) {
        RaysOf(method).Reset();
        best = std::min(best, SecondsOf([&] { Trace(method); }));
      }
      tried.emplace_back(best, method);
    };
    const FlushDenormals flush;
    for (const EmbreeCall call : kEmbreeCalls) {
      for (const auto& [scene, quality] : {std::pair(&medium_, "medium"), {&high_, "high"}}) {
        try_method({call, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT, scene, quality});
        if (kind == RayKind::kDiffuse) continue;
        try_method({call, RTC_INTERSECT_CONTEXT_FLAG_COHERENT, scene, quality});
      }
    }
    std::partial_sort(tried.begin(), tried.begin() + 2, tried.end(),
                      [](const auto& a, const auto& b) { return a.first < b.first; });
    return {tried[0].second, tried[1].second};
  }

  void Trace(const EmbreeMethod& method) {
    RaysOf(method).Trace(method.scene->get(), method.call, method.flags);
  }

 private:
  EmbreeDevice device_;
  EmbreeScene medium_, high_;
  std::map<std::uint32_t, std::unique_ptr<EmbreeRays>> rays_;  // by width
};

Comparison CompareKind(const BenchScene& scene, const Geometry& geometry, EmbreeSide& embree,
                       const RayBatch& batch, RayKind kind, const CompareOptions& options) {
  const Query query = QueryOf(kind);
  embree.SetRays(batch, kind);
  std::array<EmbreeMethod, 2> methods = embree.FindBest(kind);

  TraceOptions trace_options;
  trace_options.interval = IntervalOf(batch.intervals);
  if (options.hints == Hints::kGiven) trace_options.coherence = CoherenceOf(kind);
  std::vector<Answers> answers;
  for (std::size_t i = 0; i < options.targets.size(); ++i) answers.emplace_back(batch.count);
  Answers scalar_answers(batch.count);

  std::vector<Contestant> contestants;
  std::optional<FlushDenormals> flush;  // while Embree runs
  for (const EmbreeMethod& method : methods) {
    contestants.push_back({[&] {
                             embree.RaysOf(method).Reset();
                             flush.emplace();
                           },
                           [&] { embree.Trace(method); }});
  }
  for (std::size_t i = 0; i < options.targets.size(); ++i) {
    TraceOptions on_target = trace_options;
    on_target.target = TargetOrExit(options.targets[i]);
    contestants.push_back(
        {[&] { flush.reset(); },
         [&, i, on_target] { TraceSheaf(geometry, batch, query, on_target, answers[i]); }});
  }
  contestants.push_back(
      {[&] { flush.reset(); },
       [&] { TraceScalar(GeometryAccess::TreeOf(geometry), batch, query, scalar_answers); }});
  const auto seconds = Interleave(contestants, options.repetitions);
  flush.reset();

  const std::size_t winner = Median(seconds[0]) <= Median(seconds[1]) ? 0 : 1;
  // The winner's rays may have been traced last by the other method, with the same width.
  embree.RaysOf(methods[winner]).Reset();
  embree.Trace(methods[winner]);
  const Answers embree_answers =
      AnswersOf(embree.RaysOf(methods[winner]), batch.count, query, scene);

  const std::vector<double>& scalar_seconds = seconds.back();
  const double million_rays = batch.count * 1e-6;
  Comparison comparison{scene.name,
                        scene.primitive_count(),
                        kind,
                        batch.count,
                        methods[winner].name(),
                        million_rays / Median(seconds[winner]),
                        million_rays / Median(scalar_seconds),
                        {}};
  for (std::size_t i = 0; i < options.targets.size(); ++i) {
    const std::vector<double>& ours = seconds[methods.size() + i];
    NumberOccluded(query, answers[i]);
    comparison.targets.push_back(
        {options.targets[i], million_rays / Median(ours), MedianRatio(seconds[winner], ours),
         MedianRatio(scalar_seconds, ours), Compare(answers[i], embree_answers, query),
         CountScalarDifferences(answers[i], scalar_answers, query)});
  }
  return comparison;
}

}  // namespace

void CompareTracers(const BenchScene& scene, const CompareOptions& options,
                    const std::function<void(const Comparison&)>& report) {
  GeometryInput input;
  if (scene.triangle_count() > 0) input.AddTriangles(scene.vertices, scene.indices);
  if (scene.sphere_count() > 0) input.AddSpheres(scene.spheres);
  const Result<Geometry> geometry = Geometry::Build(input);
  if (!geometry) {
    fmt::print(stderr, "embree_bench: {}: {}\n", scene.name, geometry.error().message);
    std::exit(EXIT_FAILURE);
  }
  EmbreeSide embree(scene, options.embree_isa);

  const RayBatch primary = PrimaryRays(scene, options.picture_size);
  Answers hits(primary.count);
  TraceSheaf(geometry.value(), primary, Query::kClosest, {}, hits);
  for (const RayKind kind : options.kinds) {
    if (kind == RayKind::kPrimary) {
      report(CompareKind(scene, geometry.value(), embree, primary, kind, options));
      continue;
    }
    const RayBatch batch = SecondaryRays(scene, kind, primary, {hits.t.data(), hits.count},
                                         {hits.primitive.data(), hits.count});
    if (batch.count == 0) continue;
    report(CompareKind(scene, geometry.value(), embree, batch, kind, options));
  }
}

}  // namespace sheaf::bench
