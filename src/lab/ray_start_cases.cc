// Secondary and shadow rays do not meet the surface that they start on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "simd/query.h"
#include "simd/shading.h"
#include "simd/tree.h"
#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"
#include "src/scalar/primitives.h"
#include "src/scalar/shadow_ray.h"

namespace sheaf::stress {
namespace {

using Surface = scalar::Surface<float>;

constexpr LightKind kPointKinds[] = {LightKind::kPointFromLight, LightKind::kPointFromSurface};

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
Vec3<double> ExactNormal(const Shapes& shapes, const Surface& surface) {
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
std::optional<Vec> LampInside(Random& random, const Shapes& shapes, const Surface& surface,
                              Vec out) {
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

struct Extent {
  Vec center;
  float size;
};

Extent ExtentOf(const Shapes& shapes) {
  if (shapes.indices.empty()) {
    return {{shapes.spheres[0], shapes.spheres[1], shapes.spheres[2]}, shapes.spheres[3]};
  }
  const Vec center = shapes.vertex(0) * 0.25f + shapes.vertex(1) * 0.25f +
                     shapes.vertex(2) * 0.25f + shapes.vertex(3) * 0.25f;
  const Vec across = shapes.vertex(2) - shapes.vertex(0);
  return {center, std::sqrt(Dot(across, across)) / 2};
}

std::vector<Ray> AimFromAllAround(Random& random, const Extent& extent, int count) {
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const float distance = extent.size * std::pow(10.0f, random.In(0.5f, 4));
    const Vec origin = extent.center + random.Direction() * distance;
    rays.push_back(Towards(origin, extent.center + random.Direction() * (0.9f * extent.size)));
  }
  return rays;
}

// The rays that leave one shape, by what they must do.
class Departures {
 public:
  Departures(Random& random, const Shapes& shapes, float size)
      : random_(random), shapes_(shapes), size_(size) {}

  void FromSphere(const Surface& surface);
  void FromParallelogram(const Surface& surface);
  // Must miss the shape.
  const std::vector<Ray>& leaving() const { return leaving_; }
  // Run inside the sphere and must not meet the root that they left.
  const std::vector<Ray>& inside() const { return inside_; }

 private:
  // The two rays that a surface spawns, to its own side and to the other, equally steep.
  struct Spawned {
    Ray up, down;
    float slope;
  };

  Spawned Spawn(const Surface& surface);
  Vec LampAlong(const Surface& surface, Vec out) {
    return surface.position + out * (size_ * std::pow(10.0f, random_.In(-1, 1.5f)));
  }
  void ShineFrom(LightKind kind, Vec lamp, const Surface& surface);

  Random& random_;
  const Shapes& shapes_;
  float size_;
  std::vector<Ray> leaving_, inside_;
};

Departures::Spawned Departures::Spawn(const Surface& surface) {
  const Vec along = Normalize(Cross(surface.normal, random_.Direction()));
  const float slope = std::pow(10.0f, random_.In(-7, 1));
  const Vec out = Normalize(along + surface.normal * slope);
  const Vec in = Normalize(along - surface.normal * slope);
  const Vec away = surface.face * surface.offset;
  return {{surface.position + away, out, surface.source},
          {surface.position - away, in, surface.source ^ kInsideBit},
          slope};
}

void Departures::ShineFrom(LightKind kind, Vec lamp, const Surface& surface) {
  const LightData<float> light = Lamp(kind, lamp);
  const auto incidence = scalar::IncidenceOf(light, surface);
  if (incidence.reaches) leaving_.push_back(scalar::ShadowRay(light, surface, incidence));
}

void Departures::FromSphere(const Surface& surface) {
  const auto [up, down, slope] = Spawn(surface);
  // One of the two goes into the sphere, whose far side it may meet.
  (surface.inside() ? inside_ : leaving_).push_back(up);
  (surface.inside() ? leaving_ : inside_).push_back(down);
  Ray without_source = surface.inside() ? down : up;
  without_source.source = kNoPrimitive;
  if (slope > kSteep) leaving_.push_back(without_source);
  if (surface.inside()) {
    const std::optional<Vec> lamp = LampInside(random_, shapes_, surface, up.direction);
    if (!lamp) return;
    for (const LightKind kind : kPointKinds) ShineFrom(kind, *lamp, surface);
    return;
  }
  for (const LightKind kind : kPointKinds) {
    ShineFrom(kind, LampAlong(surface, up.direction), surface);
  }
}

void Departures::FromParallelogram(const Surface& surface) {
  const auto [up, down, slope] = Spawn(surface);
  // The steepness of the flattest is less than a roundoff of their directions: some of those
  // really go to the other side.
  const Vec3<double> normal = ExactNormal(shapes_, surface);
  if (Dot(normal, up.direction.To<double>()) > 0) leaving_.push_back(up);
  if (Dot(normal, down.direction.To<double>()) < 0) leaving_.push_back(down);
  for (const LightKind kind : kPointKinds) {
    const Vec lamp = LampAlong(surface, up.direction);
    if (LiesAbove(shapes_, normal, lamp)) ShineFrom(kind, lamp, surface);
  }
}

// One shape, seen from all around: what leaves it to either side, grazing included, does not come
// back to it, and a light above it reaches it. Returns how many of `count` rays hit.
std::uint64_t MeetNoOwnSurface(Report& report, Random& random, const Shapes& shapes, int count) {
  const Extent extent = ExtentOf(shapes);
  const std::vector<Ray> rays = AimFromAllAround(random, extent, count);
  const std::vector<Hit> hits = TraceEverywhere(report, shapes, rays);
  const FlatShapes flat(shapes);
  const GeometryView<float> geometry = flat.view();
  Departures departures(random, shapes, extent.size);
  std::uint64_t hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    // Far from the origin a small shape is hit by luck alone.
    if (!IsHit(hits[i])) continue;
    ++hit_count;
    const std::uint32_t primitive = hits[i].primitive;
    if (shapes.indices.empty()) {
      departures.FromSphere(scalar::SphereSurface(rays[i], hits[i], geometry.spheres, primitive));
    } else {
      departures.FromParallelogram(
          scalar::TriangleSurface(rays[i], hits[i], geometry.triangles, primitive));
    }
  }
  ExpectAllMiss(report, shapes, departures.leaving());
  const std::vector<Ray>& inside = departures.inside();
  const std::vector<Hit> ends = TraceEverywhere(report, shapes, inside);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    report.Expect(!IsHit(ends[i]) || ends[i].u == 1, "a ray inside meets the root that it left",
                  &inside[i]);
  }
  return hit_count;
}

}  // namespace

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

}  // namespace sheaf::stress
