// Scenes at the edges of what can be described: sizes, materials, transforms, views.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/formats/scene_json.h"
#include "src/lab/picture_cases.h"
#include "src/lab/stress_cases.h"
#include "src/scene/transform.h"

namespace sheaf::stress {
namespace {

double LargestDifference(const Film& a, const Film& b) {
  double most = a.rgb.size() == b.rgb.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.rgb.size() && i < b.rgb.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(a.rgb[i] - b.rgb[i])));
  }
  return most;
}

}  // namespace

// What the reader must refuse, in one line that names the place.
void BadMaterials(Report& report) {
  for (const char* value : {"-1", "1e999", "NaN", "\"red\"", "[1, 2]", "-1e30"}) {
    for (const char* key : {"kd", "ks", "shininess", "ior", "transmit", "reflect", "ambient"}) {
      const std::string text = fmt::format(
          R"({{"materials": [{{"name": "m", "{}": {}}}], "objects": [], "lights": [],
               "cameras": [{{"name": "c", "eye": [0,0,0], "look_at": [0,0,-1], "fov_y": 60}}]}})",
          key, value);
      const Result<Scene> scene = ParseSceneJson(text, "stress");
      report.Expect(!scene, fmt::format("{}: {} is accepted", key, value));
      if (scene) continue;
      const std::string& message = scene.error().message;
      report.Expect(message.find('\n') == std::string::npos && message.find("stress:") == 0,
                    "not one line with its place: " + message);
    }
  }
}

void PngTransfers(Report& report) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / fmt::format("sheaf-{}", std::random_device()());
  std::error_code error;
  report.Expect(fs::create_directory(folder, error), error.message());
  const Film film = RenderSmall(report, NewScene());
  for (const Transfer transfer : {Transfer::kLinear, Transfer::kSrgb}) {
    const std::string path = (folder / "a.png").string();
    const Status written = WritePicture(film, transfer, path);
    const Result<ReadPictureResult> read = ReadPicture(path);
    report.Expect(written.ok() && read.ok(), "no picture");
    if (!read) continue;
    report.Expect(read.value().is_linear == (transfer == Transfer::kLinear), "linear or not");
    report.Expect(read.value().is_srgb == (transfer == Transfer::kSrgb), "sRGB or not");
  }
  fs::remove_all(folder, error);
}

// A picture of any size has the pixels of a crop, bit for bit.
void OddSizes(Report& report) {
  const Result<Scene> scene = ParseSceneJson(
      R"({"materials": [{"name": "m", "kd": 0.7, "ks": 0.3, "shininess": 9},
                        {"name": "g", "transmit": 1, "ior": 1.5}],
          "objects": [{"sphere": {"center": [0, 0, -4], "radius": 1}, "material": "g"},
                      {"sphere": {"center": [1, 0, -6], "radius": 1}, "material": "m"}],
          "lights": [{"name": "l", "point": {"position": [5, 9, 2], "falloff": "constant"},
                      "intensity": 1}],
          "cameras": [{"name": "c", "eye": [0,0,0], "look_at": [0,0,-1], "fov_y": 40}]})",
      "stress");
  report.Expect(scene.ok(), scene ? "" : scene.error().message);
  if (!scene) return;
  for (const auto& [width, height] : {std::pair(1, 1), {1, 61}, {61, 1}, {31, 37}, {67, 5}}) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    const Film whole = RenderEverywhere(report, scene.value(), options);
    for (int y = 0; y < height; y += 7) {
      options.crop = PixelRect{width / 2, y, width / 2 + 1, y + 1};
      const Result<Film> pixel = Render(scene.value(), scene.value().cameras[0], options);
      const float *a = pixel.value().pixel(0, 0), *b = whole.pixel(width / 2, y);
      report.Expect(a[0] == b[0] && a[1] == b[1] && a[2] == b[2],
                    fmt::format("{}x{}: the crop at row {} differs", width, height, y));
    }
  }
}

void Nothing(Report& report) {
  Scene scene = NewScene();
  ExpectUniform(report, RenderSmall(report, scene), 0.5, 0.5);
  scene.materials = {Matt()};
  scene.materials[0].ambient = 0.25;
  scene.objects = {{"", Sphere{{0, 0, 0}, 3}, 0}};
  ExpectUniform(report, RenderSmall(report, scene), 0.125, 0.125);
  RenderOptions empty;
  empty.width = 0;
  const Result<Film> film = Render(scene, scene.cameras[0], empty);
  report.Expect(!film && film.error().kind == ErrorKind::kUsage, "a width of 0 is accepted");
}

// What leaves nothing is refused. What mirrors and stretches keeps normals where they belong: it is
// the mesh whose vertices and normals are written so.
void Transforms(Report& report) {
  for (const char* transform : {R"({"scale": 0})", R"({"scale": [1, 0, 1]})", R"({"scale": 1e999})",
                                R"({"matrix": [[1, 2, 3, 0], [2, 4, 6, 0], [0, 0, 1, 0]]})",
                                R"({"matrix": [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]]})",
                                R"([{"translate": [1, 2, 3]}, {"scale": [-0.0, 1, 1]}])"}) {
    const std::string text = fmt::format(
        R"({{"materials": [{{"name": "m"}}],
             "objects": [{{"material": "m", "transform": {},
                           "triangle": {{"vertices": [[0,0,0], [1,0,0], [0,1,0]]}}}}],
             "cameras": [{{"name": "c", "eye": [0,0,0], "look_at": [0,0,-1], "fov_y": 60}}]}})",
        transform);
    const Result<Scene> scene = ParseSceneJson(text, "stress");
    report.Expect(!scene, fmt::format("{} is accepted", transform));
    if (scene) continue;
    const std::string& message = scene.error().message;
    report.Expect(message.find("stress:2:") == 0 && message.find("transform") != std::string::npos,
                  "not the transform's place: " + message);
  }
  const Vec3d stretch(-0.5, 1.5, 0.75);
  Film films[2];
  for (const bool by_transform : {false, true}) {
    Scene ball_alone;
    ball_alone.objects = {{"ball", SmoothBall(16), 0}};
    if (by_transform) {
      Transform transform;
      for (int axis = 0; axis < 3; ++axis) transform.linear[axis] *= stretch[axis];
      const std::string refused = TransformScene(transform, &ball_alone);
      report.Expect(refused.empty(), refused);
    } else {
      Mesh& ball = std::get<Mesh>(ball_alone.objects[0].shape);
      for (glm::vec3& p : ball.positions) p = glm::vec3(glm::dvec3(p) * stretch);
      for (glm::vec3& n : ball.normals) n = glm::vec3(glm::normalize(glm::dvec3(n) / stretch));
      for (auto& triangle : ball.triangles) std::swap(triangle[1], triangle[2]);
    }
    Scene scene = NewScene();
    scene.cameras[0].eye = Vec3d(0, 0.5, 4);
    scene.materials = {Matt()};
    scene.objects = ball_alone.objects;
    scene.lights = {LampAt({4, 3, 4})};
    films[by_transform] = RenderSmall(report, scene);
  }
  const double most = LargestDifference(films[0], films[1]);
  report.Expect(most < 1e-5, fmt::format("the transform changes a pixel by {}", most));
}

void MirroredWinding(Report& report) {
  // Either winding faces the eye that sees it.
  Film films[2];
  for (const int turned : {0, 1}) {
    Scene scene = NewScene();
    scene.materials = {Matt()};
    const Vec3d a(-2, -2, -4), b(2, -2, -4), c(0, 2, -4);
    scene.objects = {{"", Triangle{{a, turned ? c : b, turned ? b : c}, {}}, 0},
                     {"", Triangle{{a, a, b}, {}}, 0}};
    scene.lights = {LampAt({0, 0, 0})};
    films[turned] = RenderSmall(report, scene);
  }
  const double most = LargestDifference(films[0], films[1]);
  report.Expect(most < 1e-6, fmt::format("the winding changes a pixel by {}", most));
}

void FieldsOfView(Report& report) {
  for (const double fov : {1e-3, 60.0, 179.9}) {
    Scene scene = NewScene();
    scene.cameras[0].projection = Perspective{fov};
    scene.materials = {Matt(), Glass(1.5)};
    scene.objects = {
        {"", Sphere{{0, 0, -4}, 1}, 0},
        {"", Sphere{{0, 0, 4}, 1}, 1},
        {"", Quad{{Vec3d(-1e5, -1e5, -9), {1e5, -1e5, -9}, {1e5, 1e5, -9}, {-1e5, 1e5, -9}}}, 0}};
    scene.lights = {LampAt({1, 1, 0})};
    const Film film = RenderSmall(report, scene);
    if (film.rgb.empty()) continue;
    const float middle = film.pixel(20, 15)[0];
    report.Expect(middle != 0.5f, fmt::format("nothing ahead at {} degrees", fov));
  }
}

}  // namespace sheaf::stress
