// What Open Image Denoise is handed, and what becomes of its answer; by a stub, which is always
// there.
#include <doctest/doctest.h>

#include <limits>

#include "noisy_film.h"
#define SHEAF_HAS_OIDN
#include "src/render/oidn_filter.cc"  // NOLINT: compiled against the stub

namespace sheaf {
namespace {

TEST_CASE("colours, albedo and normals go in, colours come out") {
  Film noisy = WithNoise(RoomFilm(20, 10), 2);
  noisy.pixel(3, 4)[1] = std::numeric_limits<float>::infinity();
  oidn::next_fails = false;
  const Result<Film> denoised = DenoiseByOidn(noisy, 3);
  REQUIRE(denoised.ok());
  CHECK(oidn::last_stub->threads == 3);
  CHECK(oidn::last_stub->is_hdr);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 20; ++x) {
      const bool is_kept = x == 3 && y == 4;
      for (int c = 0; c < 3; ++c) {
        const float colour = noisy.pixel(x, y)[c];
        const float want =
            colour * noisy.at(Layer::kAlbedo, x, y)[c] + noisy.at(Layer::kNormal, x, y)[c];
        REQUIRE(denoised.value().pixel(x, y)[c] == (is_kept ? colour : want));
      }
    }
  }
  for (int i = 0; i < kLayerCount; ++i) CHECK(denoised.value().layers[i] == noisy.layers[i]);
}

TEST_CASE("normals alone are not handed over: the filter takes them beside albedo only") {
  Film noisy = WithNoise(RoomFilm(20, 10), 2);
  noisy.layers[static_cast<int>(Layer::kAlbedo)].clear();
  const Result<Film> denoised = DenoiseByOidn(noisy, 0);
  REQUIRE(denoised.ok());
  CHECK(denoised.value().rgb == noisy.rgb);
  CHECK(oidn::last_stub->threads == 0);
}

TEST_CASE("its errors are errors") {
  oidn::next_fails = true;
  const Result<Film> denoised = DenoiseByOidn(RoomFilm(4, 4), 1);
  REQUIRE(!denoised.ok());
  CHECK(denoised.error().message == "Open Image Denoise: the stub fails");
}

}  // namespace
}  // namespace sheaf
