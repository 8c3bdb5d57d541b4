// Whole pictures against POV-Ray, double precision and counts of another tracer.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "same_bits.h"
#include "sheaf/render.h"
#include "src/formats/picture.h"
#include "src/formats/png.h"
#include "src/formats/quantize.h"
#include "src/lab/has_program.h"
#include "targets.h"
#include "test_frames.h"

namespace sheaf {
namespace {

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

}  // namespace
}  // namespace sheaf
