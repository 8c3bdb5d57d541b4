// `sheaf denoise` and `sheaf render --denoise`.
#include <doctest/doctest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/formats/pfm.h"
#include "src/lab/picture_metrics.h"
#include "tests/noisy_film.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

Film LayerFilm(const Film& film, Layer layer) {
  Film shown(film.width, film.height);
  const int channels = kLayerChannels[static_cast<int>(layer)];
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      for (int c = 0; c < 3; ++c) shown.pixel(x, y)[c] = film.at(layer, x, y)[c % channels];
    }
  }
  return shown;
}

Film ReadOrFail(const std::string& path) {
  Result<ReadPictureResult> read = ReadPicture(path);
  if (!read.ok()) FAIL(read.error().message);
  return std::move(read.value().film);
}

// A noisy picture and its layers, as files.
struct NoisyFiles {
  NoisyFiles() : noisy(WithNoise(RoomFilm(80, 60), 4)) {
    REQUIRE(WritePfm(noisy, work / "noisy.pfm").ok());
    for (const Layer layer : {Layer::kAlbedo, Layer::kNormal, Layer::kDepth}) {
      REQUIRE(
          WritePfm(LayerFilm(noisy, layer), work / (std::string(LayerName(layer)) + ".pfm")).ok());
    }
  }
  std::vector<std::string> Arguments(const std::string& output) const {
    return {"denoise",  work / "noisy.pfm",  "--albedo", work / "albedo.pfm",
            "--normal", work / "normal.pfm", "--depth",  work / "depth.pfm",
            "-o",       work / output};
  }
  Workspace work;
  Film noisy;
};

TEST_CASE("files of layers guide as the layers of a film do") {
  const NoisyFiles files;
  REQUIRE(files.work.Run(files.Arguments("out.pfm")).code == 0);
  const Film want = Denoise(files.noisy).value();
  CHECK(want.rgb == ReadOrFail(files.work / "out.pfm").rgb);
  CHECK(want.rgb != files.noisy.rgb);
  auto scalar = files.Arguments("scalar.pfm");
  scalar.insert(scalar.end(), {"--target", "scalar", "--threads", "1"});
  REQUIRE(files.work.Run(scalar).code == 0);
  CHECK(ReadText(files.work / "out.pfm") == ReadText(files.work / "scalar.pfm"));
}

TEST_CASE("an .exr brings its layers along") {
  const FileFormat* exr = FormatOf("a.exr");
  REQUIRE(exr != nullptr);
  if (!exr->is_built_in) return;
  const Workspace work;
  const Film noisy = WithNoise(RoomFilm(40, 30), 4);
  PictureSpec spec = WholePicture(40, 30, Transfer::kLinear);
  spec.layers = noisy.held_layers();
  REQUIRE(WritePicture(noisy, spec, work / "noisy.exr").ok());
  REQUIRE(work.Run({"denoise", work / "noisy.exr", "-o", work / "out.exr"}).code == 0);
  const Film film = ReadOrFail(work / "out.exr");
  CHECK(film.rgb == Denoise(noisy).value().rgb);
  CHECK(film.held_layers() == noisy.held_layers());
}

TEST_CASE("pictures of bytes: decoded, filtered, encoded again") {
  const NoisyFiles files;
  const Workspace& work = files.work;
  REQUIRE(WritePicture(files.noisy, Transfer::kSrgb, work / "noisy.png").ok());
  PictureSpec numbers = WholePicture(80, 60, Transfer::kLinear);
  numbers.values = Values::kNumbers;
  Film normals = LayerFilm(files.noisy, Layer::kNormal);
  for (float& value : normals.rgb) value = 0.5f + 0.5f * value;
  REQUIRE(WritePicture(normals, numbers, work / "normal.png").ok());
  REQUIRE(WritePicture(LayerFilm(files.noisy, Layer::kAlbedo), Transfer::kSrgb, work / "albedo.png")
              .ok());
  const Outcome outcome =
      work.Run({"denoise", work / "noisy.png", "--albedo", work / "albedo.png", "--normal",
                work / "normal.png", "--depth", work / "depth.pfm", "-o", work / "out.png"});
  CHECK(outcome.err == "");
  REQUIRE(outcome.code == 0);
  REQUIRE(WritePicture(RoomFilm(80, 60), Transfer::kSrgb, work / "room.png").ok());
  const Film room = ReadOrFail(work / "room.png");
  CHECK(RootMeanSquare(room, ReadOrFail(work / "out.png")) <
        0.6 * RootMeanSquare(room, ReadOrFail(work / "noisy.png")));
  CHECK(ReadPicture(work / "out.png").value().is_srgb);
}

TEST_CASE("errors name the file and the option") {
  const NoisyFiles files;
  const Workspace& work = files.work;
  const auto complaint = [&](std::vector<std::string> arguments, int code) {
    arguments.insert(arguments.begin(), "denoise");
    arguments.insert(arguments.end(), {"-o", work / "out.pfm"});
    const Outcome outcome = work.Run(arguments);
    CHECK(outcome.code == code);
    CHECK(LineCount(outcome.err) == 1);
    return outcome.err;
  };
  const std::string noisy = work / "noisy.pfm";
  CHECK(Contains(complaint({noisy}, 2), "noisy.pfm: has no layers to be guided by; --albedo"));
  REQUIRE(WritePfm(RoomFilm(81, 60), work / "wide.pfm").ok());
  CHECK(Contains(complaint({noisy, "--normal", work / "wide.pfm"}, 2),
                 "wide.pfm: 81x60 pixels, and"));
  REQUIRE(WritePicture(RoomFilm(80, 60), Transfer::kLinear, work / "depth.png").ok());
  CHECK(Contains(complaint({noisy, "--depth", work / "depth.png"}, 2),
                 "depth.png: distances need a picture of floats"));
  CHECK(Contains(complaint({noisy, "--albedo", work / "none.pfm"}, 4), "none.pfm: "));
  CHECK(Contains(complaint({work / "none.pfm"}, 4), "none.pfm: "));
  CHECK(Contains(complaint({noisy, "--albedo", work / "albedo.pfm", "--target", "no"}, 2),
                 "--target"));
  CHECK(Contains(complaint({noisy, "--albedo", work / "out.pfm"}, 2), "out.pfm"));
  const nlohmann::json parts = nlohmann::json::parse(work.Run({"info", "--json"}).out)["parts"];
  if (!parts["OpenImageDenoise"].get<bool>()) {
    const std::string missing = "oidn: this build has no Open Image Denoise";
    CHECK(Contains(complaint({noisy, "--albedo", work / "albedo.pfm", "--filter", "oidn"}, 2),
                   missing));
    const Outcome outcome = work.Render({"-o", work / "a.png", "--denoise=oidn"});
    CHECK(outcome.code == 2);
    CHECK(Contains(outcome.err, missing));
  }
}

TEST_CASE("render --denoise: the film of render, denoised, whatever the crop") {
  const Workspace work;
  REQUIRE(work.Render({"-o", work / "raw.pfm", "--aov", "albedo,normal,depth"}).code == 0);
  REQUIRE(work.Run({"denoise", work / "raw.pfm", "--albedo", work / "raw.albedo.pfm", "--normal",
                    work / "raw.normal.pfm", "--depth", work / "raw.depth.pfm", "-o",
                    work / "expected.pfm"})
              .code == 0);
  REQUIRE(work.Render({"-o", work / "whole.pfm", "--denoise"}).code == 0);
  CHECK(ReadOrFail(work / "expected.pfm").rgb == ReadOrFail(work / "whole.pfm").rgb);
  CHECK(work.Files() == std::vector<std::string>{"expected.pfm", "raw.albedo.pfm", "raw.depth.pfm",
                                                 "raw.normal.pfm", "raw.pfm", "whole.pfm"});

  // Wide enough that the crop does not see all of it.
  const std::vector<std::string> big = {"render",    kScene, "--size", "160x120",
                                        "--denoise", "-q",   "-o"};
  const auto render = [&](const std::string& name, std::vector<std::string> more) {
    more.insert(more.begin(), big.begin(), big.end());
    more.insert(more.begin() + static_cast<std::ptrdiff_t>(big.size()), work / name);
    CHECK(work.Run(more).code == 0);
    return ReadOrFail(work / name);
  };
  const Film whole = render("big.pfm", {}), crop = render("crop.pfm", {"--crop", "60,50,90,75"});
  REQUIRE(crop.width == 30);
  int differing = 0;
  for (int y = 0; y < 25; ++y) {
    differing += std::memcmp(crop.pixel(0, y), whole.pixel(60, y + 50), 90 * sizeof(float)) != 0;
  }
  CHECK(differing == 0);
  CHECK(render("resumed.pfm", {"--resume"}).rgb == whole.rgb);
}

}  // namespace
}  // namespace sheaf
