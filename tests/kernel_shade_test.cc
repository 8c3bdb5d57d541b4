// The camera, surface, shading and spawning kernels against src/scalar, bit by bit, on every
// target.
#include <cmath>
#include <limits>

#include "bits.h"
#include "random_scene.h"
#include "simd/query.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "src/scalar/camera_ray.h"
#include "src/scalar/shadow_ray.h"
#include "src/scalar/spawn.h"
#include "src/scalar/trace.h"
#include "targets.h"

namespace sheaf {
namespace {

using scalar::Ray;
using scalar::Surface;
using sheaf::SameBits;

template <typename Real>
bool SameBits(Vec3<Real> a, Real x, Real y, Real z) {
  return SameBits(a.x, x) && SameBits(a.y, y) && SameBits(a.z, z);
}

// Rays that all hit primitive `index` of their kind, with their surfaces by the specification.
template <typename Real>
struct HitSample {
  std::vector<Ray<Real>> rays;
  std::vector<scalar::Hit<Real>> hits;
  std::vector<std::uint32_t> index;
  std::vector<Surface<Real>> surfaces;
};

template <typename Real>
HitSample<Real> SampleHits(Random& random, const CompiledScene<Real>& scene, PrimitiveKind kind,
                           std::uint32_t count) {
  HitSample<Real> sample;
  const auto geometry = scene.geometry();
  while (sample.rays.size() < count) {
    const Vec3d o = UniformPoint(random, -3, 3);
    const Ray<Real> ray{Vec3<double>{o.x, o.y, o.z}.To<Real>(), RandomUnit(random).To<Real>()};
    const auto hit = scalar::TraceClosest(geometry, ray);
    if (hit.primitive == kNoPrimitive) continue;
    const PrimitiveInfo& info = scene.objects.primitives[hit.primitive];
    if (info.kind() != kind) continue;
    sample.rays.push_back(ray);
    sample.hits.push_back(hit);
    sample.index.push_back(info.index());
    sample.surfaces.push_back(scalar::SurfaceAt(ray, hit, geometry, info.place));
  }
  return sample;
}

template <typename Real>
void Fill(SurfaceStream<Real>& stream, const std::vector<Surface<Real>>& surfaces) {
  stream.Allocate(static_cast<std::uint32_t>(surfaces.size()));
  const auto out = stream.output();
  for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
    const Surface<Real>& s = surfaces[i];
    out.position_x[i] = s.position.x, out.position_y[i] = s.position.y,
    out.position_z[i] = s.position.z;
    out.shadow_x[i] = s.shadow_end.x, out.shadow_y[i] = s.shadow_end.y;
    out.shadow_z[i] = s.shadow_end.z, out.bend[i] = s.bend;
    out.normal_x[i] = s.normal.x, out.normal_y[i] = s.normal.y, out.normal_z[i] = s.normal.z;
    out.face_x[i] = s.face.x, out.face_y[i] = s.face.y, out.face_z[i] = s.face.z;
    out.tint_r[i] = s.tint.x, out.tint_g[i] = s.tint.y, out.tint_b[i] = s.tint.z;
    out.direction_x[i] = s.direction.x, out.direction_y[i] = s.direction.y;
    out.direction_z[i] = s.direction.z;
    out.u[i] = s.u, out.v[i] = s.v, out.offset[i] = s.offset, out.source[i] = s.source;
    out.ray[i] = i;
  }
}

// Surfaces as a material with these needs may meet them: with faces and tints of their own where
// it asks for them.
template <typename Real>
std::vector<Surface<Real>> RandomSurfaces(Random& random, std::uint32_t count,
                                          std::uint32_t needs) {
  std::vector<Surface<Real>> surfaces;
  while (surfaces.size() < count) {
    Surface<Real> s;
    const Vec3d p = UniformPoint(random, -5, 5);
    s.position = s.shadow_end = Vec3<double>{p.x, p.y, p.z}.To<Real>();
    s.direction = RandomUnit(random).To<Real>();
    s.normal = RandomUnit(random).To<Real>();
    if (Dot(s.normal, s.direction) > 0) s.normal = -s.normal;
    if (random() % 8 == 0) s.normal = -s.direction;
    s.face = s.normal;
    if ((needs & kNeedsNormals) && random() % 4 != 0) {
      s.face = RandomUnit(random).To<Real>();
      if (Dot(s.face, s.direction) > 0) s.face = -s.face;
      if (Dot(s.face, s.normal) < 0) s.normal = -s.normal;
      s.shadow_end = s.position + RandomUnit(random).To<Real>() * Real(0.1);
      s.bend = static_cast<Real>(Uniform(random, 0, 0.5));
    }
    if (needs & kNeedsTint) {
      const Vec3d tint = UniformPoint(random, 0, 1);
      s.tint = Vec3<double>{tint.x, tint.y, tint.z}.To<Real>();
    }
    s.u = static_cast<Real>(Uniform(random, 0, 1));
    s.v = static_cast<Real>(random() % 8 == 0 ? 0.5 : Uniform(random, 0, 1));
    s.offset = static_cast<Real>(Uniform(random, 0, 1e-5));
    s.source = static_cast<std::uint32_t>(random() % 7) | (random() % 2 ? kInsideBit : 0);
    surfaces.push_back(s);
  }
  return surfaces;
}

template <typename Real>
MaterialData<Real> RandomMaterial(Random& random) {
  const auto real = [&](double low, double high) {
    return static_cast<Real>(Uniform(random, low, high));
  };
  MaterialData<Real> m{};
  m.kind = random() % 2 ? BaseColour::kChecker : BaseColour::kConstant;
  const bool transmits = random() % 2, reflects = random() % 2;
  for (int i = 0; i < 3; ++i) {
    m.even[i] = real(0, 1), m.ambient[i] = real(0, 0.5), m.emission[i] = real(0, 0.1);
    m.odd[i] = m.kind == BaseColour::kChecker ? real(0, 1) : m.even[i];
    m.reflect[i] = reflects ? real(0, 1) : Real(0);
    m.transmit[i] = transmits ? real(0, 1) : Real(0);
  }
  m.cells[0] = real(1, 20), m.cells[1] = 10;
  m.kd = real(0, 1);
  m.ks = random() % 4 ? real(0, 1) : Real(0);
  const Real shininess[] = {0, 1, 25, 200, 1e6, Real(11.1434)};
  m.shininess = shininess[random() % 6];
  const Real ior[] = {1, 1.5, Real(0.7), 2.4f};
  m.ior = ior[random() % 4];
  m.needs = random() % 2 ? NeedsOf(m) : kNeedsAll;
  return m;
}

template <typename Real>
LightData<Real> RandomLight(Random& random, LightKind kind) {
  LightData<Real> light{};
  light.kind = kind;
  const Vec3d p = UniformPoint(random, -30, 30);
  const auto unit = RandomUnit(random).To<Real>();
  for (int i = 0; i < 3; ++i) {
    light.vector[i] = kind == LightKind::kDirectional ? unit[i] : static_cast<Real>(p[i]);
    light.rgb[i] = static_cast<Real>(Uniform(random, 0, 100));
    light.falloff[i] = static_cast<Real>(random() % 2 ? Uniform(random, 0, 1) : 0);
  }
  if (kind == LightKind::kDirectional || light.falloff[2] == 0) light.falloff[0] = 1;
  light.casts_shadows = 1;
  if (kind != LightKind::kDirectional && random() % 2) {
    const auto axis = RandomUnit(random).To<Real>();
    light.is_spot = 1;
    for (int i = 0; i < 3; ++i) light.axis[i] = axis[i];
    light.cone_scale = static_cast<Real>(Uniform(random, 1, 4));
    light.cone_offset = static_cast<Real>(Uniform(random, -2, 1));
  }
  return light;
}

constexpr LightKind kLightKinds[] = {LightKind::kPointFromLight, LightKind::kPointFromSurface,
                                     LightKind::kDirectional};
constexpr std::uint32_t kCounts[] = {1, 2, 3, 5, 7, 8, 9, 15, 16, 17, 31, 32, 33, 200};

TEST_CASE_TEMPLATE("primary rays", Real, float, double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.look_at = {-0.25, -1, -10};
    for (const bool orthographic : {false, true}) {
      if (orthographic) camera.projection = Orthographic{4.0};
      const CameraData<Real> data = CompileCamera<Real>(camera, 640, 479);
      for (const std::uint32_t count : kCounts) {
        RayStream<Real> rays;
        rays.Allocate(count);
        AlignedArray<Real> x, y;
        x.Allocate(StreamCapacity(count)), y.Allocate(StreamCapacity(count));
        for (std::uint32_t i = 0; i < count; ++i) {
          x[i] = static_cast<Real>(i * 37 % 640), y[i] = static_cast<Real>(i * 53 % 479);
        }
        const Real sx = Real(0.5), sy = Real(0.3);
        kernels.generate_primary(data, x.data(), y.data(), sx, sy, {}, count, rays.output());
        const auto got = rays.view();
        for (std::uint32_t i = 0; i < count; ++i) {
          const Ray<Real> want = scalar::CameraRay(data, x[i], y[i], sx, sy);
          REQUIRE(SameBits(want.origin, got.origin_x[i], got.origin_y[i], got.origin_z[i]));
          REQUIRE(
              SameBits(want.direction, got.direction_x[i], got.direction_y[i], got.direction_z[i]));
        }
      }
    }
  });
}

TEST_CASE_TEMPLATE("surfaces", Real, float, double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Random random(4);
    Scene described = RandomScene(random, 24);
    described.materials[0].base_colour = Checker{};
    described.objects.push_back({"mesh", RandomMesh(random, 12), 0});
    const CompiledScene<Real> scene = CompileScene<Real>(described);
    const auto geometry = scene.geometry();
    for (const PrimitiveKind kind : {PrimitiveKind::kSphere, PrimitiveKind::kTriangle}) {
      for (const std::uint32_t count : kCounts) {
        const HitSample<Real> sample = SampleHits(random, scene, kind, count);
        RayStream<Real> rays;
        HitStream<Real> hits;
        SurfaceStream<Real> surfaces;
        rays.Allocate(count), hits.Allocate(count), surfaces.Allocate(count);
        AlignedArray<std::uint32_t> ray, index, primitive;
        for (auto* list : {&ray, &index, &primitive}) list->Allocate(StreamCapacity(count));
        // The batch lists its rays backwards; what lies past its end must not be followed.
        for (std::uint32_t i = 0; i < StreamCapacity(count); ++i) ray[i] = index[i] = 0x7ffffff0;
        for (std::uint32_t i = 0; i < count; ++i) {
          const auto out = rays.output();
          const auto hit = hits.output();
          out.origin_x[i] = sample.rays[i].origin.x;
          out.origin_y[i] = sample.rays[i].origin.y;
          out.origin_z[i] = sample.rays[i].origin.z;
          out.direction_x[i] = sample.rays[i].direction.x;
          out.direction_y[i] = sample.rays[i].direction.y;
          out.direction_z[i] = sample.rays[i].direction.z;
          hit.t[i] = sample.hits[i].t, hit.u[i] = sample.hits[i].u, hit.v[i] = sample.hits[i].v;
          ray[i] = count - 1 - i;
          index[i] = sample.index[count - 1 - i];
          primitive[i] = sample.hits[count - 1 - i].primitive;
        }
        const HitBatch batch{ray.data(), index.data(), primitive.data(), count};
        kernels.surfaces_of(kind)(geometry, rays.view(), hits.view(), batch, kNeedsAll,
                                  surfaces.output());
        if (kind == PrimitiveKind::kTriangle) {
          kernels.blend_vertices(geometry.triangles, hits.view(), batch, kNeedsAll,
                                 surfaces.output());
        }
        const auto got = surfaces.view();
        for (std::uint32_t i = 0; i < count; ++i) {
          const Surface<Real>& want = sample.surfaces[ray[i]];
          REQUIRE(SameBits(want.position, got.position_x[i], got.position_y[i], got.position_z[i]));
          REQUIRE(SameBits(want.normal, got.normal_x[i], got.normal_y[i], got.normal_z[i]));
          REQUIRE(
              SameBits(want.direction, got.direction_x[i], got.direction_y[i], got.direction_z[i]));
          if (kind == PrimitiveKind::kTriangle) {
            REQUIRE(SameBits(want.face, got.face_x[i], got.face_y[i], got.face_z[i]));
            REQUIRE(SameBits(want.shadow_end, got.shadow_x[i], got.shadow_y[i], got.shadow_z[i]));
            REQUIRE(SameBits(want.bend, got.bend[i]));
            REQUIRE(SameBits(want.tint, got.tint_r[i], got.tint_g[i], got.tint_b[i]));
          }
          REQUIRE(SameBits(want.u, got.u[i]));
          REQUIRE(SameBits(want.v, got.v[i]));
          REQUIRE(SameBits(want.offset, got.offset[i]));
          REQUIRE(want.source == got.source[i]);
          REQUIRE(got.ray[i] == ray[i]);
        }
      }
    }
  });
}

TEST_CASE_TEMPLATE("ambient light, facing, shadow rays and direct light", Real, float, double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Random random(5);
    for (int round = 0; round < 60; ++round) {
      const std::uint32_t count = kCounts[round % 14];
      LightData<Real> light = RandomLight<Real>(random, kLightKinds[round % 3]);
      const MaterialData<Real> material = RandomMaterial<Real>(random);
      const auto want = RandomSurfaces<Real>(random, count, material.needs);
      // So near to a surface, or so far away, that the square is no normal number.
      const Real tiny = std::sqrt(std::numeric_limits<Real>::min()) / 8;
      if (round % 5 == 1) {
        for (Real& number : light.vector) number = static_cast<Real>(Uniform(random, 1, 9)) / tiny;
      }
      SurfaceStream<Real> surfaces;
      Fill(surfaces, want);
      ColourStream<Real> colours;
      RayStream<Real> rays;
      IncidenceStream<Real> incidences;
      colours.Allocate(count), rays.Allocate(count), incidences.Allocate(count);
      AlignedArray<std::uint32_t> faces, surface_of_ray;
      faces.Allocate(StreamCapacity(count)), surface_of_ray.Allocate(StreamCapacity(count));

      kernels.shade_ambient(material, surfaces.view(), count, colours.output());
      const std::uint32_t facing = kernels.face_light(light, material, surfaces.view(), {}, count,
                                                      faces.data(), incidences.output());
      const std::uint32_t shadows = kernels.generate_shadow(
          light, surfaces.view(), {}, faces.data(), count, rays.output(), surface_of_ray.data());
      REQUIRE(shadows == facing);
      // Every third surface that faces the light is in shadow.
      for (std::uint32_t i = 0; i < count; i += 3) faces[i] = 0;
      kernels.shade_light(light, material, surfaces.view(), incidences.view(), faces.data(), {},
                          count, colours.output());

      std::uint32_t ray = 0;
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto base = scalar::BaseColourAt<Real>(material, {}, want[i]);
        const bool shows = scalar::HasLocalLight(material, want[i]);
        Vec3<Real> colour{0, 0, 0};
        if (shows) colour = scalar::AmbientLight(material, base);
        const auto incidence = scalar::IncidenceOf(light, want[i]);
        if (shows && incidence.reaches) {
          REQUIRE(ray < shadows);
          const Ray<Real> shadow = scalar::ShadowRay(light, want[i], incidence);
          const auto got = rays.view();
          REQUIRE(surface_of_ray[ray] == i);
          REQUIRE(SameBits(shadow.origin, got.origin_x[ray], got.origin_y[ray], got.origin_z[ray]));
          REQUIRE(SameBits(shadow.direction, got.direction_x[ray], got.direction_y[ray],
                           got.direction_z[ray]));
          REQUIRE(shadow.source == got.source[ray]);
          ++ray;
          if (i % 3 != 0)
            colour = colour + scalar::LitBy(light, material, want[i], base, incidence);
        }
        REQUIRE(SameBits(colour, colours.view().r[i], colours.view().g[i], colours.view().b[i]));
      }
      REQUIRE(ray == shadows);
    }
  });
}

template <typename Real>
void CheckChildren(const std::vector<scalar::Path<Real>>& want,
                   const std::vector<std::uint32_t>& parent, std::uint32_t count,
                   const RayView<Real>& rays, const PathView<Real>& paths) {
  REQUIRE(count == want.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    REQUIRE(SameBits(want[i].ray.origin, rays.origin_x[i], rays.origin_y[i], rays.origin_z[i]));
    REQUIRE(SameBits(want[i].ray.direction, rays.direction_x[i], rays.direction_y[i],
                     rays.direction_z[i]));
    REQUIRE(want[i].ray.source == rays.source[i]);
    REQUIRE(parent[i] == paths.parent[i]);
    REQUIRE(SameBits(want[i].throughput[0], paths.throughput_r[i]));
    REQUIRE(SameBits(want[i].throughput[1], paths.throughput_g[i]));
    REQUIRE(SameBits(want[i].throughput[2], paths.throughput_b[i]));
  }
}

TEST_CASE_TEMPLATE("reflection and refraction", Real, float, double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Random random(6);
    for (int round = 0; round < 60; ++round) {
      const std::uint32_t count = kCounts[round % 14];
      const MaterialData<Real> material = RandomMaterial<Real>(random);
      const auto surfaces = RandomSurfaces<Real>(random, count, material.needs);
      SurfaceStream<Real> stream;
      Fill(stream, surfaces);
      PathStream<Real> parents, reflected_paths, refracted_paths;
      RayStream<Real> reflected, refracted;
      for (auto* paths : {&parents, &reflected_paths, &refracted_paths}) paths->Allocate(count);
      reflected.Allocate(count), refracted.Allocate(count);
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto weights = parents.output();
        weights.throughput_r[i] = static_cast<Real>(Uniform(random, 0, 1));
        weights.throughput_g[i] = static_cast<Real>(Uniform(random, 0, 1));
        weights.throughput_b[i] = 0;
      }
      auto view = parents.view();
      if (round % 2) view.throughput_r = view.throughput_g = view.throughput_b = nullptr;
      const Real min_throughput = round % 3 ? Real(0) : Real(0.25);
      const SpawnCounts counts = kernels.spawn_rays(
          material, stream.view(), count, view, min_throughput, reflected.output(),
          reflected_paths.output(), refracted.output(), refracted_paths.output());

      std::vector<scalar::Path<Real>> want_reflected, want_refracted;
      std::vector<std::uint32_t> parent_of_reflected, parent_of_refracted;
      for (std::uint32_t i = 0; i < count; ++i) {
        Real weight[3] = {1, 1, 1};
        if (round % 2 == 0)
          weight[0] = view.throughput_r[i], weight[1] = view.throughput_g[i], weight[2] = 0;
        const auto spawned = scalar::Spawn(material, surfaces[i], weight);
        if (spawned.reflected.counts(min_throughput)) {
          want_reflected.push_back(spawned.reflected);
          parent_of_reflected.push_back(i);
        }
        if (spawned.refracted.counts(min_throughput)) {
          want_refracted.push_back(spawned.refracted);
          parent_of_refracted.push_back(i);
        }
      }
      CheckChildren<Real>(want_reflected, parent_of_reflected, counts.reflected, reflected.view(),
                          reflected_paths.view());
      CheckChildren<Real>(want_refracted, parent_of_refracted, counts.refracted, refracted.view(),
                          refracted_paths.view());
    }
  });
}

}  // namespace
}  // namespace sheaf
