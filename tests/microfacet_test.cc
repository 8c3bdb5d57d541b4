// Rough surfaces: facets are drawn as often as they are seen, and no light is lost.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bits.h"
#include "random_scene.h"
#include "simd/kernels.h"
#include "src/render/compile_gloss.h"
#include "src/scalar/spawn.h"
#include "src/stream/stream.h"
#include "targets.h"

namespace sheaf {
namespace {

using scalar::Surface;

Surface<double> SeenAt(double cosine, std::uint32_t source = 0) {
  Surface<double> surface{};
  surface.normal = surface.face = {0, 0, 1};
  surface.direction = {0, -std::sqrt(1 - cosine * cosine), -cosine};
  surface.source = source;
  return surface;
}

// The density of GGX's visible normals: G1(o) max(0, o.m) D(m) / cos o. The mean of a function
// over drawn facets is its integral against that, taken here on a grid.
TEST_CASE("facets are drawn by the density of visible normals") {
  for (const double alpha : {0.1, 0.5, 1.0}) {
    for (const double cosine : {0.15, 0.6, 1.0}) {
      const Surface<double> surface = SeenAt(cosine);
      const Vec3<double> o = -surface.direction;
      double mean[3] = {};
      constexpr std::uint32_t kDraws = 1 << 14;
      for (std::uint32_t i = 0; i < kDraws; ++i) {
        const auto m = scalar::DrawFacet(alpha, surface, scalar::DrawSample<double>(9, i, 1));
        REQUIRE(Dot(m, o) > -1e-9);
        mean[0] += m.y / kDraws, mean[1] += m.z / kDraws, mean[2] += m.x * m.x / kDraws;
      }
      double want[3] = {}, all = 0;
      constexpr int kGrid = 1500;
      for (int a = 0; a < kGrid; ++a) {
        // By the tangent, on which the slopes' density is even.
        const double s = (a + 0.5) / kGrid, tangent = alpha * std::sqrt(s / (1 - s));
        const double z = 1 / std::sqrt(1 + tangent * tangent), r = z * tangent;
        for (int b = 0; b < 256; ++b) {
          const double phi = (b + 0.5) * 2 * 3.14159265358979323846 / 256;
          const Vec3<double> m{r * std::cos(phi), r * std::sin(phi), z};
          // Drawn by D(m) cos m, so what is left is max(0, o.m) / cos m, up to a factor.
          const double weight = std::max(0.0, Dot(o, m)) / z;
          all += weight;
          want[0] += weight * m.y, want[1] += weight * m.z, want[2] += weight * m.x * m.x;
        }
      }
      CAPTURE(alpha);
      CAPTURE(cosine);
      for (int k = 0; k < 3; ++k) CHECK(mean[k] == doctest::Approx(want[k] / all).epsilon(0.003));
    }
  }
}

// A white furnace: all that arrives at a surface that takes nothing leaves it.
TEST_CASE("rough mirrors and glass lose no light over roughness, index and angle") {
  GlossTables<double> tables;
  double worst = 0;
  for (const double roughness : {0.05, 0.2, 0.4, 0.6, 0.8, 1.0}) {
    for (const double ior : {0.0, 1.1, 1.5, 2.4}) {  // 0: a mirror
      MaterialData<double> material{};
      material.slope_width = roughness * roughness;
      material.ior = ior > 0 ? ior : 1;
      for (int i = 0; i < 3; ++i) (ior > 0 ? material.transmit : material.reflect)[i] = 1;
      material.gloss = tables.TableOf(material);
      for (const std::uint32_t source : {0u, kInsideBit}) {
        for (const double cosine : {0.05, 0.3, 0.5, 0.77, 1.0}) {
          Surface<double> surface = SeenAt(cosine, source);
          surface.gloss = scalar::GlossAt(material, surface);
          double sum = 0;
          constexpr std::uint32_t kDraws = 1 << 14;
          const double white[3] = {1, 1, 1};
          for (std::uint32_t i = 0; i < kDraws; ++i) {
            surface.facet = scalar::DrawFacet(material.slope_width, surface,
                                              scalar::DrawSample<double>(77, i, 3));
            const auto spawned = scalar::Spawn(material, surface, white);
            sum += spawned.reflected.throughput[0] + spawned.refracted.throughput[0];
          }
          const double lost = std::abs(sum / kDraws - 1);
          CAPTURE(roughness);
          CAPTURE(ior);
          CAPTURE(source);
          CAPTURE(cosine);
          CHECK(lost < 1e-3);
          worst = std::max(worst, lost);
        }
      }
    }
  }
  MESSAGE("largest loss or gain: " << worst);
}

// Between the rows of the table for slopes of any width, too.
TEST_CASE("mirrors whose roughness varies lose no light") {
  GlossTables<double> tables;
  MaterialData<double> material{};
  material.finish.is_glossy = material.finish.has_facets = true;
  material.ior = 1;
  for (double& share : material.reflect) share = 1;
  material.gloss = tables.TableOf(material);
  double worst = 0;
  for (const double roughness : {0.0, 0.01, 0.09, 0.2, 0.33, 0.47, 0.6, 0.72, 0.85, 0.97, 1.0}) {
    material.slope_width = roughness * roughness;
    for (const double cosine : {0.05, 0.3, 0.5, 0.77, 1.0}) {
      Surface<double> surface = SeenAt(cosine);
      surface.gloss = scalar::GlossAt(material, surface);
      double sum = 0;
      constexpr std::uint32_t kDraws = 1 << 14;
      const double white[3] = {1, 1, 1};
      for (std::uint32_t i = 0; i < kDraws; ++i) {
        surface.facet =
            scalar::DrawFacet(material.slope_width, surface, scalar::DrawSample<double>(77, i, 3));
        sum += scalar::Spawn(material, surface, white).reflected.throughput[0];
      }
      CAPTURE(roughness);
      CAPTURE(cosine);
      CHECK(std::abs(sum / kDraws - 1) < 3e-3);
      worst = std::max(worst, std::abs(sum / kDraws - 1));
    }
  }
  MESSAGE("largest loss or gain: " << worst);
}

TEST_CASE_TEMPLATE("facets and gloss have the bits of the specification on every target", Real,
                   float, double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Random random(8);
    GlossTables<Real> tables;
    for (const std::uint32_t count : {1u, 5u, 8u, 16u, 17u, 200u}) {
      MaterialData<Real> material{};
      material.slope_width = static_cast<Real>(Uniform(random, 0.001, 1));
      material.ior = Real(1.5);
      material.transmit[0] = 1;
      if (count % 2 == 0) {  // widths vary
        material.needs = kNeedsTerms;
        material.finish.is_glossy = material.finish.has_facets = true;
      }
      material.gloss = tables.TableOf(material);
      SurfaceStream<Real> stream;
      SampleStream<Real> points;
      stream.Allocate(count), points.Allocate(count);
      std::vector<Surface<Real>> surfaces(count);
      const auto out = stream.output();
      for (std::uint32_t i = 0; i < count; ++i) {
        Surface<Real>& s = surfaces[i];
        s.normal = RandomUnit(random).To<Real>();
        s.direction = RandomUnit(random).To<Real>();
        // Shading normals may face away, some rays arrive head on.
        if (i % 4 != 0 && Dot(s.normal, s.direction) > 0) s.normal = -s.normal;
        if (i % 7 == 0) s.direction = -s.normal;
        s.source = random() % 2 ? kInsideBit : 3;
        out.normal_x[i] = s.normal.x, out.normal_y[i] = s.normal.y, out.normal_z[i] = s.normal.z;
        out.direction_x[i] = s.direction.x, out.direction_y[i] = s.direction.y;
        out.direction_z[i] = s.direction.z, out.source[i] = s.source;
        out.slope_width[i] = static_cast<Real>(i % 5 == 0 ? i % 2 : Uniform(random, 0, 1));
        points.output().u[i] = static_cast<Real>(Uniform(random, 0, 1));
        points.output().v[i] = static_cast<Real>(random() % 9 ? Uniform(random, 0, 1) : 0);
      }
      kernels.draw_facets(material, stream.view(), points.view(), count, out);
      for (std::uint32_t i = 0; i < count; ++i) {
        const scalar::SamplePoint<Real> point{points.view().u[i], points.view().v[i]};
        MaterialData<Real> here = material;
        if (material.needs & kNeedsTerms) here.slope_width = out.slope_width[i];
        const auto facet = scalar::DrawFacet(here.slope_width, surfaces[i], point);
        REQUIRE(SameBits(facet.x, out.facet_x[i]));
        REQUIRE(SameBits(facet.y, out.facet_y[i]));
        REQUIRE(SameBits(facet.z, out.facet_z[i]));
        REQUIRE(SameBits(scalar::GlossAt(here, surfaces[i]), out.gloss[i]));
      }
    }
  });
}

}  // namespace
}  // namespace sheaf
