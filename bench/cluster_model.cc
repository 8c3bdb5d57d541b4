// How far one picture spreads over machines that are not at hand: measures the times of a scene's
// tiles, its tree, and of rank 0's work on messages here, and simulates ranks with them
// (bench/simulate_ranks.h has what is assumed).
//
//   cluster_model [SCENE] [--side N] [--spp N] [--threads N] [--tile-size N] [--gigabits X]
//   [--latency US]
//                 [--scene-gigabytes X] [--format exr|pfm|png]
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/simulate_ranks.h"
#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/cluster/area_plan.h"
#include "src/cluster/messages.h"
#include "src/cluster/strips.h"

namespace {

using namespace sheaf;  // NOLINT: a program of its own
using Clock = std::chrono::steady_clock;

double SecondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The scene's tiles in a picture of 1024 x 1024, on one thread, with 16 samples.
struct MeasuredScene {
  static constexpr int kSide = 1024, kSamples = 16;
  Film heat;
  double compile = 0;

  // Of a tile of a picture with `side` pixels a side and so many samples.
  double TileSeconds(int x, int y, int side, int samples, int tile) const {
    const int at_x = static_cast<int>(std::int64_t{x} * kSide / side);
    const int at_y = static_cast<int>(std::int64_t{y} * kSide / side);
    const double microseconds = heat.at(Layer::kHeat, at_x, at_y)[0];
    return 1e-6 * microseconds * tile * tile * samples / kSamples;
  }
};

MeasuredScene Measure(const std::string& path) {
  const Result<ReadSceneResult> read = ReadScene(path);
  if (!read) throw std::runtime_error(read.error().message);
  const Scene& scene = read.value().scene;
  RenderOptions options;
  options.width = options.height = MeasuredScene::kSide;
  options.samples = MeasuredScene::kSamples;
  options.threads = 1;
  options.tile_size = 32;
  options.layers.Add(Layer::kHeat);
  RenderStats stats;
  MeasuredScene measured;
  Result<Film> film = Render(scene, scene.cameras.front(), options, &stats);
  if (!film) throw std::runtime_error(film.error().message);
  measured.heat = std::move(film).value();
  measured.compile = stats.compile_seconds;
  return measured;
}

// Seconds a byte of rows: to take it in, and to write it.
struct MeasuredBytes {
  double take = 0, write = 0;
};

MeasuredBytes MeasureBytes(const Film& film, const std::string& ending) {
  FinishedArea area{{0, 0, film.width, film.height}, {}};
  area.pixels = Film(film.width, film.height, {});
  area.pixels.rgb = film.rgb;
  const std::string bytes = Pack(area);
  const double count = static_cast<double>(bytes.size());
  constexpr int kRounds = 8;
  MeasuredBytes measured;
  Clock::time_point start = Clock::now();
  for (int i = 0; i < kRounds; ++i) {
    // From MPI's buffer into the message, and out of it; then to its place among others.
    std::string message(bytes.size(), '\0');
    message.assign(bytes);
    FinishedArea got = UnpackArea(message);
    Strips strips(PixelRect{0, 0, 2 * film.width, film.height});
    strips.Add(got.area, std::move(got.pixels));
  }
  measured.take = SecondsSince(start) / (kRounds * count);
  const std::string path =
      std::filesystem::temp_directory_path() / ("sheaf-cluster-model." + ending);
  start = Clock::now();
  const Status written =
      WritePicture(area.pixels, WholePicture(film.width, film.height, Transfer::kLinear), path);
  measured.write = SecondsSince(start) / count;
  std::filesystem::remove(path);
  if (!written) std::fprintf(stderr, "%s\n", written.error().message.c_str());
  return measured;
}

struct Request {
  std::string scene = SHEAF_SOURCE_DIR "/scenes/crystal-ball.json", ending = "exr";
  int side = 16384, samples = 16384, threads = 32, tile = 32;
  double gigabits = 10, latency = 20, scene_gigabytes = 1, message = 5;
};

void PrintTable(const bench::ClusterModel& base, const std::vector<int>& shares) {
  fmt::print(
      "| ranks | share | areas | seconds | of ideal | scene sent | longest area | link | "
      "messages | writing | held MiB |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const int ranks : {1, 10, 100, 300, 1000, 3000, 10000}) {
    for (const int share : shares) {
      bench::ClusterModel model = base;
      model.ranks = ranks;
      model.share = share;
      const bench::ClusterTimes times = bench::SimulateRanks(model);
      fmt::print(
          "| {} | {} | {} | {:.2f} | {:.1f} % | {:.2f} s | {:.3f} s | {:.1f} % | {:.1f} % | "
          "{:.1f} % | {:.0f} |\n",
          ranks, share, times.areas, times.total, 100 * times.ideal / times.total, times.broadcast,
          times.slowest_area, 100 * times.link_busy / times.total,
          100 * times.lead_busy / times.total, 100 * times.write_busy / times.total,
          times.most_rows_held / (1 << 20));
    }
  }
}

int Run(const Request& request) {
  const MeasuredScene scene = Measure(request.scene);
  const MeasuredBytes bytes = MeasureBytes(scene.heat, request.ending);
  bench::ClusterModel model;
  model.threads = request.threads;
  model.picture = {0, 0, request.side, request.side};
  model.tile_size = request.tile;
  model.scene_bytes = request.scene_gigabytes * 1e9;
  model.compile = scene.compile;
  model.latency = 1e-6 * request.latency;
  model.message = 1e-6 * request.message;
  model.take_byte = bytes.take;
  model.write_byte = bytes.write;
  model.link_byte = 8 / (1e9 * request.gigabits);
  model.tile = [&](int x, int y) {
    return scene.TileSeconds(x, y, request.side, request.samples, request.tile);
  };
  fmt::print(
      "{}x{} pixels, {} samples, tiles of {}; {} threads a rank; {} Gbit/s, {} us; scene {} GB\n"
      "measured: tree {:.4f} s; taking rows in {:.2f} GB/s, writing {} {:.2f} GB/s\n\n",
      request.side, request.side, request.samples, request.tile, request.threads, request.gigabits,
      request.latency, request.scene_gigabytes, scene.compile, 1e-9 / bytes.take, request.ending,
      1e-9 / bytes.write);
  PrintTable(model, {4, 16, kAreaShare, 256});
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  CLI::App app("Simulates many ranks at one picture");
  app.add_option("SCENE", request.scene);
  app.add_option("--side", request.side)->check(CLI::Range(64, 65536));
  app.add_option("--spp", request.samples)->check(CLI::Range(1, 65536));
  app.add_option("--tile-size", request.tile)->check(CLI::Range(1, 256));
  app.add_option("--threads", request.threads)->check(CLI::Range(1, 1024));
  app.add_option("--gigabits", request.gigabits)->check(CLI::PositiveNumber);
  app.add_option("--latency", request.latency, "microseconds")->check(CLI::PositiveNumber);
  app.add_option("--format", request.ending)->check(CLI::IsMember({"exr", "pfm", "png"}));
  app.add_option("--message", request.message, "microseconds of rank 0's work on a message");
  app.add_option("--scene-gigabytes", request.scene_gigabytes);
  CLI11_PARSE(app, argc, argv);
  try {
    return Run(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cluster_model: %s\n", error.what());
    return 1;
  }
}
