// Whole pictures: against POV-Ray, against double precision, and against themselves bit by bit.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <new>
#include <random>
#include <thread>
#include <tuple>

#include "random_scene.h"
#include "same_bits.h"
#include "sheaf/render.h"
#include "src/formats/picture.h"
#include "src/formats/png.h"
#include "src/formats/quantize.h"
#include "src/formats/scene_json.h"
#include "src/lab/has_program.h"
#include "targets.h"

namespace sheaf {
namespace {

Scene CrystalBall() {
  Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  REQUIRE(scene.ok());
  return std::move(scene).value();
}

// ---- Against other arithmetic and another renderer ----

struct Difference {
  int pixels_over = 0;  // that differ by more than 1/255 in a channel
  double psnr = 0;      // dB
};

Difference Compare(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  REQUIRE(a.size() == b.size());
  Difference difference;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    int largest = 0;
    for (std::size_t channel = i; channel < i + 3; ++channel) {
      const int error = std::abs(static_cast<int>(a[channel]) - static_cast<int>(b[channel]));
      squares += error * error;
      largest = std::max(largest, error);
    }
    difference.pixels_over += largest > 1;
  }
  difference.psnr = 10 * std::log10(255.0 * 255.0 * static_cast<double>(a.size()) / squares);
  return difference;
}

void CheckClose(const std::string& camera, const std::string& oracle,
                const Difference& difference) {
  MESSAGE(camera << " against " << oracle << ": " << difference.pixels_over
                 << " pixels over 1/255, " << difference.psnr << " dB");
  CHECK(difference.pixels_over <= 12);
  CHECK(difference.psnr >= 50);
}

std::vector<std::uint8_t> RenderView(const Scene& scene, const Camera& camera,
                                     Precision precision) {
  RenderOptions options;
  options.precision = precision;
  return QuantizeTo8Bit(RenderOrFail(scene, camera, options), Transfer::kLinear);
}

std::vector<std::uint8_t> ReadPixels(const std::string& path) {
  Result<Picture8> picture = ReadPng(path);
  REQUIRE(picture.ok());
  return std::move(picture).value().rgb;
}

TEST_CASE("every view is close to double precision") {
  const Scene scene = CrystalBall();
  REQUIRE(scene.cameras.size() == 7);
  for (const Camera& camera : scene.cameras) {
    CheckClose(camera.name, "double precision",
               Compare(RenderView(scene, camera, Precision::kStrict),
                       RenderView(scene, camera, Precision::kDouble)));
  }
}

TEST_CASE("every view is close to the stored double-precision pictures") {
  const Scene scene = CrystalBall();
  for (const Camera& camera : scene.cameras) {
    CheckClose(camera.name, "the stored picture",
               Compare(RenderView(scene, camera, Precision::kStrict),
                       ReadPixels(SHEAF_SOURCE_DIR "/tests/reference/" + camera.name + ".png")));
  }
}

TEST_CASE("every view is close to POV-Ray's") {
  if (!HasProgram("povray")) {
    MESSAGE("skipped: povray is not installed");
    return;
  }
  const Scene scene = CrystalBall();
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() /
      ("sheaf-image-test-" + std::to_string(std::random_device()()));
  std::filesystem::create_directory(folder);
  for (const Camera& camera : scene.cameras) {
    const std::string picture = (folder / (camera.name + ".png")).string();
    const std::string command =
        "povray +I'" SHEAF_SOURCE_DIR
        "/tests/reference/crystal-ball.pov' +W640 +H480 -A -D +WT1 "
        "File_Gamma=1.0 Declare=EX=" +
        std::to_string(camera.eye.x) + " Declare=EY=" + std::to_string(camera.eye.y) +
        " Declare=EZ=" + std::to_string(camera.eye.z) + " +O'" + picture + "' >/dev/null 2>&1";
    REQUIRE(std::system(command.c_str()) == 0);
    CheckClose(camera.name, "POV-Ray",
               Compare(RenderView(scene, camera, Precision::kStrict), ReadPixels(picture)));
  }
  std::filesystem::remove_all(folder);
}

// Counted by an independent tracer in double precision; floats may decide a few rays differently.
TEST_CASE("ray counts at 1280x960") {
  struct Counts {
    double shadow, reflected;
  };
  const std::map<std::string, Counts> expected = {
      {"front", {1078792, 477636}}, {"up", {1166656, 322236}},   {"down", {687425, 466950}},
      {"left", {888718, 346158}},   {"right", {923242, 382194}}, {"near", {2281924, 1302936}},
      {"far", {298985, 151710}}};
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.width = 1280;
  options.height = 960;
  for (const Camera& camera : scene.cameras) {
    CAPTURE(camera.name);
    RenderStats stats;
    RenderOrFail(scene, camera, options, &stats);
    const auto near = [](std::uint64_t got, double want) {
      return std::abs(static_cast<double>(got) - want) <= 0.0005 * want;
    };
    CHECK(stats.rays.primary == 1280 * 960);
    CHECK(near(stats.rays.shadow, expected.at(camera.name).shadow));
    CHECK(near(stats.rays.reflected, expected.at(camera.name).reflected));
    CHECK(stats.rays.refracted == stats.rays.reflected);
  }
}

// ---- The same bits ----

// A scene with everything at once: several mirrors and glasses, so that several materials spawn
// rays at one depth, triangles seen from both sides, every kind of light, overlapping and
// coincident objects.
Scene EverythingScene(std::uint64_t seed) {
  Random random(seed);
  Scene scene = RandomScene(random, 14);
  const auto colour = [&] { return UniformPoint(random, 0, 1); };
  scene.materials.clear();
  for (int i = 0; i < 6; ++i) {
    Material material;
    material.name = std::to_string(i);
    if (i % 2) {
      material.base_colour = Checker{colour(), colour(), {Uniform(random, 1, 9), 5}};
    } else {
      material.base_colour = colour();
    }
    material.ambient = 0.2;
    material.kd = i == 4 ? 0 : 0.6;
    material.ks = i == 3 ? 0 : 0.4;
    material.shininess = i == 2 ? 11.1434 : 60;
    if (i == 1 || i == 4) material.reflect = colour() * 0.7;
    if (i >= 4) material.transmit = colour() * 0.8;
    material.ior = i == 4 ? 1.5 : 0.8;
    scene.materials.push_back(material);
  }
  for (Object& object : scene.objects) object.material = static_cast<std::uint32_t>(random() % 6);
  // Smooth triangles with colours: glass, and one with a texture.
  auto image = std::make_shared<Image>(Image{"", 5, 3, {}});
  for (int i = 0; i < 15; ++i) image->texels.push_back(static_cast<std::uint32_t>(random()));
  Material textured = scene.materials[0];
  textured.base_colour =
      Texture{image, Transfer::kSrgb, Wrap::kMirror, Wrap::kRepeat, Filter::kLinear, colour()};
  textured.emission = colour() * 0.1;
  scene.materials.push_back(textured);
  for (const std::uint32_t material : {6, 4}) {
    scene.objects.push_back({"", RandomMesh(random, 8), material});
  }
  scene.lights = {
      {"near", PointLight{UniformPoint(random, -6, 6), {0, 0, 1}}, {1, 1, 0.9}, 20},
      {"far", PointLight{{3000, 4000, 5000}, {1, 0, 0}}, {0.5, 0.6, 1}, 0.5},
      {"general", PointLight{{2, 7, 3}, {1, 0.1, 0.01}}, {1, 0.5, 0.5}, 1},
      {"sun", DirectionalLight{{-1, -2, -3}}, {0.3, 0.3, 0.3}, 1},
      {"soft", DirectionalLight{{1, -1, 0.5}}, {0.2, 0.2, 0.2}, 1, false},
      {"spot", PointLight{{4, 5, 6}, {0, 0, 1}, Cone{{-4, -5, -6}, 5, 30}}, {1, 1, 1}, 40}};
  scene.settings.background = {0.1, 0.2, 0.3};
  Camera camera{"eye", UniformPoint(random, 7, 9), {0, 0, 0}, {0, 1, 0}, Perspective{50}};
  Camera flat{"flat", {0, 0, 9}, {0, 0, 0}, {0, 1, 0}, Orthographic{9}};
  Camera inside{"inside", {0.1, 0.2, 0.1}, {3, 1, 0}, {0, 1, 0}, Perspective{90}};
  scene.cameras = {camera, flat, inside};
  return scene;
}

TEST_CASE("every scene of scenes/ has the same bits on every target") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SHEAF_SOURCE_DIR "/scenes")) {
    const std::string path = entry.path().string();
    if (entry.path().extension() != ".json" || entry.path().stem().extension() == ".schema")
      continue;
    CAPTURE(path);
    const Result<Scene> scene = ReadSceneJson(path);
    REQUIRE(scene.ok());
    ++scenes;
    RenderOptions options;
    options.width = 160;
    options.height = 120;
    for (const Camera& camera : scene.value().cameras) {
      CAPTURE(camera.name);
      CheckSameBits(scene.value(), camera, options);
    }
  }
  CHECK(scenes >= 1);
}

// Other bits on every target and for every tile size, but the same for every thread count.
TEST_CASE("fast pictures are close to double precision") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  std::vector<Film> exact;
  options.precision = Precision::kDouble;
  for (const Camera& camera : scene.cameras) exact.push_back(RenderOrFail(scene, camera, options));
  options.precision = Precision::kFast;
  ForEachTarget([&](Target target) {
    options.target = target;
    int over = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const Film film = RenderOrFail(scene, scene.cameras[i], options);
      CHECK(IsFinite(film));
      const Difference difference = Compare(QuantizeTo8Bit(film, Transfer::kLinear),
                                            QuantizeTo8Bit(exact[i], Transfer::kLinear));
      CHECK(difference.psnr >= 50);
      over += difference.pixels_over;
      RenderOptions one_thread = options;
      one_thread.threads = 1;
      CHECK(PixelsThatDiffer(film, RenderOrFail(scene, scene.cameras[i], one_thread)) == 0);
    }
    MESSAGE(over << " pixels of seven views over 1/255");
    CHECK(over <= 100);
    // That it was not strict.
    RenderOptions strict = options;
    strict.precision = Precision::kStrict;
    CHECK(PixelsThatDiffer(RenderOrFail(scene, scene.cameras[0], options),
                           RenderOrFail(scene, scene.cameras[0], strict)) > 0);
  });
  options.target = Target::Scalar();
  const Result<Film> refused = Render(scene, scene.cameras[0], options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.error().kind == ErrorKind::kUsage);
}

TEST_CASE("the front view at full size has the same bits on every target") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.target = Target::Scalar();
  const Film scalar = RenderOrFail(scene, scene.cameras[0], options);
  options.target = Target();
  ForEachTarget([&](Target target) {
    options.target = target;
    CHECK(PixelsThatDiffer(RenderOrFail(scene, scene.cameras[0], options), scalar) == 0);
  });
}

TEST_CASE("scenes with everything have the same bits on every target") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    const Scene scene = EverythingScene(seed);
    RenderOptions options;
    options.width = 61;
    options.height = 47;
    options.samples = seed == 2 ? 3 : 1;
    options.max_depth = seed == 3 ? 0 : 6;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Camera& camera : scene.cameras) {
        CAPTURE(camera.name);
        CheckSameBits(scene, camera, options);
      }
    }
  }
}

Scene GlassAndMirrors();

// What a scene does not need is left out; with everything forced the bits are the same.
TEST_CASE("skipping changes no bit") {
  std::vector<Scene> scenes = {CrystalBall(), EverythingScene(7)};
  // The same without one thing after the other.
  for (int without = 0; without < 5; ++without) {
    Scene scene = EverythingScene(8);
    for (Material& material : scene.materials) {
      if (without == 0) material.transmit = Colour(0.0);
      if (without == 1) material.reflect = material.transmit = Colour(0.0);
      if (without == 2) material.ks = 0;
      if (without == 3) material.kd = material.ks = 0;
      if (without == 4) material.base_colour = Colour(0.5);
    }
    scenes.push_back(scene);
  }
  for (const Scene& scene : scenes) {
    RenderOptions options;
    options.width = 80;
    options.height = 60;
    options.samples = 2;
    ForEachTarget([&](Target target) {
      options.target = target;
      options.skips = Skips::kOn;
      RenderStats on, off;
      const Film film = RenderOrFail(scene, scene.cameras[0], options, &on);
      options.skips = Skips::kOff;
      CHECK(PixelsThatDiffer(film, RenderOrFail(scene, scene.cameras[0], options, &off)) == 0);
      CHECK(on.rays.shadow <= off.rays.shadow);
      CHECK(on.rays.reflected == off.rays.reflected);
    });
  }
}

TEST_CASE("a least weight drops rays, and never more light than it says") {
  const Scene scene = GlassAndMirrors();
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.max_depth = 7;
  RenderStats all, some;
  const Film exact = RenderOrFail(scene, scene.cameras[0], options, &all);
  options.min_throughput = 0.02;
  const Film film = RenderOrFail(scene, scene.cameras[0], options, &some);
  CheckSameBits(scene, scene.cameras[0], options);
  CHECK(some.rays.traced() < all.rays.traced() * 9 / 10);
  double largest = 0;
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    largest = std::max(largest, std::abs(double{film.rgb[i]} - double{exact.rgb[i]}));
  }
  CHECK(largest > 0);
  CHECK(largest < 0.1);
}

double RootMeanSquare(const Film& a, const Film& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double difference = double{a.rgb[i]} - double{b.rgb[i]};
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

TEST_CASE("adaptive sampling has the same bits on every target") {
  RenderOptions options;
  options.width = 90;
  options.height = 70;
  options.samples = 4;
  for (const double contrast : {0.0, 0.1, 1.0}) {
    options.contrast = contrast;
    CheckSameBits(CrystalBall(), CrystalBall().cameras[0], options);
    const Scene scene = EverythingScene(5);
    for (const Camera& camera : scene.cameras) CheckSameBits(scene, camera, options);
  }
}

TEST_CASE("adaptive sampling spends its rays at edges") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.width = 160;
  options.height = 120;
  const Film single = RenderOrFail(scene, scene.cameras[0], options);
  options.samples = 16;
  RenderStats full_stats, stats;
  const Film full = RenderOrFail(scene, scene.cameras[0], options, &full_stats);
  options.contrast = 0.05;
  const Film film = RenderOrFail(scene, scene.cameras[0], options, &stats);
  CHECK(stats.rays.traced() < full_stats.rays.traced() / 2);
  CHECK(RootMeanSquare(film, full) < RootMeanSquare(single, full) / 2);
}

// Two glasses and a mirror side by side, so that rays of one pixel leave different materials at one
// depth: the order in which their children are added is then not that of the materials.
Scene GlassAndMirrors() {
  Random random(9);
  Scene scene;
  for (int i = 0; i < 3; ++i) {
    Material material;
    material.base_colour = UniformPoint(random, 0.2, 1);
    material.ambient = 0.3;
    material.kd = 0.3;
    if (i < 2) material.transmit = Colour(0.9, 0.8, 0.7);
    if (i > 0) material.reflect = Colour(0.1, 0.15, 0.2) * static_cast<double>(i);
    material.ior = i == 0 ? 1.5 : 1.2;
    scene.materials.push_back(material);
  }
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = 0; z < 3; ++z) {
        const auto material = static_cast<std::uint32_t>(random() % 3);
        scene.objects.push_back({"", Sphere{{x * 0.9, y * 0.9, z * -0.9}, 0.5}, material});
      }
    }
  }
  scene.lights = {{"key", PointLight{{5, 8, 9}, {1, 0, 0}}, {1, 0.9, 0.8}, 1}};
  scene.settings.background = {0.3, 0.4, 0.7};
  scene.cameras = {{"c", {0.3, 0.2, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{55}}};
  return scene;
}

TEST_CASE("several materials that spawn rays at one depth have the same bits on every target") {
  const Scene scene = GlassAndMirrors();
  RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.max_depth = 7;
  CheckSameBits(scene, scene.cameras[0], options);
}

// Reflect and transmit add up to 2, so that weights overflow to infinity inside the ball, where
// nothing is shaded.
TEST_CASE("weights that overflow have the same bits on every target") {
  Scene scene;
  Material glass;
  glass.reflect = glass.transmit = Colour(1.0);
  glass.ior = 1.5;
  scene.materials = {glass};
  scene.objects = {{"", Sphere{{0, 0, 0}, 1}, 0}};
  const Camera camera{"in", {0.9, 0, 0}, {0.9, 0, -1}, {0, 1, 0}, Perspective{40}};
  RenderOptions options;
  options.width = 8;
  options.height = 8;
  options.max_depth = 300;
  options.target = Target::Scalar();
  const Film scalar = RenderOrFail(scene, camera, options);
  options.target = Target();
  ForEachTarget([&](Target target) {
    options.target = target;
    CHECK(PixelsThatDiffer(RenderOrFail(scene, camera, options), scalar) == 0);
  });
}

TEST_CASE("a scene of many materials is binned by the few that a tile meets") {
  Scene scene;
  for (int i = 0; i < 5000; ++i) {
    Material material;
    material.base_colour = Colour(i % 7 * 0.1, i % 11 * 0.05, 0.5);
    material.ambient = 1;
    scene.materials.push_back(material);
  }
  for (std::uint32_t i = 0; i < 25; ++i) {
    const double x = i % 5, y = i / 5;
    scene.objects.push_back({"", Sphere{{x - 2, y - 2, -6}, 0.6}, 4999 - 199 * i});
  }
  scene.settings.background = {0.5, 0.5, 0.5};
  const Camera camera{"c", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, Perspective{60}};
  RenderOptions options;
  options.width = 70;
  options.height = 60;
  CheckSameBits(scene, camera, options);
}

TEST_CASE("an empty scene shows its background, and nothing is lit without lights") {
  Scene scene;
  scene.settings.background = {0.25, 0.5, 0.75};
  const Camera camera{"c", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{}};
  RenderOptions options;
  options.width = 53;
  options.height = 53;
  CheckSameBits(scene, camera, options);
  Film film = RenderOrFail(scene, camera, options);
  CHECK(film.pixel(9, 9)[0] == 0.25f);
  CHECK(film.pixel(9, 9)[2] == 0.75f);

  Material material;
  material.base_colour = Colour(0.5);
  material.ambient = 0.5;
  material.kd = 1;
  scene.materials = {material};
  scene.objects = {{"", Sphere{{0, 0, 0}, 1}, 0}};
  film = RenderOrFail(scene, camera, options);
  CHECK(film.pixel(26, 26)[1] == 0.125f);  // ka * base * background
}

// ---- Bands ----

// The film that RenderRows hands over, checked for the heights of its bands.
Film RenderInBands(const Scene& scene, const Camera& camera, const RenderOptions& options,
                   int band_height, RenderStats& stats) {
  const PixelRect area = options.crop.value_or(PixelRect{0, 0, options.width, options.height});
  Film film(area.width(), area.height());
  int next_row = 0;
  RenderProgress progress;
  const RowSink append = [&](const Film& rows) {
    CHECK(rows.width == film.width);
    CHECK(rows.height == std::min(band_height, film.height - next_row));
    CHECK(rows.rgb.size() == 3 * static_cast<std::size_t>(rows.width * rows.height));
    std::copy(rows.rgb.begin(), rows.rgb.end(), film.pixel(0, next_row));
    next_row += rows.height;
    return Status(Done{});
  };
  REQUIRE(RenderRows(scene, camera, options, append, &stats, &progress).ok());
  CHECK(next_row == film.height);
  CHECK(progress.pixels_done == static_cast<std::uint64_t>(film.width * film.height));
  return film;
}

void CheckBands(const Scene& scene, RenderOptions options) {
  struct Case {
    int tile_size, band_rows, band_height;  // what is asked for, what comes
  };
  // 90 rows are 3 rows of tiles of 32, 13 of 7 and 90 of 1.
  const Case cases[] = {{32, 1, 32}, {32, 32, 32}, {32, 33, 64}, {32, 0, 96}, {7, 1, 7},
                        {7, 15, 21}, {64, 1, 64},  {1, 1, 1},    {1, 13, 13}, {32, 65536, 96}};
  RenderStats whole_stats;
  const Film whole = RenderOrFail(scene, scene.cameras[0], options, &whole_stats);
  for (const Case& bands : cases) {
    for (const int threads : {1, 2, 5}) {
      CAPTURE(bands.tile_size);
      CAPTURE(bands.band_rows);
      CAPTURE(threads);
      options.tile_size = bands.tile_size;
      options.band_rows = bands.band_rows;
      options.threads = threads;
      RenderStats stats;
      const Film film = RenderInBands(scene, scene.cameras[0], options, bands.band_height, stats);
      CHECK(PixelsThatDiffer(film, whole) == 0);
      CHECK(stats.rays.primary == whole_stats.rays.primary);
      CHECK(stats.rays.shadow == whole_stats.rays.shadow);
      CHECK(stats.rays.reflected == whole_stats.rays.reflected);
      CHECK(stats.rays.refracted == whole_stats.rays.refracted);
      CHECK(stats.rays.beyond_depth == whole_stats.rays.beyond_depth);
      CHECK(stats.threads <= threads);
      CHECK(stats.wall_seconds > 0.0);
    }
  }
}

TEST_CASE("bands of any height have the same bits as the whole picture") {
  const Scene scene = EverythingScene(5);
  RenderOptions options;
  options.width = 51;
  options.height = 90;
  options.samples = 2;
  for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
    options.precision = precision;
    options.target = Target::Scalar();
    CheckBands(scene, options);
    options.target = Target();
    ForEachTarget([&](Target target) {
      options.target = target;
      CheckBands(scene, options);
    });
  }
}

TEST_CASE("bands of a crop have the same bits as the crop") {
  const Scene scene = EverythingScene(6);
  RenderOptions options;
  options.width = 200;
  options.height = 150;
  for (const PixelRect& crop : {PixelRect{13, 50, 44, 140}, PixelRect{199, 60, 200, 150}}) {
    options.crop = crop;
    options.target = Target::Scalar();
    CheckBands(scene, options);
    options.target = Target();
    CheckBands(scene, options);
  }
}

TEST_CASE("a band is small beside a large picture and the whole of a small one") {
  Scene scene;
  const Camera camera{"c", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, Perspective{}};
  RenderOptions options;
  options.max_depth = 0;
  for (const auto& [width, height, largest] :
       {std::tuple(1280, 960, 128), {8192, 1024, 32}, {65536, 70, 32}, {1, 65536, 65536}}) {
    options.width = width;
    options.height = height;
    options.threads = 2;
    int highest = 0;
    const RowSink measure = [&](const Film& rows) {
      highest = std::max(highest, rows.height);
      return Status(Done{});
    };
    REQUIRE(RenderRows(scene, camera, options, measure).ok());
    CAPTURE(width);
    CHECK(highest <= largest);
    CHECK(highest >= std::min(height, largest) * 3 / 4);
  }
}

TEST_CASE("a sink has a band while the next renders") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.band_rows = 32;
  RenderProgress progress;
  const std::uint64_t band_pixels = 32 * 640;
  bool overlapped = false;
  int calls = 0;
  const RowSink wait_for_more = [&](const Film&) {
    // The first band does not come back before pixels of the second are there.
    for (int i = 0; calls == 0 && i < 10000 && !overlapped; ++i) {
      overlapped = progress.pixels_done > band_pixels;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ++calls;
    return Status(Done{});
  };
  REQUIRE(RenderRows(scene, scene.cameras[0], options, wait_for_more, nullptr, &progress).ok());
  CHECK(overlapped);
  CHECK(calls == 15);
}

TEST_CASE("a sink that fails ends the frame with its error") {
  const Scene scene = CrystalBall();
  for (const int failing_call : {1, 2, 14, 15}) {
    RenderOptions options;
    options.band_rows = 32;
    RenderProgress progress;
    int calls = 0;
    const RowSink fail = [&](const Film&) {
      if (++calls < failing_call) return Status(Done{});
      return Status(Error{ErrorKind::kInputOutput, "the disk is full"});
    };
    const Status status = RenderRows(scene, scene.cameras[0], options, fail, nullptr, &progress);
    REQUIRE(!status.ok());
    CHECK(status.error().kind == ErrorKind::kInputOutput);
    CHECK(status.error().message == "the disk is full");
    CHECK(calls == failing_call);
    CHECK(progress.stop);
    // The band in work at most.
    CHECK(progress.pixels_done <= static_cast<std::uint64_t>(failing_call + 1) * 32 * 640);
  }
}

TEST_CASE("after a stop no more rows are handed over") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  options.band_rows = 32;
  RenderProgress progress;
  int calls = 0;
  const RowSink stop = [&](const Film&) {
    ++calls;
    progress.stop = true;
    return Status(Done{});
  };
  const Status status = RenderRows(scene, scene.cameras[0], options, stop, nullptr, &progress);
  REQUIRE(!status.ok());
  CHECK(status.error().kind == ErrorKind::kInterrupted);
  CHECK(calls == 1);
}

TEST_CASE("what a sink throws is thrown") {
  const Scene scene = CrystalBall();
  RenderOptions options;
  for (const int band_rows : {32, 480}) {
    options.band_rows = band_rows;
    const RowSink full = [](const Film&) -> Status { throw std::bad_alloc(); };
    CHECK_THROWS_AS((void)RenderRows(scene, scene.cameras[0], options, full), std::bad_alloc);
  }
}

TEST_CASE("options out of range are refused") {
  const Scene scene = CrystalBall();
  const auto refused = [&](RenderOptions options) {
    const Result<Film> film = Render(scene, scene.cameras[0], options);
    return !film.ok() && film.error().kind == ErrorKind::kUsage;
  };
  RenderOptions options;
  CHECK(!refused(options));
  options.width = 0;
  CHECK(refused(options));
  options = {};
  options.tile_size = kMaxTileSize + 1;
  CHECK(refused(options));
  options = {};
  options.crop = PixelRect{0, 0, 641, 10};
  CHECK(refused(options));
  options.crop = PixelRect{5, 5, 5, 10};
  CHECK(refused(options));

  const auto rows_refused = [&](int band_rows) {
    RenderOptions bands;
    bands.width = bands.height = 8;
    bands.band_rows = band_rows;
    const RowSink ignore = [](const Film&) { return Status(Done{}); };
    const Status status = RenderRows(scene, scene.cameras[0], bands, ignore);
    return !status && status.error().kind == ErrorKind::kUsage;
  };
  CHECK(rows_refused(-1));
  CHECK(rows_refused(kMaxImageSide + 1));
  CHECK(!rows_refused(kMaxImageSide));
}

TEST_CASE("a stop during a pixel ends it") {
  const Scene scene = CrystalBall();
  for (const Target target : {Target::Scalar(), Target()}) {
    RenderOptions options;
    options.target = target;
    options.samples = kMaxSamples;  // hours, if it were not stopped
    options.threads = 1;
    RenderProgress progress;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      progress.stop = true;
    });
    const Result<Film> film = Render(scene, scene.cameras[0], options, nullptr, &progress);
    stopper.join();
    CHECK(!film.ok());
  }
}

TEST_CASE("a stop that was asked for gives no film") {
  const Scene scene = CrystalBall();
  RenderProgress progress;
  progress.stop = true;
  const Result<Film> film = Render(scene, scene.cameras[0], {}, nullptr, &progress);
  REQUIRE(!film.ok());
  CHECK(film.error().kind == ErrorKind::kInterrupted);
}

}  // namespace
}  // namespace sheaf
