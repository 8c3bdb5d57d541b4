// What rays stand for on surfaces, and what checkers and textures show there: against sums of
// many samples, and bit by bit on every target.
#include "src/scalar/footprint.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "bits.h"
#include "random_scene.h"
#include "same_bits.h"
#include "simd/kernels.h"
#include "src/render/build_mip_chain.h"
#include "src/scalar/filter_checker.h"
#include "src/scalar/sample_texture.h"
#include "src/scalar/shade.h"
#include "src/scalar/sphere_coordinates.h"
#include "src/scalar/trace.h"
#include "src/scene/srgb.h"
#include "targets.h"
#include "test_frames.h"

namespace sheaf {
namespace {

constexpr std::uint32_t kCounts[] = {1, 2, 3, 7, 8, 9, 16, 17, 33, 200};

TEST_CASE("the mean of a square wave") {
  Random random(1);
  const auto wave = [](double x) { return x - 2 * std::floor(x / 2) < 1 ? 1.0 : -1.0; };
  for (int i = 0; i < 200; ++i) {
    const double x = Uniform(random, -9, 9);
    const double width = std::exp(Uniform(random, -7, 4));
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) sum += wave(x + width * ((k + 0.5) / kSteps - 0.5));
    CHECK(scalar::MeanOfSquareWave(x, width) ==
          doctest::Approx(sum / kSteps).epsilon(1e-3).scale(1));
  }
  CHECK(scalar::MeanOfSquareWave(0.25f, 0.0f) == 1);
  CHECK(scalar::MeanOfSquareWave(-0.25f, 0.0f) == -1);
  CHECK(scalar::MeanOfSquareWave(10000.5f, 1e-30f) == 1);
  CHECK(scalar::MeanOfSquareWave(1.0e4f, 1e-30f) == 0);  // half of it on either side of an edge
  for (const float endless : {1024.0f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    CHECK(scalar::MeanOfSquareWave(0.3f, endless) == 0);
  }
}

// The mean of an image in linear light.
Vec3<double> MeanLight(const std::vector<std::uint32_t>& texels, std::size_t first,
                       std::size_t count) {
  Vec3<double> sum = {0, 0, 0};
  for (std::size_t i = first; i < first + count; ++i) {
    const auto light = [&](int shift) { return SrgbDecode((texels[i] >> shift & 255) / 255.0); };
    sum = sum + Vec3<double>{light(0), light(8), light(16)};
  }
  return sum / static_cast<double>(count);
}

Image RandomImage(Random& random, int width, int height) {
  Image image{"", width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    image.texels.push_back(static_cast<std::uint32_t>(random()));
  }
  return image;
}

TEST_CASE("levels halve the sides, and each has the image's mean") {
  Random random(2);
  const int sizes[][2] = {{1, 1}, {2, 1}, {1, 5}, {3, 3}, {7, 5}, {64, 32}, {33, 100}, {255, 3}};
  for (const auto& [width, height] : sizes) {
    CAPTURE(width);
    CAPTURE(height);
    const Image image = RandomImage(random, width, height);
    const MipChain chain = BuildMipChain(image, Transfer::kSrgb);
    const auto mean = MeanLight(image.texels, 0, image.texels.size());
    std::size_t first = 0;
    int w = width, h = height;
    for (int level = 1; level < chain.level_count; ++level) {
      w = std::max(w / 2, 1), h = std::max(h / 2, 1);
      REQUIRE(chain.levels.width[level] == w);
      REQUIRE(chain.levels.height[level] == h);
      REQUIRE(static_cast<std::size_t>(chain.levels.first[level]) == first);
      const auto count = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
      const auto got = MeanLight(chain.texels, first, count);
      // A byte of sRGB is at most 0.009 of light, and rounding errs by half of it.
      for (int c = 0; c < 3; ++c)
        CHECK(got[c] == doctest::Approx(mean[c]).epsilon(0.0045).scale(1));
      first += count;
    }
    CHECK(w == 1);
    CHECK(h == 1);
    CHECK(first == chain.texels.size());
  }
}

TEST_CASE("levels of one colour are that colour") {
  for (const Transfer transfer : {Transfer::kSrgb, Transfer::kLinear}) {
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t texel = byte | (255 - byte) << 8 | byte / 2 << 16 | byte << 24;
      const Image image{"", 7, 5, std::vector<std::uint32_t>(35, texel)};
      for (const std::uint32_t got : BuildMipChain(image, transfer).texels) REQUIRE(got == texel);
    }
  }
}

TEST_CASE("a footprint's level is near its logarithm") {
  for (double s = 0.25; s < 5000; s *= 1.01) {
    const auto mix = scalar::LevelsFor(static_cast<float>(s), 1024.0f);
    const double want = std::clamp(std::log2(s), 0.0, 10.0);
    CHECK(mix.share >= 0);
    CHECK(mix.share < 1);
    const double got = mix.level + static_cast<double>(mix.share);
    CHECK(std::abs(got - want) < 0.09);
  }
  const auto widest = scalar::LevelsFor(std::nanf(""), 8.0f);
  CHECK(widest.level == 3);
  CHECK(widest.share == 0);
}

// Where neighbouring rays of the cone's edge land, in u and v.
TEST_CASE("footprints are what neighbouring rays span") {
  Random random(3);
  Scene described;
  described.materials.push_back({});
  described.materials[0].base_colour = Checker{Colour(1.0), Colour(0.0), {4, 4}, true};
  described.objects = {{"", Sphere{{0, 0, 0}, 2}, 0},
                       {"", Disk{{6, 0, 0}, 2, {0.3, 0.5, 0.8}}, 0},
                       {"", Triangle{{Vec3d(-9, -2, 0), {-5, -2, 1}, {-6, 3, 0.5}}}, 0}};
  const CompiledScene<double> scene = CompileScene<double>(described);
  const auto geometry = scene.geometry();
  const auto surface_of = [&](const scalar::Ray<double>& ray, scalar::Hit<double>& hit) {
    hit = scalar::TraceClosest(geometry, ray);
    scalar::Surface<double> surface{};
    if (hit.primitive == kNoPrimitive) return surface;
    surface = scalar::SurfaceAt(ray, hit, geometry, scene.objects.primitives[hit.primitive].place);
    if (hit.primitive == 0) scalar::PlaceOnSphere(surface);
    return surface;
  };
  int checked[3] = {};
  for (int i = 0; i < 3000; ++i) {
    const Vec3d centers[] = {{0, 0, 0}, {6, 0, 0}, {-7, -1, 0.5}};
    const Vec3d o = UniformPoint(random, -20, 20);
    const Vec3d to = centers[i % 3] + UniformPoint(random, -1, 1) - o;
    const Vec3<double> eye = ToVec3(o), d = Normalize(ToVec3(to));
    scalar::Hit<double> hit, other_hit;
    auto middle = surface_of({eye, d}, hit);
    if (hit.primitive != static_cast<std::uint32_t>(i % 3)) continue;
    constexpr double kSpread = 1e-5;
    scalar::MeasureFootprint(geometry, scene.objects.primitives[hit.primitive].place, 0.0, kSpread,
                             hit.t, middle);
    const scalar::Frame<double> across(d);
    double span_u = 0, span_v = 0;
    for (int k = 0; k < 64; ++k) {
      const double angle = k * 0.0981747704;
      const Vec3<double> aside =
          (across.x * std::cos(angle) + across.y * std::sin(angle)) * (kSpread / 2);
      const auto edge = surface_of({eye, Normalize(d + aside)}, other_hit);
      if (other_hit.primitive != hit.primitive) span_u = 1;
      span_u = std::max(span_u, 2 * std::abs(edge.u - middle.u));
      span_v = std::max(span_v, 2 * std::abs(edge.v - middle.v));
    }
    // Near edges, where rays go beside, and where coordinates bend within the footprint.
    const double facing = std::abs(Dot(middle.normal, d));
    if (span_u > 0.01 || facing < 0.1) continue;
    CHECK(middle.footprint_u == doctest::Approx(span_u).epsilon(0.02));
    CHECK(middle.footprint_v == doctest::Approx(span_v).epsilon(0.02));
    ++checked[i % 3];
  }
  for (const int count : checked) CHECK(count > 100);
}

// A stream of surfaces with coordinates and footprints, some of these without bounds.
template <typename Real>
std::vector<scalar::Surface<Real>> RandomPlaces(Random& random, std::uint32_t count,
                                                SurfaceStream<Real>& stream) {
  std::vector<scalar::Surface<Real>> places(count);
  stream.Allocate(count);
  const auto out = stream.output();
  const Real odd[] = {0, std::numeric_limits<Real>::infinity(),
                      std::numeric_limits<Real>::quiet_NaN(), 1};
  // What lies past the count must not be followed.
  std::fill_n(out.u, StreamCapacity(count), odd[2]);
  std::fill_n(out.v, StreamCapacity(count), odd[1]);
  std::fill_n(out.footprint_u, StreamCapacity(count), odd[2]);
  std::fill_n(out.footprint_v, StreamCapacity(count), odd[1]);
  for (Real* second : {out.u2, out.v2, out.footprint_u2, out.footprint_v2}) {
    std::fill_n(second, StreamCapacity(count), odd[2]);
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    scalar::Surface<Real>& place = places[i];
    const auto wide = [&] {
      return static_cast<Real>(
          std::ldexp(Uniform(random, 0.5, 1), -static_cast<int>(random() % 12)));
    };
    place.u = static_cast<Real>(Uniform(random, -3, 3));
    place.v = static_cast<Real>(random() % 8 == 0 ? 0.5 : Uniform(random, -3, 3));
    place.footprint_u = random() % 16 == 0 ? odd[random() % 4] : wide();
    place.footprint_v = random() % 16 == 0 ? odd[random() % 4] : wide();
    place.u2 = static_cast<Real>(Uniform(random, -3, 3));
    place.v2 = static_cast<Real>(Uniform(random, -3, 3));
    place.footprint_u2 = wide(), place.footprint_v2 = wide();
    place.normal = place.face = {0, 0, 1};
    out.u[i] = place.u, out.v[i] = place.v;
    out.footprint_u[i] = place.footprint_u, out.footprint_v[i] = place.footprint_v;
    out.u2[i] = place.u2, out.v2[i] = place.v2;
    out.footprint_u2[i] = place.footprint_u2, out.footprint_v2[i] = place.footprint_v2;
    out.normal_x[i] = out.normal_y[i] = 0, out.normal_z[i] = 1;
    out.source[i] = place.source = 0;
  }
  return places;
}

TEST_CASE_TEMPLATE("look-ups have the same bits on every target", Real, float, double) {
  Random random(4);
  for (int round = 0; round < 120; ++round) {
    CAPTURE(round);
    Material material;
    const Wrap wraps[] = {Wrap::kRepeat, Wrap::kMirror, Wrap::kClamp};
    const Filter filters[] = {Filter::kMip, Filter::kMip, Filter::kLinear, Filter::kNearest};
    const auto side = [&] { return 1 + static_cast<int>(random() % 40); };
    Texture texture{std::make_shared<const Image>(RandomImage(random, side(), side())),
                    random() % 2 ? Transfer::kSrgb : Transfer::kLinear, wraps[random() % 3],
                    wraps[random() % 3], filters[random() % 4]};
    if (random() % 2) texture.transform = {{0.3, -2}, {1.5, -0.7}, Uniform(random, -180, 180)};
    material.base_colour = texture;
    Scene described;
    described.materials = {material};
    const CompiledScene<Real> scene = CompileScene<Real>(described);
    TextureData<Real> data = scene.textures[0];
    data.set = random() % 2;
    const std::uint32_t count = kCounts[round % 10];
    SurfaceStream<Real> stream;
    const auto places = RandomPlaces<Real>(random, count, stream);
    ForEachTarget([&](Target target) {
      TexelStream<Real> texels;
      texels.Allocate(count);
      const auto out = texels.output();
      StrictKernels<Real>(target.id())
          .sample_texture(data, stream.view(), count, {out.r, out.g, out.b, out.alpha});
      for (std::uint32_t i = 0; i < count; ++i) {
        const Vec3<Real> want = scalar::SampleTexture(data, places[i]);
        REQUIRE(SameBits(want.x, out.r[i]));
        REQUIRE(SameBits(want.y, out.g[i]));
        REQUIRE(SameBits(want.z, out.b[i]));
        REQUIRE(SameBits(scalar::SampleAlpha(data, places[i]), out.alpha[i]));
      }
    });
  }
}

TEST_CASE_TEMPLATE("filtered checkers have the same bits on every target", Real, float, double) {
  Random random(5);
  for (const std::uint32_t count : kCounts) {
    MaterialData<Real> material{};
    material.kind = BaseColour::kFilteredChecker;
    material.cells[0] = static_cast<Real>(Uniform(random, 1, 900)), material.cells[1] = 7;
    for (int c = 0; c < 3; ++c) {
      material.even[c] = static_cast<Real>(Uniform(random, 0, 1));
      material.odd[c] = static_cast<Real>(Uniform(random, 0, 1));
      material.ambient[c] = 1;
    }
    material.needs = NeedsOf(material);
    SurfaceStream<Real> stream;
    const auto places = RandomPlaces<Real>(random, count, stream);
    ForEachTarget([&](Target target) {
      ColourStream<Real> colours;
      colours.Allocate(count);
      StrictKernels<Real>(target.id())
          .shade_ambient(material, stream.view(), count, colours.output());
      for (std::uint32_t i = 0; i < count; ++i) {
        const auto want = scalar::AmbientLight(material, scalar::PatternAt(material, places[i]));
        REQUIRE(SameBits(want.x, colours.view().r[i]));
        REQUIRE(SameBits(want.y, colours.view().g[i]));
        REQUIRE(SameBits(want.z, colours.view().b[i]));
      }
    });
  }
}

// Filtered checkers and textures on all shapes, seen by mirrors and through glass.
TEST_CASE("frames with footprints have the same bits on every target") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    Scene scene = EverythingScene(seed);
    Random random(seed);
    const auto image = std::make_shared<const Image>(RandomImage(random, 37, 64));
    for (Material& material : scene.materials) {
      if (auto* checker = std::get_if<Checker>(&material.base_colour)) {
        checker->is_filtered = true;
        checker->cells *= 20;
      } else if (random() % 2) {
        material.base_colour = Texture{image};
      }
    }
    scene.materials[0].metallic_roughness = {Texture{image, Transfer::kLinear}, 0.9, 0.8};
    scene.materials[2].normal_map = {Texture{image, Transfer::kLinear}, 0.4};
    scene.objects.push_back({"", Disk{{0, -3, 0}, 9, {0.1, 1, 0.2}}, 1});
    RenderOptions options;
    options.width = 61, options.height = 47;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Camera& camera : scene.cameras) CheckSameBits(scene, camera, options);
    }
    options.contrast = 0.05, options.samples = 4;
    options.precision = Precision::kStrict;
    CheckSameBits(scene, scene.cameras[0], options);
  }
}

// ---- What it is for ----

// A ground that reaches to the horizon, with cells far smaller than pixels there.
Scene Ground(const Material& material, double repeats) {
  Scene scene;
  scene.settings.ambient = Colour(1.0);
  scene.materials = {material};
  Mesh ground;
  const auto r = static_cast<float>(repeats);
  ground.positions = {{-500, 0, 500}, {500, 0, 500}, {500, 0, -500}, {-500, 0, -500}};
  ground.uv = {{0, r}, {r, r}, {r, 0}, {0, 0}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.objects = {{"ground", ground, 0}};
  scene.cameras = {{"eye", {0.3, 2, 0}, {0.9, 0.8, -10}, {0, 1, 0}, Perspective{50}}};
  return scene;
}

double ErrorAgainst(const Film& film, const Film& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    const double off = static_cast<double>(film.rgb[i]) - static_cast<double>(truth.rgb[i]);
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(film.rgb.size()));
}

struct GroundErrors {
  double filtered, bare;
};

// Of one sample a pixel against 256 samples without filters.
GroundErrors ErrorsOf(Scene bare, Scene filtered) {
  RenderOptions options;
  options.width = 160, options.height = 120;
  options.samples = 256;
  const Film truth = RenderOrFail(bare, bare.cameras[0], options);
  options.samples = 1;
  return {ErrorAgainst(RenderOrFail(filtered, filtered.cameras[0], options), truth),
          ErrorAgainst(RenderOrFail(bare, bare.cameras[0], options), truth)};
}

TEST_CASE("a filtered checker does not alias towards the horizon") {
  Material material;
  material.ambient = 1;
  material.base_colour = Checker{Colour(0.9), Colour(0.1), {1000, 1000}, false};
  const Scene bare = Ground(material, 1);
  std::get<Checker>(material.base_colour).is_filtered = true;
  const GroundErrors errors = ErrorsOf(bare, Ground(material, 1));
  MESSAGE("root mean square error: ", errors.bare, " bare, ", errors.filtered, " filtered");
  CHECK(errors.bare > 0.1);
  CHECK(errors.filtered < 0.25 * errors.bare);
}

TEST_CASE("a texture with levels does not alias towards the horizon") {
  Random random(7);
  Material material;
  material.ambient = 1;
  Texture texture{std::make_shared<const Image>(RandomImage(random, 64, 64))};
  texture.filter = Filter::kLinear;
  material.base_colour = texture;
  const Scene bare = Ground(material, 100);
  texture.filter = Filter::kMip;
  material.base_colour = texture;
  const GroundErrors errors = ErrorsOf(bare, Ground(material, 100));
  MESSAGE("root mean square error: ", errors.bare, " bare, ", errors.filtered, " with levels");
  CHECK(errors.bare > 0.05);
  CHECK(errors.filtered < 0.6 * errors.bare);
}

TEST_CASE("a textured plane far away is its mean, in a mirror too") {
  Random random(8);
  Material material;
  material.ambient = 1;
  const Image image = RandomImage(random, 64, 64);
  material.base_colour = Texture{std::make_shared<const Image>(image)};
  // A pixel covers some twenty images.
  Scene scene = Ground(material, 100);
  const auto mean = MeanLight(image.texels, 0, image.texels.size());
  RenderOptions options;
  options.width = options.height = 8;
  const auto check = [&](const Camera& camera) {
    const Film film = RenderOrFail(scene, camera, options);
    for (int c = 0; c < 3; ++c) {
      CHECK(film.pixel(4, 4)[c] == doctest::Approx(mean[c]).epsilon(0.0045).scale(1));
    }
  };
  const Camera above{"above", {3, 1e5, 0}, {3, 0, 0}, {0, 0, 1}, Perspective{1}};
  check(above);
  Material mirror;
  mirror.reflect = Colour(1.0);
  scene.materials.push_back(mirror);
  scene.objects.push_back({"", Disk{{3, -1e5, 0}, 1e4, {0, 1, 0}}, 1});
  // From below the ground, by way of the mirror.
  check({"below", {3, -10, 0}, {3, -1e5, 0}, {0, 0, 1}, Perspective{1}});
}

}  // namespace
}  // namespace sheaf
