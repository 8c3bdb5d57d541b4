#include "bench/make_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/core/even_bits.h"
#include "src/core/strict_tan.h"
#include "src/core/vec3.h"

namespace sheaf::bench {
namespace {
using Vec = Vec3<double>;

// A shadow ray ends this part of its length before the point it is meant for.
constexpr float kShadowEnd = 1 - 1e-4f;
// Secondary rays start this part of the scene's extent above the surface.
constexpr double kStartOffset = 1e-5;

void Put(const RayOutput<float>& rays, std::uint32_t i, Vec origin, Vec direction) {
  rays.origin_x[i] = static_cast<float>(origin.x);
  rays.origin_y[i] = static_cast<float>(origin.y);
  rays.origin_z[i] = static_cast<float>(origin.z);
  rays.direction_x[i] = static_cast<float>(direction.x);
  rays.direction_y[i] = static_cast<float>(direction.y);
  rays.direction_z[i] = static_cast<float>(direction.z);
}

Vec Vertex(const BenchScene& scene, std::uint32_t triangle, int vertex) {
  const float* p = &scene.vertices[3 * std::size_t{scene.indices[3 * triangle + vertex]}];
  return {p[0], p[1], p[2]};
}

Vec FacingNormal(const BenchScene& scene, std::uint32_t primitive, Vec point, Vec direction) {
  Vec normal;
  if (primitive < scene.triangle_count()) {
    const Vec a = Vertex(scene, primitive, 0);
    normal = Cross(Vertex(scene, primitive, 1) - a, Vertex(scene, primitive, 2) - a);
  } else {
    const float* sphere = &scene.spheres[4 * std::size_t{primitive - scene.triangle_count()}];
    normal = point - Vec{sphere[0], sphere[1], sphere[2]};
  }
  normal = Normalize(normal);
  return Dot(normal, direction) > 0 ? -normal : normal;
}

// The longest side of the box around everything that rays may start on.
double Extent(const BenchScene& scene) {
  double extent = 0;
  for (int axis = 0; axis < 3; ++axis) {
    double lower = HUGE_VAL, upper = -HUGE_VAL;
    auto include = [&](double low, double high) {
      lower = std::min(lower, low);
      upper = std::max(upper, high);
    };
    for (std::size_t i = axis; i < scene.vertices.size(); i += 3) {
      include(scene.vertices[i], scene.vertices[i]);
    }
    for (std::size_t i = 0; i < scene.spheres.size(); i += 4) {
      const double center = scene.spheres[i + axis], radius = scene.spheres[i + 3];
      include(center - radius, center + radius);
    }
    extent = std::max(extent, upper - lower);
  }
  return extent;
}

// A point of the unit sphere, uniformly by rejection: no libm, the same everywhere.
Vec HashedUnitVector(std::uint64_t key) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    auto signed_unit = [&](std::uint64_t axis) {
      return 2 * HashUnit((key << 8) + 4 * attempt + axis) - 1;
    };
    const Vec p{signed_unit(0), signed_unit(1), signed_unit(2)};
    const double length_squared = Dot(p, p);
    if (length_squared > 1e-6 && length_squared <= 1) return Normalize(p);
  }
}

}  // namespace

const char* NameOf(RayKind kind) {
  switch (kind) {
    case RayKind::kPrimary:
      return "primary";
    case RayKind::kShadow:
      return "shadow";
    case RayKind::kMirror:
      return "mirror";
    case RayKind::kDiffuse:
      return "diffuse";
  }
  return "";
}

RayBatch PrimaryRays(const BenchScene& scene, std::uint32_t size) {
  RayBatch batch;
  batch.count = size * size;
  batch.stream.Allocate(batch.count);
  const Vec eye = FromArray(scene.eye).To<double>();
  const Vec forward = Normalize(FromArray(scene.look_at).To<double>() - eye);
  const Vec right = Normalize(Cross(forward, FromArray(scene.up).To<double>()));
  const Vec up = Cross(right, forward);
  const double half_side = StrictTanDegrees(scene.fov / 2.0);
  for (std::uint32_t i = 0; i < batch.count; ++i) {
    const double x = (EvenBits(i) + 0.5) / size, y = (EvenBits(i >> 1) + 0.5) / size;
    Put(batch.stream.output(), i, eye,
        Normalize(forward + right * (half_side * (2 * x - 1)) + up * (half_side * (1 - 2 * y))));
  }
  return batch;
}

RayBatch SecondaryRays(const BenchScene& scene, RayKind kind, const RayBatch& primary,
                       std::span<const float> t, std::span<const std::uint32_t> primitive) {
  RayBatch batch;
  batch.stream.Allocate(primary.count);
  const RayOutput<float> out = batch.stream.output();
  const RayView<float> in = primary.view();
  const Vec light = FromArray(scene.light).To<double>();
  const double offset = kStartOffset * Extent(scene);
  if (kind == RayKind::kShadow) {
    batch.intervals.all_t_max = kShadowEnd;
  } else {
    batch.intervals.all_t_min = static_cast<float>(offset);
  }
  for (std::uint32_t i = 0; i < primary.count; ++i) {
    if (primitive[i] == kNoPrimitive) continue;
    const Vec origin{in.origin_x[i], in.origin_y[i], in.origin_z[i]};
    const Vec direction{in.direction_x[i], in.direction_y[i], in.direction_z[i]};
    const Vec point = origin + direction * static_cast<double>(t[i]);
    const Vec normal = FacingNormal(scene, primitive[i], point, direction);
    switch (kind) {
      case RayKind::kPrimary:
      case RayKind::kShadow:
        Put(out, batch.count, light, point - light);
        break;
      case RayKind::kMirror:
        Put(out, batch.count, point + normal * offset,
            direction - normal * (2 * Dot(normal, direction)));
        break;
      case RayKind::kDiffuse:
        // A unit vector added to the normal is distributed by the cosine. The one in thousands that
        // nearly cancels the normal is as good as the normal.
        Vec bounce = normal + HashedUnitVector(i);
        if (Dot(bounce, bounce) < 1e-8) bounce = normal;
        Put(out, batch.count, point + normal * offset, Normalize(bounce));
        break;
    }
    ++batch.count;
  }
  return batch;
}

}  // namespace sheaf::bench
