// Disks at a distance, along their planes, from their own surface, in one place and of every size.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "sheaf/geometry.h"
#include "simd/query.h"
#include "src/lab/probe.h"
#include "src/lab/ray_cases.h"
#include "src/lab/stress_cases.h"

namespace sheaf::stress {
namespace {

struct DiskFields {
  Vec center{0, 0, 0};
  float radius = 1;
  Vec normal{0, 0, 1};
};

void AddDisk(Shapes& shapes, const DiskFields& disk) {
  const auto& [center, radius, normal] = disk;
  shapes.AddMore(PrimitiveKind::kDisk,
                 {center.x, center.y, center.z, radius, normal.x, normal.y, normal.z});
}

Shapes OneDisk(const DiskFields& disk) {
  Shapes shapes;
  AddDisk(shapes, disk);
  return shapes;
}

// A unit vector in the plane of the disk, but for rounding.
Vec Along(Random& random, const DiskFields& disk) {
  return Normalize(Cross(disk.normal, random.Direction()));
}

DiskFields AnyDisk(Random& random) {
  DiskFields disk;
  disk.center = random.InBox(4);
  disk.radius = random.In(0.5f, 2);
  disk.normal = random.Direction() * random.In(0.5f, 2);
  return disk;
}

// Where a ray's line meets a disk's plane, in long double: the squared distance from the centre in
// squared radii, and t.
struct Meeting {
  long double square, t;
};

Meeting MeetPlane(const DiskFields& disk, const Ray& ray) {
  using Long = long double;
  const auto n = disk.normal.To<Long>(), d = ray.direction.To<Long>();
  const auto from = ray.origin.To<Long>() - disk.center.To<Long>();
  const Long t = -Dot(n, from) / Dot(n, d);
  const auto l = from + d * t;
  const Long r = static_cast<Long>(disk.radius);
  return {Dot(l, l) / (r * r), t};
}

// Holds the rays at one disk to long double, but for those that pass within `band` of the rim, in
// squared radii: what is hit, and t to an ULP.
struct Judged {
  int hits = 0, misses = 0;
};

Judged ExpectExact(Report& report, const DiskFields& disk, const std::vector<Ray>& rays,
                   long double band) {
  const std::vector<Hit> hits = TraceEverywhere(report, OneDisk(disk), rays);
  Judged judged;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Meeting exact = MeetPlane(disk, rays[i]);
    if (!(std::abs(exact.square - 1) > band)) continue;
    const bool is_hit = exact.square < 1 && exact.t > 0;
    report.Expect(IsHit(hits[i]) == is_hit, "misjudged", &rays[i]);
    ++(is_hit ? judged.hits : judged.misses);
    if (!is_hit || !IsHit(hits[i])) continue;
    const double error = UlpsOff(hits[i].t, static_cast<double>(exact.t));
    report.Expect(error <= 1, fmt::format("t is {:.3g} ULP off", error), &rays[i]);
  }
  return judged;
}

}  // namespace

void DiskRims(Report& report) {
  Random random(14);
  for (int power = 0; power <= 6; ++power) {
    const DiskFields disk = AnyDisk(random);
    const double distance = std::pow(10.0, power);
    std::vector<Ray> rays;
    while (rays.size() < 400) {
      const Vec away = random.Direction();
      if (std::abs(Dot(away, disk.normal)) < 0.05f) continue;
      // Far away a direction of float misses the point by more: what counts is where it passes.
      const float aim = disk.radius * (rays.size() % 2 ? 0.999f : 1.001f);
      const Vec target = disk.center + Along(random, disk) * aim;
      rays.push_back(Towards(target + away * (static_cast<float>(distance) * disk.radius), target));
    }
    // docs/numerics.md, "Disks".
    const long double band = 16 * 0x1p-53L * (static_cast<long double>(distance) + 8);
    const auto [hits, misses] = ExpectExact(report, disk, rays, band);
    report.Expect(hits > 50 && misses > 50 && hits + misses > 390,
                  "rays that pass on one side alone, or in doubt");
  }
}

void GrazingDisks(Report& report) {
  Random random(15);
  int hits = 0;
  for (int i = 0; i < (report.is_thorough() ? 2000 : 200); ++i) {
    const DiskFields disk = AnyDisk(random);
    // As steep as this, at last in the plane but for what rounding leaves.
    const float steep = i % 9 == 8 ? 0 : std::pow(10.0f, -static_cast<float>(i % 9));
    std::vector<Ray> rays;
    for (int k = 0; k < 50; ++k) {
      const Vec target = disk.center + Along(random, disk) * (disk.radius * random.In(0, 1.5f));
      const Vec away = Along(random, disk) + disk.normal * steep;
      rays.push_back(Towards(target + away * random.In(1, 9), target));
    }
    hits += ExpectExact(report, disk, rays, 1e-6L).hits;
  }
  report.Expect(hits > 3000, fmt::format("only {} hits", hits));
}

void InDiskPlane(Report& report) {
  Random random(16);
  // Planes that hold their rays exactly: small integers.
  const Vec normals[] = {{0, 0, 1}, {0, -1, 0}, {2, 0, 0}, {1, 1, 0}, {0, -2, 1}, {1, 1, 1}};
  for (const Vec normal : normals) {
    const DiskFields disk{{1, 2, 3}, 2, normal};
    const auto integer = [&] { return std::floor(random.In(-8, 9)); };
    const auto in_plane = [&] {
      const float x = integer(), y = integer(), z = integer();
      return Cross(normal, Vec{x, y, z});
    };
    std::vector<Ray> rays;
    while (rays.size() < 200) {
      const Vec direction = in_plane(), origin = disk.center + in_plane();
      if (Dot(direction, direction) == 0) continue;
      rays.push_back({origin, direction});
      rays.push_back({origin + normal, direction});
      rays.push_back(Towards(origin, disk.center));  // no direction where it is the centre itself
    }
    ExpectAllMiss(report, OneDisk(disk), rays);
  }
}

void DiskSources(Report& report) {
  Random random(17);
  for (int i = 0; i < 20; ++i) {
    // A second disk behind the first, which is the source of all rays.
    const DiskFields near = AnyDisk(random);
    DiskFields far = near;
    far.center = near.center - near.normal * 0.25f;
    far.radius = 4 * near.radius;
    Shapes both = OneDisk(near);
    AddDisk(both, far);
    std::vector<Ray> back, front, any;
    for (int k = 0; k < 100; ++k) {
      const Vec at = near.center + Along(random, near) * (near.radius * random.In(0, 0.9f));
      // On the disk, but for rounding, and clearly in front of it: through it all the same.
      const Vec origin = k % 2 ? at : at + near.normal * random.In(0, 0.5f);
      const std::uint32_t source = k % 4 < 2 ? 0 : kInsideBit;
      const Vec down = Along(random, near) * random.In(0, 0.5f) - near.normal;
      back.push_back({origin, down, source});
      front.push_back({origin, -down, source});
      any.push_back({at + near.normal, at - (at + near.normal)});
    }
    ExpectAllMiss(report, OneDisk(near), back);
    ExpectAllMiss(report, OneDisk(near), front);
    ExpectAllHit(report, OneDisk(near), any);
    const std::vector<Hit> hits = TraceEverywhere(report, both, back);
    for (std::size_t k = 0; k < hits.size(); ++k) {
      report.Expect(hits[k].primitive == 1, "not the disk behind", &back[k]);
    }
  }
}

void DiskSizes(Report& report) {
  for (const float r : {1e-18f, 1e-9f, 1e-3f, 1.0f, 1e6f, 1e12f}) {
    const DiskFields disk{{r, 2 * r, -r}, r, {0, 0, 1}};
    const auto down = [&](float x) { return Ray{{x, 2 * r, 4 * r}, {0, 0, -r}}; };
    const double t = (4 * static_cast<double>(r) + static_cast<double>(r)) / static_cast<double>(r);
    for (const float inside : {r, 1.999f * r, 0.001f * r}) {
      ExpectHit(report, OneDisk(disk), down(inside), 0, t, 1);
    }
    ExpectAllMiss(report, OneDisk(disk), {down(2.001f * r), down(-0.001f * r)});
    // Of no size, in the same place and on the ray.
    ExpectAllMiss(report, OneDisk({disk.center, 0, {0, 0, 1}}), {down(r)});
    ExpectAllMiss(report, OneDisk({disk.center, -0.0f, {1, 0, 2}}), {down(r)});
  }
  const std::array<float, 7> wrong[] = {
      {0, 0, 0, -1, 0, 0, 1}, {0, 0, 0, kInfinity, 0, 0, 1}, {0, 0, 0, kNan, 0, 0, 1},
      {0, 0, 0, 1, 0, 0, 0},  {0, 0, 0, 1, 0, kNan, 1},      {kNan, 0, 0, 1, 0, 0, 1},
  };
  for (const auto& fields : wrong) {
    GeometryInput input;
    input.AddDisks(fields);
    report.Expect(!Geometry::Build(input),
                  fmt::format("a disk of {} is accepted", fmt::join(fields, ", ")));
  }
}

void CoplanarDisks(Report& report) {
  Shapes shapes;
  shapes.AddTriangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  for (int copy = 0; copy < 12; ++copy) {
    // More than a leaf of them, with normals to either side.
    AddDisk(shapes, {{0.25f, 0.25f, 0}, 2, {0, 0, copy % 2 ? 1.0f : -3.0f}});
  }
  AddDisk(shapes, {{4, 0, 0}, 4, {0, 0, 1}});
  ExpectHit(report, shapes, {{0.25f, 0.25f, 3}, {0, 0, -1}}, 0, 3, 0);
  ExpectHit(report, shapes, {{0.25f, 0.25f, -3}, {0, 0, 1}}, 0, 3, 0);
  ExpectHit(report, shapes, {{-0.25f, 0.5f, 3}, {0, 0, -1}}, 1, 3, 0);
  ExpectHit(report, shapes, {{-0.25f, 0.5f, -3}, {0, 0, 1}}, 1, 3, 0);
  ExpectHit(report, shapes, {{1.5f, 0.25f, 3}, {0, 0, -1}}, 1, 3, 0);  // the last one is there too
  ExpectHit(report, shapes, {{7, 0.25f, 3}, {0, 0, -1}}, 13, 3, 0);
}

}  // namespace sheaf::stress
