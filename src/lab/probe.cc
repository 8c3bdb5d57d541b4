#include "src/lab/probe.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "simd/query.h"
#include "simd/tree.h"
#include "src/core/running_target.h"
#include "src/scalar/trace_tree.h"

namespace sheaf::stress {
namespace {

// Rays as the arrays that the kernels take.
struct FlatRays {
  std::vector<float> number[6], t_min, t_max;
  std::vector<std::uint32_t> source;

  explicit FlatRays(const std::vector<Ray>& rays) {
    for (const Ray& ray : rays) {
      const float numbers[6] = {ray.origin.x,    ray.origin.y,    ray.origin.z,
                                ray.direction.x, ray.direction.y, ray.direction.z};
      for (int i = 0; i < 6; ++i) number[i].push_back(numbers[i]);
      t_min.push_back(ray.t_min);
      t_max.push_back(ray.t_max);
      source.push_back(ray.source);
    }
  }
  RayArrays view() const {
    return {number[0].data(), number[1].data(), number[2].data(), number[3].data(),
            number[4].data(), number[5].data(), source.data()};
  }
};

bool SameBits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b) || (a != a && b != b);
}

bool SameHit(const Hit& a, const Hit& b) {
  return a.primitive == b.primitive && SameBits(a.t, b.t) && SameBits(a.u, b.u) &&
         SameBits(a.v, b.v);
}

std::string HitText(const Hit& hit) {
  if (!IsHit(hit)) return fmt::format("a miss, t {:a}", hit.t);
  return fmt::format("primitive {}, t {:a}, u {:a}, v {:a}", hit.primitive, hit.t, hit.u, hit.v);
}

// The kernels of the target in force against `expected`.
void CheckKernels(Report& report, Target target, const Geometry& geometry,
                  const std::vector<Ray>& rays, const FlatRays& flat,
                  const std::vector<Hit>& expected) {
  const auto count = static_cast<std::uint32_t>(rays.size());
  std::vector<float> t(count), u(count), v(count);
  std::vector<std::uint32_t> primitive(count), occluded(count);
  TraceOptions options;
  options.target = target;
  options.interval.t_min = flat.t_min.data();
  options.interval.t_max = flat.t_max.data();
  TraceClosest(geometry, flat.view(), count,
               {.t = t.data(), .primitive = primitive.data(), .u = u.data(), .v = v.data()},
               options)
      .value();
  TraceOccluded(geometry, flat.view(), count, occluded.data(), options).value();
  for (std::uint32_t i = 0; i < count; ++i) {
    const Hit found{t[i], primitive[i], u[i], v[i]};
    if (!SameHit(found, expected[i])) {
      report.Expect(false,
                    fmt::format("{} finds {} and src/scalar {}", target.name(), HitText(found),
                                HitText(expected[i])),
                    &rays[i]);
    }
    if ((occluded[i] != 0) != IsHit(expected[i])) {
      report.Expect(false,
                    fmt::format("{}: occlusion is not that of the nearest hit", target.name()),
                    &rays[i]);
    }
  }
}

}  // namespace

std::uint32_t Shapes::AddVertex(Vec position) {
  vertices.insert(vertices.end(), {position.x, position.y, position.z});
  return vertex_count() - 1;
}

void Shapes::AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  indices.insert(indices.end(), {a, b, c});
}

void Shapes::AddTriangle(Vec a, Vec b, Vec c) {
  const std::uint32_t first = AddVertex(a);
  AddVertex(b);
  AddVertex(c);
  AddTriangle(first, first + 1, first + 2);
}

void Shapes::AddQuad(Vec a, Vec b, Vec c, Vec d) {
  const std::uint32_t first = AddVertex(a);
  AddVertex(b);
  AddVertex(c);
  AddVertex(d);
  AddTriangle(first, first + 1, first + 2);
  AddTriangle(first, first + 2, first + 3);
}

void Shapes::AddSphere(Vec center, float radius) {
  spheres.insert(spheres.end(), {center.x, center.y, center.z, radius});
}

void Shapes::AddMore(PrimitiveKind kind, std::initializer_list<float> fields) {
  more[IndexOf(kind)].insert(more[IndexOf(kind)].end(), fields);
}

std::uint32_t Shapes::primitive_count() const {
  std::size_t count = indices.size() / 3 + spheres.size() / 4;
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    count += more[k].size() / FieldCountOf(static_cast<PrimitiveKind>(k));
  }
  return static_cast<std::uint32_t>(count);
}

Vec Shapes::vertex(std::uint32_t i) const {
  return {vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]};
}

void AddSphereMesh(Shapes& shapes, Vec center, float radius, std::uint32_t rings) {
  const std::uint32_t around = 2 * rings;
  const double pi = std::numbers::pi;
  const auto point = [&](double theta, double phi) {
    const Vec out = {static_cast<float>(std::sin(theta) * std::cos(phi)),
                     static_cast<float>(std::cos(theta)),
                     static_cast<float>(std::sin(theta) * std::sin(phi))};
    return center + out * radius;
  };
  const std::uint32_t north = shapes.AddVertex(point(0, 0));
  const std::uint32_t south = shapes.AddVertex(point(pi, 0));
  const std::uint32_t first = shapes.vertex_count();
  for (std::uint32_t ring = 1; ring < rings; ++ring) {
    for (std::uint32_t i = 0; i < around; ++i) {
      shapes.AddVertex(point(pi * ring / rings, 2 * pi * i / around));
    }
  }
  const auto at = [&](std::uint32_t ring, std::uint32_t i) {
    return first + (ring - 1) * around + i % around;
  };
  for (std::uint32_t i = 0; i < around; ++i) {
    shapes.AddTriangle(north, at(1, i + 1), at(1, i));
    shapes.AddTriangle(south, at(rings - 1, i), at(rings - 1, i + 1));
    for (std::uint32_t ring = 1; ring + 1 < rings; ++ring) {
      shapes.AddTriangle(at(ring, i), at(ring, i + 1), at(ring + 1, i + 1));
      shapes.AddTriangle(at(ring, i), at(ring + 1, i + 1), at(ring + 1, i));
    }
  }
}

GeometryInput InputOf(const Shapes& shapes) {
  GeometryInput input;
  input.AddTriangles(shapes.vertices, shapes.indices);
  input.AddSpheres(shapes.spheres);
  for (std::uint32_t k = 0; k < kKindCount; ++k) {
    if (shapes.more[k].empty()) continue;
    GeometryAccess::Add(input, static_cast<PrimitiveKind>(k), shapes.more[k]);
  }
  return input;
}

FlatShapes::FlatShapes(const Shapes& shapes)
    : flat_(std::move(GeometryAccess::Flatten(InputOf(shapes), 1)).value()) {}

bool IsHit(const Hit& hit) { return hit.primitive != kNoPrimitive; }

void ForEachTarget(Report& report, const std::function<void(Target target)>& body) {
  for (const std::string& name : UsableTargets()) {
    const std::optional<Target> target = Target::Named(name);
    report.Expect(target && RunningTarget(*target) == name, name + " does not run");
    if (target) body(*target);
  }
}

std::vector<Hit> TraceEverywhere(Report& report, const Shapes& shapes,
                                 const std::vector<Ray>& given, Oracle oracle) {
  std::vector<Ray> rays = given;
  if (report.replay()) rays.push_back(*report.replay());
  const Result<Geometry> geometry = Geometry::Build(InputOf(shapes));
  if (!geometry) {
    report.Expect(false, geometry.error().message);
    return std::vector<Hit>(given.size());
  }
  // At the geometry's own scale, as its tree is.
  FlatInput flat = std::move(GeometryAccess::Flatten(InputOf(shapes), 1)).value();
  const float scale = Rescale(flat);
  const FlatRays flat_rays(rays);
  std::vector<Hit> expected;
  for (const Ray& ray : rays) {
    Ray scaled = ray;
    scaled.origin = ray.origin * scale;
    scaled.direction = ray.direction * scale;
    const Hit by_tree = scalar::TraceClosest(GeometryAccess::TreeOf(geometry.value()), scaled);
    expected.push_back(
        oracle == Oracle::kTreeOnly ? by_tree : scalar::TraceClosest(flat.arrays.view(), scaled));
    report.Expect(SameHit(by_tree, expected.back()),
                  "the baseline's tree differs from every primitive", &ray);
  }
  ForEachTarget(report, [&](Target target) {
    CheckKernels(report, target, geometry.value(), rays, flat_rays, expected);
  });
  if (report.replay()) {
    report.Note(
        fmt::format("{} primitives: {}", shapes.primitive_count(), HitText(expected.back())));
    expected.pop_back();
  }
  return expected;
}

}  // namespace sheaf::stress
