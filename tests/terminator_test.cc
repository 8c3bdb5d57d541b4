// Light fades over a coarse mesh with smooth normals as over the surface that it stands for.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "same_bits.h"
#include "sheaf/render.h"

namespace sheaf {
namespace {

// A ball of 16 x 8 faces.
Mesh CoarseBall() {
  constexpr std::uint32_t kAround = 16, kDown = 8;
  Mesh mesh;
  for (std::uint32_t row = 0; row <= kDown; ++row) {
    const double down = std::numbers::pi * row / kDown;
    for (std::uint32_t column = 0; column < kAround; ++column) {
      const double turn = 2 * std::numbers::pi * column / kAround;
      mesh.positions.emplace_back(std::sin(down) * std::cos(turn), std::cos(down),
                                  std::sin(down) * std::sin(turn));
    }
  }
  mesh.normals = mesh.positions;
  for (std::uint32_t row = 0; row < kDown; ++row) {
    for (std::uint32_t column = 0; column < kAround; ++column) {
      const std::uint32_t next = (column + 1) % kAround, from = row * kAround;
      const std::uint32_t a = from + column, b = from + next;
      if (row > 0) mesh.triangles.push_back({a, b, b + kAround});
      if (row + 1 < kDown) mesh.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
  return mesh;
}

Scene LitFromTheSide(const Mesh& mesh, bool casts_shadows, const Light& light) {
  Scene scene;
  Material white;
  white.kd = 1;
  scene.materials = {white};
  scene.objects = {{"ball", mesh, 0}};
  scene.lights = {light};
  scene.lights[0].casts_shadows = casts_shadows;
  scene.cameras = {{"c", {0, 0, 4}, {0, 0, 0}, {0, 1, 0}, Perspective{32}}};
  return scene;
}

// The largest difference of neighbouring pixels of the ball, but where its own normals turn fast
// near the rim.
float LargestStep(const Film& film) {
  float largest = 0;
  const auto is_inside = [&](int x, int y) {
    return std::hypot(x - film.width / 2, y - film.height / 2) < 0.38 * film.height;
  };
  for (int y = 1; y < film.height; ++y) {
    for (int x = 1; x < film.width; ++x) {
      if (!is_inside(x, y)) continue;
      const float here = film.pixel(x, y)[0];
      largest = std::max({largest, std::abs(here - film.pixel(x - 1, y)[0]),
                          std::abs(here - film.pixel(x, y - 1)[0])});
    }
  }
  return largest;
}

const Light kSun{"sun", DirectionalLight{{-1, -0.3, -0.2}}, Colour(1.0), 1, true};
const Light kLamp{"lamp", PointLight{{5, 1.5, 1}, {1, 0, 0}}, Colour(1.0), 1, true};

TEST_CASE("a smooth ball fades to its terminator, with shadows and without") {
  RenderOptions options;
  options.width = options.height = 300;
  for (const Light& light : {kSun, kLamp}) {
    for (const bool casts_shadows : {false, true}) {
      CAPTURE(light.name);
      CAPTURE(casts_shadows);
      const Scene scene = LitFromTheSide(CoarseBall(), casts_shadows, light);
      const Film film = RenderOrFail(scene, scene.cameras[0], options);
      const float step = LargestStep(film);
      CAPTURE(step);
      CHECK(step <= 0.02f);
      // The side away from the light is dark.
      CHECK(film.pixel(60, 150)[0] == 0);
      CHECK(film.pixel(230, 130)[0] > 0.5f);
      RenderOptions small = options;
      small.width = small.height = 60;
      CheckSameBits(scene, scene.cameras[0], small);
    }
  }
}

TEST_CASE("a flat face is not lit from behind, whatever its normals say") {
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Light behind{"sun", DirectionalLight{{-1, 0, 0.1}}, Colour(1.0), 1, true};
  RenderOptions options;
  options.width = options.height = 40;
  for (const bool has_normals : {false, true}) {
    // All the same way, half way to the light: they show no curve.
    if (has_normals) mesh.normals.assign(4, {0.7f, 0, 0.7f});
    for (const bool casts_shadows : {false, true}) {
      const Scene scene = LitFromTheSide(mesh, casts_shadows, behind);
      const Film film = RenderOrFail(scene, scene.cameras[0], options);
      CHECK(std::all_of(film.rgb.begin(), film.rgb.end(), [](float x) { return x == 0; }));
    }
  }
  // A normal that is 0 is the face's own: with all of them the mesh has the bits of one without.
  mesh.normals.assign(4, {0, 0, 0});
  Mesh plain = mesh;
  plain.normals.clear();
  const Light slanted{"sun", DirectionalLight{{-1, 0.3, -0.1}}, Colour(1.0), 1, true};
  const Scene a = LitFromTheSide(mesh, true, slanted), b = LitFromTheSide(plain, true, slanted);
  CHECK(PixelsThatDiffer(RenderOrFail(a, a.cameras[0], options),
                         RenderOrFail(b, b.cameras[0], options)) == 0);
}

}  // namespace
}  // namespace sheaf
