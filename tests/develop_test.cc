// From light to what a display shows: exposure, its metering, the tone curve.
#include "src/scene/develop.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sheaf/formats.h"

// Its names would be shadowed there.
#include "run_command.h"

namespace sheaf {
namespace {

Film GreyFilm(const std::vector<float>& values) {
  Film film(static_cast<int>(values.size()), 1);
  for (std::size_t i = 0; i < values.size(); ++i) {
    film.rgb[3 * i] = film.rgb[3 * i + 1] = film.rgb[3 * i + 2] = values[i];
  }
  return film;
}

TEST_CASE("a stop doubles light") {
  for (int ev = -64; ev <= 64; ++ev) CHECK(ExposureFactor(ev) == std::ldexp(1.0, ev));
  for (double ev = -10; ev < 10; ev += 0.037) {
    CHECK(ExposureFactor(ev) == doctest::Approx(std::exp2(ev)).epsilon(1e-14));
  }
  Film film = GreyFilm({0, 0.25f, 3});
  Develop(-1, Tone::kLinear, film);
  CHECK(film.rgb[0] == 0);
  CHECK(film.rgb[3] == 0.125f);
  CHECK(film.rgb[6] == 1.5f);
}

TEST_CASE("the filmic curve rises from 0 to 1") {
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> values = {-1, 0};
  for (float x = 1e-6f; x < 1e7f; x *= 1.1f) values.push_back(x);
  values.push_back(infinity);
  Film film = GreyFilm(values);
  Develop(0, Tone::kFilmic, film);
  CHECK(film.rgb[0] == 0);
  CHECK(film.rgb[3] == 0);
  for (std::size_t i = 3; i < film.rgb.size(); ++i) CHECK(film.rgb[i] >= film.rgb[i - 3]);
  CHECK(film.rgb.back() == 1);
  Film one = GreyFilm({1});
  Develop(0, Tone::kFilmic, one);
  CHECK(one.rgb[0] == doctest::Approx(2.54 / 3.16));
}

TEST_CASE("metering makes the median of what is lit grey, by thirds of a stop") {
  CHECK(MeterExposure(GreyFilm({0, 0, 0})) == 0);
  CHECK(MeterExposure(GreyFilm({})) == 0);
  CHECK(MeterExposure(GreyFilm({0, 0, 0, 0.0449f, 1e9f, 1e-9f})) == 2);
  for (float median = 1e-12f; median < 1e12f; median *= 1.7f) {
    const double ev = MeterExposure(GreyFilm({0, median / 3, median, 5 * median}));
    const double shown = static_cast<double>(median) * std::exp2(ev);
    CHECK(shown <= 0.18 * (1 + 1e-6));
    CHECK(shown > 0.18 / std::exp2(1 / 3.0) * (1 - 1e-6));
    CHECK(std::abs(3 * ev - std::round(3 * ev)) < 1e-12);
  }
}

// A lamp as bright as Blender's are over a white wall.
std::string LampScene() {
  return R"({"settings": {"size": [40, 30], "ev": "auto", "ambient": 0},
    "materials": [{"name": "wall", "kd": 1}],
    "objects": [{"quad": {"corners": [[-9,-9,0],[9,-9,0],[9,9,0],[-9,9,0]]}, "material": "wall"}],
    "lights": [{"point": {"position": [0, 0, 3]}, "intensity": 17000}],
    "cameras": [{"name": "c", "eye": [0, 0, 8], "look_at": [0, 0, 0], "fov_y": 60}]})";
}

int MiddleOf(const std::string& path) {
  const auto read = ReadPicture(path);
  REQUIRE(read.ok());
  const Film& film = read.value().film;
  return static_cast<int>(std::lround(film.pixel(film.width / 4, film.height / 4)[0] * 255));
}

TEST_CASE("--exposure and --tone") {
  const Workspace folder;
  WriteText(folder / "lamp.json", LampScene());
  const std::string scene = folder / "lamp.json", picture = folder / "a.png",
                    other = folder / "b.png", light = folder / "l.pfm";
  const auto render = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"render", scene, "-q"});
    const Outcome ran = folder.Run(options);
    CAPTURE(ran.err);
    CHECK(ran.code == 0);
  };
  render({"-o", picture});  // the scene's: metered
  CHECK(MiddleOf(picture) > 60);
  CHECK(MiddleOf(picture) < 200);
  render({"--exposure", "0", "-o", other});
  CHECK(MiddleOf(other) == 255);
  render({"--exposure", "auto", "--tone", "filmic", "-o", other});
  CHECK(MiddleOf(other) != MiddleOf(picture));
  // A part is metered as the whole is.
  render({"--crop", "0,0,20,20", "-o", other});
  const Film whole = ReadPicture(picture).value().film, part = ReadPicture(other).value().film;
  for (int x = 0; x < 20; ++x) CHECK(part.pixel(x, 7)[1] == whole.pixel(x, 7)[1]);
  // Light is written as it is, and developed later.
  render({"-o", light});
  CHECK(folder.Run({"convert", light, "--transfer", "srgb", "--exposure", "auto", "-o", other})
            .code == 0);
  CHECK(MiddleOf(other) == MiddleOf(picture));
  const Outcome refused = folder.Run({"render", scene, "--exposure", "1", "-o", light});
  CHECK(refused.code == 2);
  CHECK(Contains(refused.err, "holds light as it is"));
  CHECK(folder.Run({"render", scene, "--exposure", "bright", "-o", picture}).code == 2);
  CHECK(folder.Run({"convert", scene, "--tone", "filmic", "-o", folder / "s.json"}).code == 2);
}

}  // namespace
}  // namespace sheaf
