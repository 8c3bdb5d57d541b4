// Holds a frame on every target, thread count, tile size and crop to the scalar baseline's bits.
#ifndef SHEAF_TESTS_SAME_BITS_H_
#define SHEAF_TESTS_SAME_BITS_H_

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "sheaf/render.h"
#include "targets.h"

namespace sheaf {

inline Film RenderOrFail(const Scene& scene, const Camera& camera, const RenderOptions& options,
                         RenderStats* stats = nullptr) {
  Result<Film> film = Render(scene, camera, options, stats);
  if (!film.ok()) FAIL(film.error().message);
  return std::move(film).value();
}

inline int PixelsThatDiffer(const Film& a, const Film& b) {
  REQUIRE(a.width == b.width);
  REQUIRE(a.height == b.height);
  int differing = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      differing += std::memcmp(a.pixel(x, y), b.pixel(x, y), 3 * sizeof(float)) != 0;
    }
  }
  return differing;
}

inline bool IsFinite(const Film& film) {
  return std::all_of(film.rgb.begin(), film.rgb.end(), [](float x) { return std::isfinite(x); });
}

// Renders on every target, with 1 and 2 threads, in tiles of several sizes and as crops, and
// compares with the scalar baseline.
inline void CheckSameBits(const Scene& scene, const Camera& camera, RenderOptions options) {
  options.target = Target::Scalar();
  RenderStats scalar_stats;
  const Film scalar = RenderOrFail(scene, camera, options, &scalar_stats);
  REQUIRE(scalar_stats.target == "scalar");
  CHECK(IsFinite(scalar));
  ForEachTarget([&](Target target) {
    options.target = target;
    for (const int threads : {1, 2}) {
      for (const int tile : {32, 7, 64}) {
        options.threads = threads;
        options.tile_size = tile;
        RenderStats stats;
        const Film film = RenderOrFail(scene, camera, options, &stats);
        CHECK(PixelsThatDiffer(film, scalar) == 0);
        CHECK(stats.target == target.name());
        // A tile's neighbours are sampled with it: their rays depend on the tiles.
        const bool is_scenes = options.samples == kFromScene;
        if (options.contrast || (is_scenes && scene.settings.contrast)) continue;
        CHECK(stats.rays.shadow == scalar_stats.rays.shadow);
        CHECK(stats.rays.reflected == scalar_stats.rays.reflected);
        CHECK(stats.rays.refracted == scalar_stats.rays.refracted);
        CHECK(stats.rays.beyond_depth == scalar_stats.rays.beyond_depth);
      }
    }
    RenderOptions cropped = options;
    for (const PixelRect& crop : {PixelRect{0, 0, 1, 1}, PixelRect{13, 5, 50, 44},
                                  PixelRect{options.width - 3, 0, options.width, options.height}}) {
      cropped.crop = crop;
      const Film film = RenderOrFail(scene, camera, cropped);
      Film part(crop.width(), crop.height());
      for (int y = 0; y < part.height; ++y) {
        std::copy_n(scalar.pixel(crop.x0, crop.y0 + y), 3 * part.width, part.pixel(0, y));
      }
      CHECK(PixelsThatDiffer(film, part) == 0);
    }
  });
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_SAME_BITS_H_
