// Rays against shapes at the edges of floating point.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include "simd/query.h"
#include "simd/shading.h"
#include "simd/tree.h"
#include "src/bvh/geometry.h"
#include "src/lab/probe.h"
#include "src/lab/stress.h"
#include "src/scalar/shadow_ray.h"
#include "src/scalar/spawn.h"
#include "src/scalar/surface.h"

namespace sheaf::stress {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Ray Towards(Vec origin, Vec target) { return {origin, target - origin}; }

// Uniform directions and points; the same on every machine, as long as no two of them are drawn in
// one expression whose order is the compiler's.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  // In [low, high).
  float In(float low, float high) {
    return low + (high - low) * static_cast<float>(engine_() >> 8) * 0x1p-24f;
  }
  Vec InBox(float reach) { return {In(-reach, reach), In(-reach, reach), In(-reach, reach)}; }
  Vec Direction() {
    for (;;) {
      const Vec v = InBox(1);
      const float square = Dot(v, v);
      if (square > 0.01f && square <= 1) return Normalize(v);
    }
  }

 private:
  std::mt19937 engine_;
};

// From `origin` to every vertex and the middle of every edge.
std::vector<Ray> AimAtEdges(const Shapes& shapes, Vec origin) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) {
    rays.push_back(Towards(origin, shapes.vertex(i)));
  }
  for (std::size_t i = 0; i < shapes.indices.size(); ++i) {
    const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
    const Vec a = shapes.vertex(shapes.indices[i]), b = shapes.vertex(shapes.indices[next]);
    rays.push_back(Towards(origin, a + (b - a) * 0.5f));
  }
  return rays;
}

void ExpectAllHit(Report& report, const Shapes& shapes, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    report.Expect(IsHit(hits[i]), "a miss where there is a surface", &rays[i]);
  }
}

void ExpectAllMiss(Report& report, const Shapes& shapes, const std::vector<Ray>& rays) {
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    report.Expect(!IsHit(hits[i]), "a hit where there is nothing", &rays[i]);
  }
}

// The primitive and t, in units in the last place, that one ray must find.
void ExpectHit(Report& report, const Shapes& shapes, const Ray& ray, std::uint32_t primitive,
               double t, double ulps) {
  const Hit hit = TraceEverywhere(report, shapes, {ray}).front();
  report.Expect(hit.primitive == primitive, fmt::format("not primitive {}", primitive), &ray);
  const float rounded = static_cast<float>(t);
  const double ulp = static_cast<double>(std::nextafter(std::abs(rounded), kInfinity)) -
                     std::abs(static_cast<double>(rounded));
  const double error = std::abs(static_cast<double>(hit.t) - t) / ulp;
  report.Expect(error <= ulps, fmt::format("t is {:.3g} ULP off, not up to {}", error, ulps), &ray);
}

Shapes UnitSphere() {
  Shapes shapes;
  shapes.AddSphere({0, 0, 0}, 1);
  return shapes;
}

void AddRandomTriangle(Random& random, Shapes& shapes, float size) {
  const Vec a = random.InBox(4);
  const Vec b = a + random.InBox(size);
  shapes.AddTriangle(a, b, a + random.InBox(size));
}

Shapes UnitTriangle() {
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  return shapes;
}

// ---- Leaks ----

void LeakAt(Report& report, Vec place) {
  Shapes sphere;
  AddSphereMesh(sphere, place, 2, report.is_thorough() ? 100 : 12);
  ExpectAllHit(report, sphere, AimAtEdges(sphere, place));
  Shapes plane;
  for (std::uint32_t y = 0; y <= 12; ++y) {
    for (std::uint32_t x = 0; x <= 12; ++x) {
      plane.AddVertex(place + Vec{static_cast<float>(x) - 6, 0, static_cast<float>(y) - 6});
    }
  }
  for (std::uint32_t y = 0; y < 12; ++y) {
    for (std::uint32_t x = 0; x < 12; ++x) {
      const std::uint32_t at = 13 * y + x;
      plane.AddTriangle(at, at + 1, at + 14);
      plane.AddTriangle(at, at + 14, at + 13);
    }
  }
  // The rim is a silhouette, which a ray may pass by a rounding error.
  std::vector<Ray> inner;
  for (std::uint32_t y = 1; y < 12; ++y) {
    for (std::uint32_t x = 1; x < 12; ++x) {
      inner.push_back(Towards(place + Vec{0, 8, 0}, plane.vertex(13 * y + x)));
    }
  }
  ExpectAllHit(report, plane, inner);
}

void FarLeaks(Report& report) { LeakAt(report, {148376, 1234, -223423}); }
void OriginLeaks(Report& report) {
  LeakAt(report, {0, 0, 0});
  LeakAt(report, {1e7f, 1e7f, 1e7f});
}

void GridLeaks(Report& report) {
  Shapes grid;
  for (std::uint32_t y = 0; y <= 8; ++y) {
    for (std::uint32_t x = 0; x <= 8; ++x) {
      grid.AddVertex({static_cast<float>(x), static_cast<float>(y), 0});
    }
  }
  for (std::uint32_t at = 0; at < 71; ++at) {
    if (at % 9 == 8) continue;
    grid.AddTriangle(at, at + 1, at + 10);
    grid.AddTriangle(at, at + 10, at + 9);
  }
  std::vector<Ray> rays;
  for (int y = 0; y <= 16; ++y) {
    for (int x = 0; x <= 16; ++x) {
      const Vec at = {static_cast<float>(x) / 2, static_cast<float>(y) / 2, 5};
      rays.push_back({at, {0, 0, -1}});
      rays.push_back({{at.x, at.y, -5}, {0, 0, 1}});
    }
  }
  ExpectAllHit(report, grid, rays);
}

void Diagonal(Report& report) {
  Shapes quad;
  quad.AddQuad({-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0});
  const Ray ray{{0, 0, 10}, {.30458447f, .30458447f, -.9024725f}};
  const Hit hit = TraceEverywhere(report, quad, {ray}).front();
  const float x = hit.t * ray.direction.x;
  report.Expect(IsHit(hit) && std::abs(x - 3.375f) < 1e-3f, "no hit near (3.375, 3.375, 0)", &ray);
}

void SlantedEdge(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({0, 0, -1}, {1, 0, -1}, {0, 1, -1});
  shapes.AddTriangle({1, 0, -1}, {1, 1, -1}, {0, 1, -1});
  const float x = 0x1.e1p-1f, y = 0x1.fp-5f;  // bits 0x3f708000 and 0x3d780000
  ExpectAllHit(report, shapes, {{{x, y, 0}, {0, 0, -1}}});
}

void Collinear(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({-1113.45459f, -79.049614f, -56.2431908f},
                     {-1113.45459f, -87.0922699f, -56.2431908f},
                     {-1113.45459f, -79.2090149f, -56.2431908f});
  Ray ray{{-1081.47925f, 99.9999542f, 87.7701111f}, {-32.1072998f, -183.355865f, -144.607635f}};
  ray.t_max = .9999f;
  ExpectAllMiss(report, shapes, {ray});
}

void HalfSphere(Report& report) {
  Shapes shapes;
  AddSphereMesh(shapes, {0, 0, 0}, 1, 16);
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) {
    if (shapes.vertex(i).y > 0.1f) rays.push_back(Towards({0, 0, 0}, shapes.vertex(i)));
  }
  // The lower half goes away, but a ring below the equator.
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < shapes.indices.size(); i += 3) {
    float lowest = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      lowest = std::min(lowest, shapes.vertex(shapes.indices[i + k]).y);
    }
    if (lowest > -0.01f) kept.insert(kept.end(), &shapes.indices[i], &shapes.indices[i] + 3);
  }
  shapes.indices = kept;
  ExpectAllHit(report, shapes, rays);
}

void PerturbedSpheres(Report& report) {
  const std::uint32_t seeds = report.is_thorough() ? 100000 : 200;
  for (std::uint32_t seed = 0; seed < seeds; ++seed) {
    Random random(seed);
    Shapes shapes;
    AddSphereMesh(shapes, {0, 0, 0}, random.In(1, 6), 8);
    for (float& number : shapes.vertices) number *= random.In(0.95f, 1.05f);
    std::vector<Ray> rays = AimAtEdges(shapes, {0, 0, 0});
    rays.resize(shapes.vertex_count());
    ExpectAllHit(report, shapes, rays);
  }
}

void Slivers(Report& report) {
  for (const float width : {1e-4f, 1e-5f, 1e-6f, 1e-7f, 1e-8f}) {
    Shapes strip;  // of quads 1 high and `width` wide
    for (int i = 0; i <= 64; ++i) {
      strip.AddVertex({static_cast<float>(i) * width, 0, 0});
      strip.AddVertex({static_cast<float>(i) * width, 1, 0});
    }
    for (std::uint32_t i = 0; i < 128; i += 2) {
      strip.AddTriangle(i, i + 2, i + 3);
      strip.AddTriangle(i, i + 3, i + 1);
    }
    std::vector<Ray> rays;
    for (std::uint32_t i = 4; i < 124; ++i) {
      const Vec at = strip.vertex(i);
      rays.push_back({{at.x, 0.25f + at.y / 2, 1}, {0, 0, -1}});
      rays.push_back(Towards({32 * width, 0.5f, 1}, {at.x, 0.5f, 0}));
    }
    ExpectAllHit(report, strip, rays);
  }
}

void Fan(Report& report) {
  Shapes fan;
  const std::uint32_t hub = fan.AddVertex({0.1f, 0.2f, 0.3f});
  constexpr std::uint32_t kBlades = 1000;
  for (std::uint32_t i = 0; i < kBlades; ++i) {
    const double angle = 2 * std::numbers::pi * i / kBlades;
    fan.AddVertex({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
  }
  for (std::uint32_t i = 0; i < kBlades; ++i) {
    fan.AddTriangle(hub, 1 + i, 1 + (i + 1) % kBlades);
  }
  std::vector<Ray> rays;
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    const Vec origin = random.InBox(1) * 0.2f + Vec{0, 0, 5};
    rays.push_back(Towards(origin, fan.vertex(hub)));
    const Vec rim = fan.vertex(1 + static_cast<std::uint32_t>(2 * i));
    rays.push_back(Towards(origin, fan.vertex(hub) + (rim - fan.vertex(hub)) * 0.5f));
  }
  ExpectAllHit(report, fan, rays);
}

// ---- Where new rays start ----

// A parallelogram of two triangles in one plane, exactly: its corners are whole numbers times a
// power of two.
Shapes ExactParallelogram(Random& random) {
  const float scale = std::ldexp(1.0f, static_cast<int>(random.In(-20, 20)));
  // Near the origin, or up to a thousand times its size from it.
  const float reach = std::pow(10.0f, random.In(0, 6));
  const auto whole = [&](float most) {
    const Vec v = random.InBox(most);
    return Vec{std::round(v.x), std::round(v.y), std::round(v.z)} * scale;
  };
  const Vec a = whole(reach), side = whole(2000), other = whole(2000);
  Shapes shapes;
  shapes.AddQuad(a, a + side, a + side + other, a + other);
  return shapes;
}

Shapes AnySphere(Random& random) {
  Shapes shapes;
  const float reach = std::pow(10.0f, random.In(-8, 8));
  const Vec center = random.InBox(reach);
  shapes.AddSphere(center, std::pow(10.0f, random.In(-4, 4)));
  return shapes;
}

LightData<float> Lamp(LightKind kind, Vec position) {
  LightData<float> light{};
  light.kind = kind;
  light.vector[0] = position.x, light.vector[1] = position.y, light.vector[2] = position.z;
  light.falloff[0] = 1;
  return light;
}

// The parallelogram's normal on the surface's side, as exact as double is.
Vec3<double> ExactNormal(const Shapes& shapes, const scalar::Surface<float>& surface) {
  const auto corner = [&](std::uint32_t i) { return shapes.vertex(i).To<double>(); };
  const auto n = Normalize(Cross(corner(1) - corner(0), corner(3) - corner(0)));
  return Dot(n, surface.face.To<double>()) > 0 ? n : -n;
}

// Whether a point lies above the parallelogram by more than rounding can take away, as a shadow ray
// from there sees the corners.
bool LiesAbove(const Shapes& shapes, Vec3<double> normal, Vec point) {
  double reach = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const auto off = shapes.vertex(i).To<double>() - point.To<double>();
    reach = std::max(reach, std::sqrt(Dot(off, off)));
  }
  const auto from_corner = point.To<double>() - shapes.vertex(0).To<double>();
  return Dot(normal, from_corner) > 16 * 0x1p-24 * reach;
}

// A sphere's light from within, to where a ray met its inside and sees the light along `out`.
std::optional<Vec> LampInside(Random& random, const Shapes& shapes,
                              const scalar::Surface<float>& surface, Vec out) {
  const float radius = shapes.spheres[3];
  const float chord = 2 * radius * Dot(out, surface.normal);
  const Vec lamp = surface.position + out * (chord * random.In(0.05f, 0.95f));
  const auto center = Vec{shapes.spheres[0], shapes.spheres[1], shapes.spheres[2]}.To<double>();
  const auto off = lamp.To<double>() - center;
  // Deep enough for a light: where floats are coarse, rounding may put it outside.
  const double depth = static_cast<double>(radius) - std::sqrt(Dot(off, off));
  if (depth < 16 * static_cast<double>(surface.offset)) return std::nullopt;
  return lamp;
}

// What leaves a sphere steeper than this cannot meet it again by the rounding of its direction: it
// has to miss by where it starts, without the source's rule. (A triangle's own rays need the rule:
// near 0, t errs by roundoffs of the vertices' distance.)
constexpr float kSteep = 1e-3f;

// One shape, seen from all around: what leaves it to either side, grazing included, does not come
// back to it, and a light above it reaches it. Returns how many of `count` rays hit.
std::uint64_t MeetNoOwnSurface(Report& report, Random& random, const Shapes& shapes, int count) {
  const bool is_sphere = shapes.indices.empty();
  const Vec center = is_sphere ? Vec{shapes.spheres[0], shapes.spheres[1], shapes.spheres[2]}
                               : shapes.vertex(0) * 0.25f + shapes.vertex(1) * 0.25f +
                                     shapes.vertex(2) * 0.25f + shapes.vertex(3) * 0.25f;
  const Vec across = is_sphere ? Vec{} : shapes.vertex(2) - shapes.vertex(0);
  const float size = is_sphere ? shapes.spheres[3] : std::sqrt(Dot(across, across)) / 2;
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const float distance = size * std::pow(10.0f, random.In(0.5f, 4));
    const Vec origin = center + random.Direction() * distance;
    rays.push_back(Towards(origin, center + random.Direction() * (0.9f * size)));
  }
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  const FlatShapes flat(shapes);
  const GeometryView<float> geometry = flat.view();
  std::vector<Ray> leaving, inside;
  std::uint64_t hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Far from the origin a small shape is hit by luck alone.
    if (!IsHit(hits[i])) continue;
    ++hit_count;
    const std::uint32_t primitive = hits[i].primitive;
    const auto surface =
        is_sphere ? scalar::SphereSurface(rays[i], hits[i], geometry.spheres, primitive)
                  : scalar::TriangleSurface(rays[i], hits[i], geometry.triangles, primitive);
    const Vec along = Normalize(Cross(surface.normal, random.Direction()));
    const float slope = std::pow(10.0f, random.In(-7, 1));
    const Vec out = Normalize(along + surface.normal * slope);
    const Vec in = Normalize(along - surface.normal * slope);
    const Vec away = surface.face * surface.offset;
    const Ray up{surface.position + away, out, surface.source};
    const Ray down{surface.position - away, in, surface.source ^ kInsideBit};
    const auto light_from = [&](LightKind kind, Vec lamp) {
      const LightData<float> light = Lamp(kind, lamp);
      const auto incidence = scalar::IncidenceOf(light, surface);
      if (incidence.reaches) leaving.push_back(scalar::ShadowRay(light, surface, incidence));
    };
    Vec3<double> normal{};  // of a parallelogram
    if (is_sphere) {
      // One of the two goes into the sphere, whose far side it may meet.
      (surface.inside() ? inside : leaving).push_back(up);
      (surface.inside() ? leaving : inside).push_back(down);
      Ray without_source = surface.inside() ? down : up;
      without_source.source = kNoPrimitive;
      if (slope > kSteep) leaving.push_back(without_source);
      if (surface.inside()) {
        const std::optional<Vec> lamp = LampInside(random, shapes, surface, out);
        if (!lamp) continue;
        light_from(LightKind::kPointFromLight, *lamp);
        light_from(LightKind::kPointFromSurface, *lamp);
        continue;
      }
    } else {
      // The steepness of the flattest is less than a roundoff of their directions: some of those
      // really go to the other side.
      normal = ExactNormal(shapes, surface);
      if (Dot(normal, out.To<double>()) > 0) leaving.push_back(up);
      if (Dot(normal, in.To<double>()) < 0) leaving.push_back(down);
    }
    for (const LightKind kind : {LightKind::kPointFromLight, LightKind::kPointFromSurface}) {
      const Vec lamp = surface.position + out * (size * std::pow(10.0f, random.In(-1, 1.5f)));
      if (is_sphere || LiesAbove(shapes, normal, lamp)) light_from(kind, lamp);
    }
  }
  ExpectAllMiss(report, shapes, leaving);
  const std::vector<Hit> ends = TraceEverywhere(report, shapes, inside);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    report.Expect(!IsHit(ends[i]) || ends[i].u == 1, "a ray inside meets the root that it left",
                  &inside[i]);
  }
  return hit_count;
}

void SelfHits(Report& report) {
  const int shapes = report.is_thorough() ? 1000 : 60;
  Random random(9);
  std::uint64_t hits = 0;
  for (int i = 0; i < shapes; ++i) {
    hits += MeetNoOwnSurface(report, random, AnySphere(random), report.is_thorough() ? 1000 : 100);
  }
  report.Expect(hits > 0, "no sphere is hit");
}

void Acne(Report& report) {
  const std::uint64_t wanted = report.is_thorough() ? 100000000 : 60000;
  constexpr int kRays = 500;
  Random random(10);
  std::uint64_t hits = 0;
  for (int i = 0; hits < wanted && static_cast<std::uint64_t>(i) * kRays < 3 * wanted; ++i) {
    hits += MeetNoOwnSurface(report, random, i % 2 ? AnySphere(random) : ExactParallelogram(random),
                             kRays);
  }
  report.Expect(hits >= wanted, fmt::format("only {} hits", hits));
}

void NearlyEqualSpheres(Report& report) {
  Shapes shapes = UnitSphere();
  shapes.AddSphere({0, 0, 0}, 1.00004f);
  const Ray outer{{0, 0, 5}, {0, 0, -1}};
  ExpectHit(report, shapes, outer, 1, 5 - static_cast<double>(1.00004f), 0.5);
  Ray inner = outer;
  inner.t_min = 3.99998f;
  ExpectHit(report, shapes, inner, 0, 4, 0.5);
}

// ---- Spheres ----

// The squared distance of a unit sphere's centre, the origin, from the ray's line.
long double SquaredDistance(const Ray& ray) {
  const auto d = ray.direction.To<long double>();
  const auto across = Cross(ray.origin.To<long double>(), d);
  return Dot(across, across) / Dot(d, d);
}

void NearTangent(Report& report) {
  Random random(11);
  const Shapes sphere = UnitSphere();
  for (int power = 0; power <= 6; ++power) {
    const double distance = std::pow(10.0, power) + 1;
    std::vector<Ray> rays;
    for (int i = 0; i < 400; ++i) {
      // Through a point about 0.999 or 1.001 radii from the centre; far away a direction of float
      // misses that by more, so what counts is where the line passes.
      const Vec view = random.Direction();
      const Vec across = Normalize(Cross(view, random.Direction()));
      const Vec origin = view * static_cast<float>(distance);
      const float aim = i % 2 ? 0.999f : 1.001f;
      rays.push_back({origin, Normalize(across * aim - origin)});
    }
    // docs/numerics.md, "Spheres".
    const long double band = 16 * 0x1p-53L * (static_cast<long double>(distance) + 1);
    const std::vector<Hit> hits = TraceEverywhere(report, sphere, rays);
    int within = 0, judged = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const long double past = SquaredDistance(rays[i]) - 1;
      if (std::abs(past) <= band) continue;
      report.Expect(IsHit(hits[i]) == (past < 0), "misjudged", &rays[i]);
      within += past < 0;
      ++judged;
    }
    report.Expect(within > 100 && judged > 390, "rays that pass on one side alone, or in doubt");
  }
}

void GroundSphere(Report& report) {
  Shapes shapes;
  shapes.AddSphere({0, -1e6f, 0}, 1e6f);
  Random random(12);
  for (int i = 0; i < 100; ++i) {
    const Vec d = Normalize(Vec{random.In(-1, 1), random.In(-1, -0.01f), random.In(-1, 1)});
    const Ray ray{{0, 1, 0}, d};
    // The root without cancellation, in long double.
    const long double a = static_cast<long double>(d.x) * d.x +
                          static_cast<long double>(d.y) * d.y + static_cast<long double>(d.z) * d.z;
    const long double b = -1000001.0L * static_cast<long double>(d.y);
    const long double c = 1000001.0L * 1000001.0L - 1e12L;
    const long double t = c / (b + std::sqrt(b * b - a * c));
    ExpectHit(report, shapes, ray, 0, static_cast<double>(t), 1);
  }
}

void OnSphere(Report& report) {
  const Ray out{{0, 0, 1}, {0, 0, 1}}, in{{0, 0, 1}, {0, 0, -1}};
  ExpectAllMiss(report, UnitSphere(), {out});
  ExpectHit(report, UnitSphere(), in, 0, 2, 0);
  // Points that rounding put off the sphere, to either side: the source decides.
  Random random(13);
  std::vector<Ray> outward, inward;
  for (int i = 0; i < 500; ++i) {
    const Vec at = random.Direction();
    outward.push_back({at, at, 0});
    inward.push_back({at, -at, kInsideBit});
  }
  ExpectAllMiss(report, UnitSphere(), outward);
  const std::vector<Hit> hits = TraceEverywhere(report, UnitSphere(), inward);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    report.Expect(IsHit(hits[i]) && hits[i].u == 1, "not the far root", &inward[i]);
  }
}

void FromCentre(Report& report) {
  for (const float radius : {1e-6f, 0.1f, 1.0f, 3.7f, 1e8f}) {
    Shapes shapes;
    shapes.AddSphere({1, 2, 3}, radius);
    ExpectHit(report, shapes, {{1, 2, 3}, {0, 0, 1}}, 0, static_cast<double>(radius), 0);
    ExpectHit(report, shapes, {{1, 2, 3}, {0, -2, 0}}, 0, static_cast<double>(radius) / 2, 0);
  }
}

void BadRadius(Report& report) {
  Shapes point;
  point.AddSphere({0, 0, 0}, 0);
  point.AddSphere({0, 0, 0}, -0.0f);
  ExpectAllMiss(report, point, {{{0, 0, 5}, {0, 0, -1}}, {{0, 0, 0}, {0, 0, -1}}});
  for (const float radius : {-1.0f, kInfinity, kNan}) {
    const std::array<float, 4> sphere = {0, 0, 0, radius};
    GeometryInput input;
    input.AddSpheres(sphere);
    report.Expect(!Geometry::Build(input), fmt::format("a radius of {} is accepted", radius));
  }
}

// ---- Scale, signs, intervals ----

void PowersOfTwo(Report& report) {
  Random random(16);
  const Vec a = random.InBox(1), b = random.InBox(1), c = random.InBox(1), s = random.InBox(1);
  std::vector<float> first;
  for (int power = -40; power <= 40; power += 10) {
    const float scale = std::ldexp(1.0f, power);
    Shapes shapes;
    shapes.AddTriangle(a * scale, b * scale, c * scale);
    shapes.AddSphere(s * scale, 0.3f * scale);
    std::vector<Ray> rays;
    for (int i = 0; i < 50; ++i) {
      Random ray_random(static_cast<std::uint32_t>(i));
      const Vec origin = ray_random.Direction() * 4.0f;
      const Vec inside = (a + b + c) * (1.0f / 3);
      rays.push_back({origin * scale, (i % 2 ? inside : s) - origin});
    }
    std::vector<float> distances;
    for (const Hit& hit : TraceEverywhere(report, shapes, rays)) {
      distances.push_back(IsHit(hit) ? hit.t / scale : -1);
    }
    if (first.empty()) first = distances;
    const auto hits = std::count_if(first.begin(), first.end(), [](float t) { return t > 0; });
    report.Expect(hits > 40, "the rays miss");
    report.Expect(distances == first, fmt::format("t at scale 2^{} is not that times t", power));
  }
}

void MinusZero(Report& report) {
  for (const float zero : {0.0f, -0.0f}) {
    ExpectHit(report, UnitSphere(), {{zero, zero, 3}, {zero, zero, -1}}, 0, 2, 0);
    ExpectHit(report, UnitTriangle(), {{0.25f, 0.25f, 3}, {zero, zero, -1}}, 0, 3, 0);
    ExpectHit(report, UnitTriangle(), {{zero, zero, 3}, {zero, zero, -1}}, 0, 3, 0);
  }
}

void BadDirections(Report& report) {
  Shapes shapes = UnitTriangle();
  shapes.AddSphere({0, 0, 0}, 1);
  std::vector<Ray> rays;
  for (const float bad : {kNan, kInfinity, -kInfinity}) {
    rays.push_back({{0.2f, 0.2f, 3}, {bad, 0, -1}});
    rays.push_back({{0.2f, 0.2f, 3}, {0, bad, -1}});
    rays.push_back({{0.2f, 0.2f, 3}, {0, 0, bad}});
  }
  rays.push_back({{0.2f, 0.2f, 3}, {0, 0, 0}});
  rays.push_back({{0.2f, 0.2f, 3}, {-0.0f, 0, -0.0f}});
  ExpectAllMiss(report, shapes, rays);
}

void BadNumbers(Report& report) {
  std::vector<Ray> rays(5, Ray{{0, 0, 3}, {0, 0, -1}});
  rays[0].origin.x = kNan;
  rays[1].origin.z = kInfinity;
  rays[2].t_min = kNan;
  rays[3].t_max = kNan;
  rays[4].t_min = kInfinity;
  ExpectAllMiss(report, UnitSphere(), rays);
}

void BoxFace(Report& report) {
  Shapes shapes;  // a flat box at x = 0, among others, so that there is a tree
  for (int i = 0; i < 40; ++i) {
    const float z = static_cast<float>(-i);
    shapes.AddQuad({0, 0, z}, {0, 1, z}, {0, 1, z - 1}, {0, 0, z - 1});
    shapes.AddQuad({0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z});
  }
  std::vector<Ray> rays;
  for (const float x : {0.0f, -0.0f}) {
    rays.push_back({{x, 0.5f, 3}, {x, 0, -1}});
    rays.push_back({{x, 0, 3}, {x, x, -1}});
    rays.push_back({{x, 1, 3}, {0, x, -1}});
  }
  ExpectAllHit(report, shapes, rays);
}

void Denormals(Report& report) {
  const float tiny = std::numeric_limits<float>::denorm_min();
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {1000 * tiny, 0, 0}, {0, 1000 * tiny, 0});
  shapes.AddTriangle({0, 0, -1}, {1, 0, -1}, {0, 1, -1});
  std::vector<Ray> rays;
  for (const float step : {tiny, 100 * tiny, 1e-30f}) {
    rays.push_back({{step, step, 1}, {0, 0, -1}});
    rays.push_back({{0.2f, 0.2f, 1}, {step, 0, -1}});
    rays.push_back({{0.2f, 0.2f, 1}, {0, 0, -step}});
  }
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  report.Expect(hits[1].primitive == 1, "a denormal direction misses the triangle", &rays[1]);
}

void Intervals(Report& report) {
  Ray ray{{0, 0, 3}, {0, 0, -1}};
  ray.t_min = ray.t_max = 2;
  ExpectHit(report, UnitSphere(), ray, 0, 2, 0);
  ray.t_min = 2;
  ray.t_max = std::nextafter(2.0f, 0.0f);
  ExpectAllMiss(report, UnitSphere(), {ray});
  ray.t_max = kInfinity;
  ExpectHit(report, UnitSphere(), ray, 0, 2, 0);
  ray.t_min = std::nextafter(2.0f, 3.0f);
  ExpectHit(report, UnitSphere(), ray, 0, 4, 0);
  Ray at_triangle{{0.25f, 0.25f, 3}, {0, 0, -1}};
  at_triangle.t_min = at_triangle.t_max = 3;
  ExpectHit(report, UnitTriangle(), at_triangle, 0, 3, 0);
}

void LongDirections(Report& report) {
  for (const float length : {1e-20f, 1e-10f, 1.0f, 1e10f, 1e20f}) {
    const double expected = 2 / static_cast<double>(length);
    ExpectHit(report, UnitSphere(), {{0, 0, 3}, {0, 0, -length}}, 0, expected, 1);
    const Ray ray{{0.2f, 0.2f, 2}, {0, 0, -length}};
    ExpectHit(report, UnitTriangle(), ray, 0, expected, 1);
  }
}

// ---- Degenerate and coinciding shapes ----

void ZeroArea(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {0, 0, 0}, {1, 1, 0});
  shapes.AddTriangle({0, 0, 0}, {1, 1, 0}, {2, 2, 0});
  shapes.AddTriangle({1, 1, 0}, {1, 1, 0}, {1, 1, 0});
  std::vector<Ray> rays;
  for (const Vec target : {Vec{0, 0, 0}, Vec{1, 1, 0}, Vec{0.5f, 0.5f, 0}}) {
    rays.push_back(Towards({0.3f, 0.1f, 4}, target));
    rays.push_back({{target.x, target.y, 4}, {0, 0, -1}});
  }
  ExpectAllMiss(report, shapes, rays);
}

void Duplicates(Report& report) {
  Shapes shapes;
  const std::uint32_t copies = report.is_thorough() ? 1000000 : 100000;
  const std::uint32_t a = shapes.AddVertex({0, 0, 0}), b = shapes.AddVertex({1, 0, 0}),
                      c = shapes.AddVertex({0, 1, 0});
  for (std::uint32_t i = 0; i < copies; ++i) shapes.AddTriangle(a, b, c);
  ExpectHit(report, shapes, {{0.2f, 0.3f, 3}, {0, 0, -1}}, 0, 3, 0);
}

void CoplanarDuplicates(Report& report) {
  Shapes shapes;
  for (int copy = 0; copy < 3; ++copy) {
    shapes.AddQuad({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    shapes.AddSphere({0.5f, 0.5f, 0}, 0.125f);
  }
  ExpectHit(report, shapes, {{0.75f, 0.25f, 3}, {0, 0, -1}}, 0, 3, 0);
  ExpectHit(report, shapes, {{0.25f, 0.75f, 3}, {0, 0, -1}}, 1, 3, 0);
  // On the diagonal both triangles have it; a sphere in front of them has the first id of three.
  ExpectHit(report, shapes, {{0.875f, 0.875f, 3}, {0, 0, -1}}, 0, 3, 0);
  ExpectHit(report, shapes, {{0.5f, 0.5f, 3}, {0, 0, -1}}, 6, 2.875, 0);
}

void InPlane(Report& report) {
  std::uint64_t hit_count = 0;
  for (std::uint32_t seed = 0; seed < (report.is_thorough() ? 5000u : 50u); ++seed) {
    Random random(seed);
    Shapes shapes;
    for (int i = 0; i < 30; ++i) AddRandomTriangle(random, shapes, 1);
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 90; i += 3) {
      const Vec a = shapes.vertex(i), b = shapes.vertex(i + 1), c = shapes.vertex(i + 2);
      // Along an edge, past the triangle, and across it, all within its plane but for rounding.
      rays.push_back({a + (a - b) * 2.0f, b - a});
      rays.push_back({b + (b - c) + (b - a), (c - b) + (a - b) * random.In(-2, 2)});
      const auto in_plane = [&](float most) {
        const float along_b = random.In(-most, most), along_c = random.In(-most, most);
        return (b - a) * along_b + (c - a) * along_c;
      };
      const Vec origin = a + in_plane(9);
      rays.push_back({origin, in_plane(1)});
    }
    // A fan from one origin, all of it in the plane of the first triangle.
    const Vec a = shapes.vertex(0), b = shapes.vertex(1), c = shapes.vertex(2);
    const Vec eye = a + (a - b) * 2.0f;
    for (int i = 0; i < 64; ++i) {
      rays.push_back(Towards(eye, b + (c - b) * (static_cast<float>(i) / 32 - 0.5f)));
    }
    for (const Hit& hit : TraceEverywhere(report, shapes, rays)) {
      report.Expect(hit.t == hit.t && hit.u == hit.u && hit.v == hit.v, "NaN in a hit");
      hit_count += IsHit(hit);
    }
  }
  report.Expect(hit_count > 100, fmt::format("only {} hits", hit_count));
}

void UlpApart(Report& report) {
  const float above = std::nextafter(1.0f, 2.0f);
  Shapes shapes;
  shapes.AddQuad({-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1});
  shapes.AddQuad({-1, -1, above}, {1, -1, above}, {1, 1, above}, {-1, 1, above});
  // Where the origin's distance keeps the last place.
  ExpectHit(report, shapes, {{0.3f, 0.2f, 2}, {0, 0, -1}}, 2, 2 - static_cast<double>(above), 1);
  ExpectHit(report, shapes, {{0.3f, 0.2f, 0.5f}, {0, 0, 1}}, 0, 0.5, 0);
}

void Horizon(Report& report) {
  Shapes shapes;
  shapes.AddQuad({-1e6f, 0, -1e6f}, {1e6f, 0, -1e6f}, {1e6f, 0, 1e6f}, {-1e6f, 0, 1e6f});
  std::vector<Ray> down, up;
  Random random(43);
  for (int i = 0; i < 300; ++i) {
    const float slope = std::pow(10.0f, random.In(-5.5f, -1));
    down.push_back({{random.In(-1, 1), 1, 0}, {random.In(-1, 1), -slope, 1}});
    up.push_back({{random.In(-1, 1), 1, 0}, {random.In(-1, 1), slope, 1}});
  }
  ExpectAllHit(report, shapes, down);
  ExpectAllMiss(report, shapes, up);
}

void ManyInOnePlace(Report& report) {
  const std::uint32_t count = 1000000;
  Shapes point, line;
  for (std::uint32_t i = 0; i < count; ++i) {
    point.AddSphere({1, 2, 3}, 1);
    line.AddSphere({static_cast<float>(i), 0, 0}, 0.25f);
  }
  const Ray at_point{{1, 2, 9}, {0, 0, -1}};
  const Hit hit = TraceEverywhere(report, point, {at_point}, Oracle::kTreeOnly).front();
  report.Expect(hit.primitive == 0 && hit.t == 5, "not the first of many equal spheres", &at_point);
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) {
    const float x = static_cast<float>(i * (static_cast<int>(count) / 100));
    rays.push_back({{x, 0, 5}, {0, 0, -1}});
  }
  rays.push_back({{-5, 0, 0}, {1, 0, 0}});
  const std::vector<Hit> hits = TraceEverywhere(report, line, rays, Oracle::kTreeOnly);
  for (std::size_t i = 0; i < 100; ++i) {
    report.Expect(hits[i].primitive == static_cast<std::uint32_t>(rays[i].origin.x),
                  "not the sphere ahead", &rays[i]);
  }
  report.Expect(hits[100].primitive == 0, "not the first along the line", &rays[100]);
}

void LinearMemory(Report& report) {
  for (const std::uint32_t count : {1000u, 100000u, report.is_thorough() ? 10000000u : 1000000u}) {
    Shapes shapes;
    Random random(37);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Vec at = random.InBox(100);
      shapes.AddTriangle(at, at + Vec{0.1f, 0, 0}, at + Vec{0, 0.1f, 0.05f});
    }
    GeometryInput input;
    input.AddTriangles(shapes.vertices, shapes.indices);
    const Result<Geometry> geometry = Geometry::Build(input);
    report.Expect(geometry.ok(), "no geometry");
    if (!geometry) return;
    const double bytes = static_cast<double>(geometry.value().statistics().bytes) / count;
    report.Expect(bytes <= 70, fmt::format("{:.1f} bytes a triangle of {}", bytes, count));
  }
}

// Nothing may depend on the size of the world or the place in it.
void ScaledWorld(Report& report) {
  for (int power = -6; power <= 6; power += 3) {
    for (const float place : {0.0f, 1e3f, 1e6f}) {
      const float scale = std::pow(10.0f, static_cast<float>(power));
      const Vec center = {place * scale, -place * scale, place * scale};
      Shapes shapes;
      AddSphereMesh(shapes, center, scale, 8);
      ExpectAllHit(report, shapes, AimAtEdges(shapes, center));
    }
  }
}

void RandomScenes(Report& report) {
  const std::uint32_t scenes = report.is_thorough() ? 5000 : 100;
  std::uint64_t sphere_hits = 0, triangle_hits = 0;
  for (std::uint32_t seed = 0; seed < scenes; ++seed) {
    Random random(seed + 1000);
    Shapes shapes;
    const int triangles = static_cast<int>(random.In(0, 60)),
              spheres = static_cast<int>(random.In(0, 30));
    const float size = std::pow(10.0f, random.In(-3, 1));
    for (int i = 0; i < triangles; ++i) AddRandomTriangle(random, shapes, size);
    for (int i = 0; i < spheres; ++i) {
      const Vec center = random.InBox(4);
      shapes.AddSphere(center, random.In(0, size));
    }
    std::vector<Ray> rays;
    const Vec eye = random.InBox(8);
    for (int i = 0; i < 150; ++i) {
      const Vec origin = i % 3 == 0 ? random.InBox(8) : eye;
      Ray ray{origin, i % 2 ? random.Direction() : random.InBox(4) - origin};
      if (i % 7 == 0) ray.t_max = random.In(0, 6);
      rays.push_back(ray);
    }
    for (const Hit& hit : TraceEverywhere(report, shapes, rays)) {
      if (IsHit(hit)) ++(hit.primitive < shapes.indices.size() / 3 ? triangle_hits : sphere_hits);
    }
  }
  report.Expect(sphere_hits > 5 * scenes && triangle_hits > 5 * scenes,
                fmt::format("only {} and {} hits", triangle_hits, sphere_hits));
}

// ---- Refraction ----

void CriticalAngle(Report& report) {
  for (const float ior : {1.1f, 1.333f, 1.5f, 2.4f}) {
    // cos of the critical angle, and its neighbours by ULPs.
    float cosine = static_cast<float>(std::sqrt(1 - 1 / (static_cast<double>(ior) * ior)));
    for (int i = 0; i < 8; ++i) cosine = std::nextafter(cosine, 0.0f);
    for (int i = 0; i < 17; ++i, cosine = std::nextafter(cosine, 1.0f)) {
      const long double c = cosine, n = ior;
      const long double k = 1 - n * n * (1 - c * c);
      const auto split = scalar::FresnelSplit(ior, cosine);
      report.Expect(split.is_total == !(k > 0),
                    fmt::format("ior {:a}, cosine {:a}: total is {}", ior, cosine, split.is_total));
    }
  }
}

void ExtremeIors(Report& report) {
  Random random(44);
  for (const float ior : {1e-3f, 0.5f, 1.0f, 1e3f}) {
    for (int i = 0; i < 1000; ++i) {
      const float cosine = random.In(0, 1);
      for (const float eta : {ior, 1 / ior}) {
        const auto split = scalar::FresnelSplit(eta, cosine);
        const bool sound = split.reflectance >= 0 && split.reflectance <= 1 && split.cos_t >= 0 &&
                           split.cos_t <= 1;
        report.Expect(sound, fmt::format("eta {:a}, cosine {:a}", eta, cosine));
        const bool lets_through = split.reflectance == 0 && split.cos_t == cosine;
        if (eta == 1) report.Expect(lets_through, fmt::format("ior 1 bends at {:a}", cosine));
      }
    }
  }
}

constexpr Case kCases[] = {
    {"far-leaks", "meshes at (148376, 1234, -223423): rays at vertices and edges hit", FarLeaks},
    {"origin-leaks", "the same at the origin and at 1e7", OriginLeaks},
    {"grid-leaks", "an integer grid, axis-parallel rays at edges and vertices: hit", GridLeaks},
    {"diagonal", "a ray at the diagonal of a quad: hit near (3.375, 3.375, 0)", Diagonal},
    {"slanted-edge", "a ray exactly at an edge that two triangles share: hit", SlantedEdge},
    {"collinear", "a triangle of three points of a line: miss", Collinear},
    {"half-sphere", "rays exactly at the vertices of half a sphere: hit", HalfSphere},
    {"perturbed-spheres", "rays at the vertices of perturbed spheres: hit", PerturbedSpheres},
    {"self-hits", "spheres of 1e-4 to 1e4 at 1e-8 to 1e8: no new ray hits its own surface",
     SelfHits},
    {"acne", "every scale, grazing too: no ray, no light's ray meets its own surface", Acne},
    {"nearly-equal-spheres", "radii 1 and 1.00004: both surfaces found", NearlyEqualSpheres},
    {"near-tangent", "to either side of tangent, from 1 to 1e6 radii: judged right", NearTangent},
    {"ground-sphere", "radius 1e6 seen from 1 above: t within 1 ULP", GroundSphere},
    {"on-sphere", "origin on a sphere: outward misses, inward takes the far root", OnSphere},
    {"from-centre", "from the centre: the far root, t is the radius", FromCentre},
    {"bad-radius", "radius 0 misses; negative, infinite, NaN: an error", BadRadius},
    {"powers-of-two", "scaled by 2^-40 to 2^40: t scales bit for bit", PowersOfTwo},
    {"slivers", "triangles 1e-4 to 1e-8 wide: no leak", Slivers},
    {"zero-area", "triangles without area: miss, no NaN", ZeroArea},
    {"coplanar-duplicates", "surfaces in one place: the lowest id", CoplanarDuplicates},
    {"in-plane", "rays in the planes of triangles: all agree, no NaN", InPlane},
    {"minus-zero", "-0 traces as +0", MinusZero},
    {"bad-directions", "zero, NaN and infinite directions: miss", BadDirections},
    {"bad-numbers", "NaN or infinity in origin, t_min, t_max: miss", BadNumbers},
    {"box-face", "along the faces of boxes, direction 0 on their axis: hit", BoxFace},
    {"denormals", "denormal vertices and directions: all agree", Denormals},
    {"intervals", "t = t_min = t_max counts, t_min > t_max misses, infinite t_max", Intervals},
    {"long-directions", "directions of length 1e-20 to 1e20: t scales", LongDirections},
    {"critical-angle", "8 ULP around critical: total reflection as in long double", CriticalAngle},
    {"extreme-iors", "1e-3 to 1e3: energy kept; 1: unbent and no reflection", ExtremeIors},
    {"duplicates", "100,000 equal triangles: the build ends, the lowest id", Duplicates},
    {"linear-memory", "up to a million triangles: at most 70 bytes each", LinearMemory},
    {"fan", "1,000 triangles at a vertex: no leak", Fan},
    {"ulp-apart", "two surfaces 1 ULP apart: the nearer", UlpApart},
    {"horizon", "grazing rays along a floor: all that point down hit", Horizon},
    {"many-in-one-place", "a million spheres in a point, in a line: the build ends, the right one",
     ManyInOnePlace},
    {"scaled-world", "a mesh scaled 1e-6 to 1e6, moved by 1e6 of it: no leak", ScaledWorld},
    {"random-scenes", "random scenes: every primitive, tree and target agree", RandomScenes},
};

}  // namespace

std::span<const Case> RayCases() { return kCases; }

}  // namespace sheaf::stress
