// A square seen from above, so that the pixels of one row show what its material says point by
// point.
#ifndef SHEAF_TESTS_SHEET_SCENE_H_
#define SHEAF_TESTS_SHEET_SCENE_H_

#include <doctest/doctest.h>

#include <initializer_list>
#include <memory>
#include <vector>

#include "same_bits.h"
#include "sheaf/render.h"

namespace sheaf {

constexpr std::uint32_t Texel(std::uint32_t r, std::uint32_t g, std::uint32_t b,
                              std::uint32_t a = 255) {
  return r | g << 8 | b << 16 | a << 24;
}

// Of linear data, in one row, as texels and not as means of them.
inline Texture RowOf(std::initializer_list<std::uint32_t> texels) {
  const auto image =
      std::make_shared<const Image>(Image{"row.png", static_cast<int>(texels.size()), 1, texels});
  return {image, Transfer::kLinear, Wrap::kClamp, Wrap::kClamp, Filter::kNearest};
}

// A square from -1 to 1 at height z, its front up, u along x and v against y.
inline Object Sheet(double z, std::uint32_t material, double half = 1) {
  Mesh mesh;
  const auto h = static_cast<float>(half), at = static_cast<float>(z);
  mesh.positions = {{-h, -h, at}, {h, -h, at}, {h, h, at}, {-h, h, at}};
  mesh.uv = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return {"", mesh, material};
}

// Looks down on the square, so that a picture of n x 1 pixels shows n texels of a row.
inline Scene SheetScene(const Material& material) {
  Scene scene;
  scene.settings.ambient = Colour(1.0);
  scene.settings.background = {0.25, 0.5, 0.75};
  scene.materials = {material};
  scene.objects = {Sheet(0, 0)};
  scene.cameras = {{"down", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, Orthographic{2}}};
  return scene;
}

inline std::vector<glm::dvec3> RowIn(const Scene& scene, int width) {
  RenderOptions options;
  options.width = width;
  options.height = 1;
  Scene stretched = scene;
  // Pixels are square: a row of n of them is as wide as the sheet.
  std::get<Orthographic>(stretched.cameras[0].projection).height = 2.0 / width;
  const Film film = RenderOrFail(stretched, stretched.cameras[0], options);
  std::vector<glm::dvec3> row;
  for (int x = 0; x < width; ++x) {
    const float* rgb = film.pixel(x, 0);
    row.emplace_back(rgb[0], rgb[1], rgb[2]);
  }
  return row;
}

inline void CheckColour(const glm::dvec3& got, const glm::dvec3& want) {
  for (int i = 0; i < 3; ++i) CHECK(got[i] == doctest::Approx(want[i]).epsilon(2e-6));
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_SHEET_SCENE_H_
