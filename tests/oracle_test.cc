// Every arithmetic and target against 113 bits: the table of errors in docs/numerics.md, and the
// bounds that it promises. `oracle_test --success` prints the table.
#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "exact.h"
#include "one_disk.h"
#include "random_scene.h"
#include "simd/kernels.h"
#include "simd/query.h"
#include "simd/roundoffs.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/bvh/build_tree.h"
#include "targets.h"

namespace sheaf {
namespace {

using scalar::Ray;

struct Errors {
  double worst = 0, sum = 0;
  int count = 0;

  void Add(double error) {
    // A NaN is as bad as it gets.
    worst = error <= worst ? worst : error == error ? error : 1e30;
    sum += error, ++count;
  }
  double mean() const { return sum / count; }
};

// The errors of one arithmetic on one target.
struct Measured {
  Errors sphere_t, sphere_normal;                    // ULP, radians
  Errors disk_t, disk_normal;                        // ULP, radians
  Errors triangle_t, barycentrics, triangle_normal;  // ULP and roundoffs, see below; radians
  Errors reflectance, refracted;                     // absolute, radians
  Errors highlight;                                  // absolute
  int spheres_in_doubt = 0, spheres_misjudged = 0;   // of near-tangent rays
  int disks_misjudged = 0;                           // of rays at rims, half of them grazing
  int triangles_misjudged = 0;                       // of rays at edges
  int reflections_misjudged = 0;                     // of rays near the critical angle

  bool operator==(const Measured& other) const { return Numbers() == other.Numbers(); }

 private:
  std::array<double, 17> Numbers() const {
    return {sphere_t.worst,
            sphere_t.sum,
            sphere_normal.sum,
            disk_t.worst,
            disk_t.sum,
            disk_normal.sum,
            triangle_t.sum,
            triangle_normal.sum,
            barycentrics.sum,
            reflectance.sum,
            refracted.sum,
            highlight.sum,
            1.0 * spheres_in_doubt,
            1.0 * spheres_misjudged,
            1.0 * disks_misjudged,
            1.0 * triangles_misjudged,
            1.0 * reflections_misjudged};
  }
};

double Length(Vec3<double> v) { return std::sqrt(Dot(v, v)); }

// Of two unit vectors, as rounded.
template <typename Real>
double AngleTo(Vec3<Real> got, Vec3<Exact> exact) {
  return Length((got.template To<Exact>() - exact).template To<double>());
}

// Rays against one primitive, with the hits of a kernel.
template <typename Real>
struct Traced {
  CompiledScene<Real> scene;
  Tree<Real> tree;
  RayStream<Real> rays;
  HitStream<Real> hits;
  std::uint32_t count;

  Traced(const decltype(Object::shape)& shape, const std::vector<Ray<float>>& from,
         const Kernels<Real>& kernels)
      : count(static_cast<std::uint32_t>(from.size())) {
    Scene one;
    one.materials.push_back({});
    one.objects.push_back({"", shape, 0});
    scene = CompileScene<Real>(one);
    tree = std::move(BuildTree<Real>(scene.geometry(), 1)).value();
    rays.Allocate(count), hits.Allocate(count);
    const auto out = rays.output();
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto o = from[i].origin.To<Real>(), d = from[i].direction.To<Real>();
      out.origin_x[i] = o.x, out.origin_y[i] = o.y, out.origin_z[i] = o.z;
      out.direction_x[i] = d.x, out.direction_y[i] = d.y, out.direction_z[i] = d.z;
      out.source[i] = kNoPrimitive;
    }
    kernels.trace_closest(tree.view(), rays.view(), {}, count, Coherence::kUnknown, hits.output());
  }

  bool Hits(std::uint32_t i) const { return hits.view().primitive[i] != kNoPrimitive; }

  // Calls `make(batch, surfaces)` for all rays that hit, then `judge(ray, normal)` for each.
  template <typename Make, typename Judge>
  void ForEachNormal(Make make, Judge judge) const {
    AlignedArray<std::uint32_t> ray, zero;
    ray.Allocate(StreamCapacity(count)), zero.Allocate(StreamCapacity(count));
    std::uint32_t n = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      zero[i] = 0;
      if (Hits(i)) ray[n++] = i;
    }
    if (n == 0) return;
    SurfaceStream<Real> surfaces;
    surfaces.Allocate(n);
    make(HitBatch{ray.data(), zero.data(), zero.data(), n}, surfaces.output());
    const auto view = surfaces.view();
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec3<Real> normal{view.normal_x[i], view.normal_y[i], view.normal_z[i]};
      const bool inside = (view.source[i] & kInsideBit) != 0;
      judge(ray[i], inside ? -normal : normal);
    }
  }
};

constexpr std::uint32_t kRaysEach = 256;

// At 1 to 10^6 radii; half of the rays pass within 1 % of the rim, a quarter within 1e-5 of it.
template <typename Real>
void MeasureSpheres(const Kernels<Real>& kernels, Measured& measured) {
  Random random(60);
  for (int round = 0; round < 140; ++round) {
    const double distance = std::pow(10.0, round % 7) + Uniform(random, 0, 1);
    const Vec3<float> center = ToVec3(UniformPoint(random, -10, 10)).To<float>();
    const float radius = static_cast<float>(std::exp2(Uniform(random, -6, 6)));
    std::vector<Ray<float>> rays;
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const double low[] = {0, 0.99, 0, 1 - 1e-5}, high[] = {1, 1, 1, 1 + 1e-5};
      const double miss = radius * Uniform(random, low[i % 4], high[i % 4]);
      const Vec3<double> axis = RandomUnit(random);
      const Vec3<double> side = Normalize(Cross(axis, RandomUnit(random)));
      const Vec3<double> origin = center.To<double>() + axis * (radius * distance);
      const Vec3<double> direction = center.To<double>() + side * miss - origin;
      rays.push_back({origin.To<float>(), (direction * Uniform(random, 0.1, 2)).To<float>()});
    }
    const Traced<Real> traced(Sphere{{center.x, center.y, center.z}, radius}, rays, kernels);
    std::vector<Vec3<Exact>> normals(kRaysEach);
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const ExactLine line(rays[i], center, radius);
      const auto roots = line.Roots();
      // What 16 wide roundoffs of a strict float test leave open (docs/numerics.md).
      const Exact r = radius, slack = 16 * 0x1p-53 * r * (line.f_length + r);
      const bool in_doubt = Abs(r * r - line.l2) <= slack;
      measured.spheres_in_doubt += in_doubt;
      if (!in_doubt) measured.spheres_misjudged += traced.Hits(i) != roots.has_value();
      if (!traced.Hits(i) || !roots) continue;
      const Exact t = traced.hits.view().u[i] == 0 ? roots->near : roots->far;
      measured.sphere_t.Add(UlpsOff(traced.hits.view().t[i], t));
      normals[i] =
          Unit(rays[i].origin.To<Exact>() + rays[i].direction.To<Exact>() * t - center.To<Exact>());
    }
    traced.ForEachNormal(
        [&](const HitBatch& batch, const SurfaceOutput<Real>& surfaces) {
          kernels.surfaces_of(PrimitiveKind::kSphere)(traced.scene.geometry(), traced.rays.view(),
                                                      traced.hits.view(), batch, kNeedsAll,
                                                      surfaces);
        },
        [&](std::uint32_t i, Vec3<Real> normal) {
          if (Dot(normals[i], normals[i]) == 0) return;  // a miss that counted as a hit
          measured.sphere_normal.Add(AngleTo(normal, normals[i]));
        });
  }
}

// At 1 to 10^6 radii; half of the rays come as near as 1e-7 of a radian to the plane, half of them
// pass within 1e-5 of the rim.
template <typename Real>
void MeasureDisks(const Kernels<Real>& kernels, Measured& measured) {
  Random random(64);
  for (int round = 0; round < 140; ++round) {
    const OneDisk disk = AnyDisk(random);
    const auto rays = RaysAt(random, disk, std::pow(10.0, round % 7));
    const Vec3<float> c = disk.center, n = disk.normal;
    const Traced<Real> traced(Disk{{c.x, c.y, c.z}, disk.radius, {n.x, n.y, n.z}}, rays, kernels);
    std::vector<ExactDiskHit> exact;
    for (std::uint32_t i = 0; i < traced.count; ++i) {
      exact.emplace_back(rays[i], disk);
      if (exact[i].is_parallel || exact[i].is_in_doubt) continue;
      measured.disks_misjudged += traced.Hits(i) != exact[i].is_hit;
      if (!traced.Hits(i) || !exact[i].is_hit) continue;
      measured.disk_t.Add(UlpsOff(traced.hits.view().t[i], exact[i].t));
    }
    traced.ForEachNormal(
        [&](const HitBatch& batch, const SurfaceOutput<Real>& surfaces) {
          kernels.surfaces_of(PrimitiveKind::kDisk)(traced.scene.geometry(), traced.rays.view(),
                                                    traced.hits.view(), batch, kNeedsAll, surfaces);
        },
        [&](std::uint32_t i, Vec3<Real> normal) {
          measured.disk_normal.Add(AngleTo(normal, exact[i].normal));
        });
  }
}

// No needles, and hits at a cosine of 1/2 or more. What is rounded are vertices as seen from the
// origin, so t counts in ULP times the path over their reach, barycentrics in roundoffs of the
// reach over the longest edge.
template <typename Real>
void MeasureTriangles(const Kernels<Real>& kernels, Measured& measured) {
  Random random(61);
  for (int round = 0; round < 600; ++round) {
    const double size = std::exp2(Uniform(random, -8, 4));
    const Vec3<double> centre = ToVec3(UniformPoint(random, -1, 1));
    Vec3<float> v[3];
    for (auto& p : v) p = (centre + ToVec3(UniformPoint(random, -size, size))).To<float>();
    const Vec3<double> ab = (v[1] - v[0]).To<double>(), ac = (v[2] - v[0]).To<double>();
    const double longest = std::max({Length(ab), Length(ac), Length(ac - ab)});
    if (Length(Cross(ab, ac)) < 0.1 * longest * longest) continue;
    std::vector<Ray<float>> rays;
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const double away = std::exp2(Uniform(random, -2, 8));
      const Vec3<float> origin = (centre + RandomUnit(random) * (size * away)).To<float>();
      double w[3] = {Uniform(random, 0, 1), Uniform(random, 0, 1), Uniform(random, 0, 1)};
      if (i % 2) w[i / 2 % 3] = Uniform(random, -1e-6, 1e-6);
      const double sum = w[0] + w[1] + w[2];
      const Vec3<double> target =
          (v[0].To<double>() * w[0] + v[1].To<double>() * w[1] + v[2].To<double>() * w[2]) *
          (1 / sum);
      rays.push_back({origin, (target - origin.To<double>()).To<float>()});
    }
    Triangle shape;
    for (int k = 0; k < 3; ++k) shape.vertices[k] = {v[k].x, v[k].y, v[k].z};
    const Traced<Real> traced(shape, rays, kernels);
    const auto hits = traced.hits.view();
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const ExactPlaneHit exact = IntersectExactly(rays[i], v);
      if (exact.cosine < 0.5) continue;
      measured.triangles_misjudged += traced.Hits(i) != exact.is_inside;
      if (!traced.Hits(i)) continue;
      const Vec3<double> origin = rays[i].origin.To<double>();
      const double path = Length(exact.point.To<double>() - origin);
      double reach = path;
      for (const Vec3<float> p : v) reach = std::max(reach, Length(p.To<double>() - origin));
      measured.triangle_t.Add(UlpsOff(hits.t[i], exact.t) * path / reach);
      const double scale = longest / (reach * static_cast<double>(kRoundoff<Real>));
      measured.barycentrics.Add(scale * static_cast<double>(Abs(Exact(hits.u[i]) - exact.u)));
      measured.barycentrics.Add(scale * static_cast<double>(Abs(Exact(hits.v[i]) - exact.v)));
    }
    traced.ForEachNormal(
        [&](const HitBatch& batch, const SurfaceOutput<Real>& surfaces) {
          kernels.surfaces_of(PrimitiveKind::kTriangle)(traced.scene.geometry(), traced.rays.view(),
                                                        traced.hits.view(), batch, kNeedsAll,
                                                        surfaces);
        },
        [&](std::uint32_t i, Vec3<Real> normal) {
          measured.triangle_normal.Add(AngleTo(normal, IntersectExactly(rays[i], v).normal));
        });
  }
}

// A surface at the origin.
template <typename Real>
void PutSurface(const SurfaceOutput<Real>& out, std::uint32_t i, Vec3<float> normal,
                Vec3<float> direction, std::uint32_t source) {
  const auto n = normal.To<Real>(), d = direction.To<Real>();
  out.normal_x[i] = n.x, out.normal_y[i] = n.y, out.normal_z[i] = n.z;
  out.face_x[i] = n.x, out.face_y[i] = n.y, out.face_z[i] = n.z;
  out.direction_x[i] = d.x, out.direction_y[i] = d.y, out.direction_z[i] = d.z;
  out.position_x[i] = out.position_y[i] = out.position_z[i] = 0;
  out.u[i] = out.v[i] = out.offset[i] = 0;
  out.source[i] = source, out.ray[i] = i;
}

// Glass of index 1.1 to 2.5 from both sides; half of the rays inside come within 1e-6 of the
// critical angle. The two errors are of rays farther than that, where 1e-3 < cos_t^2.
template <typename Real>
void MeasureInterfaces(const Kernels<Real>& kernels, Measured& measured) {
  Random random(62);
  for (int round = 0; round < 200; ++round) {
    const bool inside = round % 2;
    MaterialData<Real> glass{};
    glass.ior = static_cast<Real>(static_cast<float>(Uniform(random, 1.1, 2.5)));
    for (auto& channel : glass.transmit) channel = 1;
    glass.needs = NeedsOf(glass);
    SurfaceStream<Real> surfaces;
    surfaces.Allocate(kRaysEach);
    const auto out = surfaces.output();
    std::vector<Vec3<float>> normals, directions;
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const Vec3<double> n = RandomUnit(random);
      Vec3<double> d = RandomUnit(random);
      if (Dot(n, d) > 0) d = -d;
      if (inside && i % 2) {
        const double sin = (1 + Uniform(random, -1e-6, 1e-6)) / static_cast<double>(glass.ior);
        const Vec3<double> side = Normalize(Cross(n, d));
        d = side * sin - n * std::sqrt(1 - sin * sin);
      }
      normals.push_back(n.To<float>()), directions.push_back(d.To<float>());
      PutSurface(out, i, normals[i], directions[i], inside ? kInsideBit : 0);
    }
    RayStream<Real> reflected, refracted;
    PathStream<Real> parents, reflected_paths, refracted_paths;
    reflected.Allocate(kRaysEach), refracted.Allocate(kRaysEach), parents.Allocate(kRaysEach);
    reflected_paths.Allocate(kRaysEach), refracted_paths.Allocate(kRaysEach);
    auto none = parents.view();
    none.throughput_r = none.throughput_g = none.throughput_b = nullptr;
    const SpawnCounts counts =
        kernels.spawn_rays(glass, surfaces.view(), kRaysEach, none, 0, reflected.output(),
                           reflected_paths.output(), refracted.output(), refracted_paths.output());
    std::vector<int> refracted_of(kRaysEach, -1);
    for (std::uint32_t i = 0; i < counts.refracted; ++i) {
      refracted_of[refracted_paths.view().parent[i]] = static_cast<int>(i);
    }
    std::vector<Exact> reflectance(kRaysEach, 0);
    for (std::uint32_t i = 0; i < counts.reflected; ++i) {
      reflectance[reflected_paths.view().parent[i]] = reflected_paths.view().throughput_r[i];
    }
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const auto n = normals[i].To<Exact>(), d = directions[i].To<Exact>();
      const Exact eta = inside ? Exact(glass.ior) : 1 / Exact(glass.ior);
      const Exact c = -Dot(n, d), k = 1 - eta * eta * (1 - c * c);
      const bool passes = refracted_of[i] >= 0;
      measured.reflections_misjudged += passes != (k > 0);
      if (!passes || k < 1e-3) continue;
      const Exact ct = Sqrt(k);
      const Exact s = (eta * c - ct) / (eta * c + ct), p = (c - eta * ct) / (c + eta * ct);
      measured.reflectance.Add(static_cast<double>(Abs(reflectance[i] - (s * s + p * p) / 2)));
      const auto rays = refracted.view();
      const int at = refracted_of[i];
      measured.refracted.Add(
          AngleTo(Vec3<Real>{rays.direction_x[at], rays.direction_y[at], rays.direction_z[at]},
                  Unit(d * eta + n * (eta * c - ct))));
    }
  }
}

// A highlight of weight 1 from a distant light, for exponents of 1 to 1000.
template <typename Real>
void MeasureHighlights(const Kernels<Real>& kernels, Measured& measured) {
  Random random(63);
  // g++ 12 widens a float that it still has as a double to 113 bits without rounding it first; from
  // an array it cannot.
  std::vector<Vec3<float>> lights;
  while (lights.size() < 200) lights.push_back(RandomUnit(random).To<float>());
  for (const Vec3<float> to_light : lights) {
    const float shininess = static_cast<float>(std::pow(10.0, Uniform(random, 0, 3)));
    MaterialData<Real> material{};
    material.ks = 1, material.shininess = shininess;
    material.needs = NeedsOf(material);
    LightData<Real> light{};
    light.kind = LightKind::kDirectional;
    light.falloff[0] = 1;
    for (int axis = 0; axis < 3; ++axis) light.vector[axis] = to_light[axis], light.rgb[axis] = 1;
    SurfaceStream<Real> surfaces;
    ColourStream<Real> colours;
    IncidenceStream<Real> incidence;
    surfaces.Allocate(kRaysEach), colours.Allocate(kRaysEach), incidence.Allocate(kRaysEach);
    AlignedArray<std::uint32_t> lit;
    lit.Allocate(StreamCapacity(kRaysEach));
    const auto out = surfaces.output();
    std::vector<double> exact;
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      const Vec3<double> d = RandomUnit(random);
      const Vec3<double> half = Normalize(to_light.To<double>() - d);
      // Where there is something to be seen.
      const double spread = 3 / std::sqrt(static_cast<double>(shininess));
      const Vec3<float> n =
          Normalize(half + RandomUnit(random) * Uniform(random, 0, spread)).To<float>();
      const Vec3<float> direction = d.To<float>();
      PutSurface(out, i, n, direction, 0);
      colours.output().r[i] = colours.output().g[i] = colours.output().b[i] = 0;
      const Exact cosine = Dot(n.To<Exact>(), Unit(to_light.To<Exact>() - direction.To<Exact>()));
      const long double base = std::clamp(static_cast<long double>(cosine), 0.0L, 1.0L);
      exact.push_back(static_cast<double>(std::pow(base, static_cast<long double>(shininess))));
      lit[i] = 1;
      const IncidenceOutput<Real> meets = incidence.output();
      meets.x[i] = to_light.x, meets.y[i] = to_light.y, meets.z[i] = to_light.z;
      meets.cosine[i] = 0, meets.falloff[i] = 1;  // the first is for diffuse light
    }
    kernels.shade_light(light, material, surfaces.view(), incidence.view(), lit.data(), {},
                        kRaysEach, colours.output());
    for (std::uint32_t i = 0; i < kRaysEach; ++i) {
      measured.highlight.Add(std::abs(static_cast<double>(colours.view().r[i]) - exact[i]));
    }
  }
}

template <typename Real>
Measured Measure(const Kernels<Real>& kernels) {
  Measured measured;
  MeasureSpheres(kernels, measured);
  MeasureDisks(kernels, measured);
  MeasureTriangles(kernels, measured);
  MeasureInterfaces(kernels, measured);
  MeasureHighlights(kernels, measured);
  return measured;
}

std::string Describe(const std::string& name, const Measured& m) {
  const auto pair = [](const Errors& e) {
    return fmt::format("{:.3g} ({:.2g})", e.worst, e.mean());
  };
  return fmt::format(
      "| {} | {} | {} of {} | {} | {} | {} of {} | {} | {} | {} | {} of {} | {} | {} | {} | {} | "
      "{} |",
      name, pair(m.sphere_t), m.spheres_misjudged, m.sphere_t.count, pair(m.sphere_normal),
      pair(m.disk_t), m.disks_misjudged, m.disk_t.count, pair(m.disk_normal), pair(m.triangle_t),
      pair(m.barycentrics), m.triangles_misjudged, m.triangle_t.count, pair(m.triangle_normal),
      pair(m.reflectance), pair(m.refracted), m.reflections_misjudged, pair(m.highlight));
}

TEST_CASE("errors by arithmetic and target") {
  const Measured in_double = Measure(StrictKernels<double>(0));
  std::vector<Measured> strict;
  std::string table;
  ForEachTarget([&](Target target) {
    strict.push_back(Measure(StrictKernels<float>(target.id())));
    CHECK(strict.back() == strict.front());
    const Measured fast = Measure(FastKernels(target.id()));
    table += Describe("fast, " + target.name(), fast) + "\n";
    // No promises are made for it: that it is no worse than its documentation says.
    CHECK(fast.sphere_t.worst < 200);
    CHECK(fast.sphere_normal.mean() < 0.01);
    CHECK(fast.disk_t.mean() < 1.2e5);
    CHECK(fast.disk_normal.worst <= 1e-7);
    CHECK(fast.triangle_t.worst <= 8);
    CHECK(fast.refracted.worst < 1e-5);
    CHECK(fast.highlight.worst < 3e-4);
  });
  const Measured& m = strict.front();
  MESSAGE("\n", Describe("double", in_double), "\n", Describe("strict", m), "\n", table);
  // The promises of docs/numerics.md; of what it gives as measured, up to twice that.
  CHECK(m.sphere_t.worst <= 1);
  CHECK(m.spheres_misjudged == 0);
  CHECK(m.sphere_normal.worst <= 1e-7);
  CHECK(m.disk_t.worst <= 1);
  CHECK(m.disks_misjudged == 0);
  CHECK(m.disk_normal.worst <= 1e-7);
  CHECK(m.triangle_t.worst <= 8);
  CHECK(m.triangle_normal.worst <= 1e-7);
  CHECK(m.barycentrics.worst <= 20);
  CHECK(m.triangles_misjudged <= 7650);
  CHECK(m.reflectance.worst <= 2.4e-5);
  CHECK(m.reflectance.mean() <= 4.2e-8);
  CHECK(m.refracted.worst <= 6e-6);
  CHECK(m.refracted.mean() <= 1e-7);
  CHECK(m.reflections_misjudged <= 768);
  CHECK(m.highlight.worst <= 2.4e-4);
  CHECK(m.highlight.mean() <= 5.2e-6);
  CHECK(in_double.spheres_misjudged == 0);
  CHECK(in_double.sphere_normal.worst <= 4.6e-9);
  CHECK(in_double.disk_t.worst <= 3.4);
  CHECK(in_double.disks_misjudged == 0);
  CHECK(in_double.disk_normal.worst <= 3.4e-16);
  CHECK(in_double.triangle_t.worst <= 8);
  CHECK(in_double.triangle_normal.worst <= 5e-16);
  CHECK(in_double.barycentrics.worst <= 13);
  CHECK(in_double.triangles_misjudged == 0);
  CHECK(in_double.reflectance.worst <= 6e-14);
  CHECK(in_double.refracted.worst <= 1.4e-14);
  CHECK(in_double.reflections_misjudged == 0);
  CHECK(in_double.highlight.worst <= 4e-13);
}

}  // namespace
}  // namespace sheaf
