// Whole pictures of scenes at the edges of what can be described.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <string>
#include <utility>

#include "sheaf/render.h"
#include "src/formats/scene_json.h"
#include "src/lab/picture_metrics.h"
#include "src/lab/probe.h"
#include "src/lab/stress.h"
#include "src/scene/transform.h"

namespace sheaf::stress {
namespace {

// The film by the scalar baseline; `report` learns where a target has other bits, and of pixels
// that are not finite.
Film RenderEverywhere(Report& report, const Scene& scene, RenderOptions options) {
  options.target = Target::Scalar();
  const Result<Film> expected = Render(scene, scene.cameras.at(0), options);
  report.Expect(expected.ok(), "the frame does not render");
  if (!expected) return {};
  for (const float value : expected.value().rgb) {
    report.Expect(std::isfinite(value), "a pixel is not finite");
  }
  ForEachTarget(report, [&](Target target) {
    options.target = target;
    const Result<Film> film = Render(scene, scene.cameras.at(0), options);
    const bool same = film && CompareFilms(expected.value(), film.value(), 0).pixels == 0;
    report.Expect(same, target.name() + " has other bits than src/scalar");
  });
  return expected.value();
}

RenderOptions Small(const Scene& scene) {
  RenderOptions options;
  options.width = 40;
  options.height = 30;
  options.max_depth = scene.settings.max_depth;
  return options;
}

Film RenderSmall(Report& report, const Scene& scene) {
  return RenderEverywhere(report, scene, Small(scene));
}

// A camera at the origin that looks along -z, before a grey background.
Scene NewScene() {
  Scene scene;
  scene.settings.background = Colour(0.5);
  scene.cameras = {{"eye", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, Perspective{60}}};
  return scene;
}

Material Matt() {
  Material material;
  material.name = "matt";
  material.kd = 0.8;
  material.ks = 0.4;
  material.shininess = 20;
  return material;
}

Material Glass(double ior) {
  Material material;
  material.name = "glass";
  material.transmit = Colour(1.0);
  material.ior = ior;
  return material;
}

Light LampAt(const Vec3d& position) {
  Light light;
  light.name = "lamp";
  light.source = PointLight{position, {1, 0, 0}};
  return light;
}

void ExpectUniform(Report& report, const Film& film, double low, double high) {
  for (const float value : film.rgb) {
    const double v = static_cast<double>(value);
    report.Expect(v >= low && v <= high, fmt::format("a pixel is {}, not {} to {}", v, low, high));
  }
}

// Light is neither made nor lost in clear glass, however surfaces nest: all of it is background.
void NestedGlass(Report& report) {
  Scene scene = NewScene();
  scene.settings.max_depth = 40;
  scene.materials = {Glass(1.5), Glass(1.33)};
  scene.objects = {{"around the eye", Sphere{{0, 0, 0}, 1}, 0},
                   {"bubble in it", Sphere{{0, 0, -0.5}, 0.25}, 1},
                   {"touching from outside", Sphere{{0, 0, -2}, 1}, 0},
                   {"concentric", Sphere{{0, 0, -2}, 0.5}, 1}};
  RenderOptions options = Small(scene);
  options.width = 12;
  options.height = 9;
  options.max_depth = 14;
  ExpectUniform(report, RenderEverywhere(report, scene, options), 0.2, 0.5 + 1e-5);
}

void ClearGlass(Report& report) {
  Scene scene = NewScene();
  scene.materials = {Glass(1)};
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0}};
  ExpectUniform(report, RenderSmall(report, scene), 0.5, 0.5);
  RenderStats stats;
  const Result<Film> film = Render(scene, scene.cameras[0], Small(scene), &stats);
  report.Expect(film.ok() && stats.rays.refracted > 0, "nothing goes through");
  report.Expect(stats.rays.reflected == 0, "something is reflected");
}

// Indices so far apart that nearly all is reflected, or nearly every angle is beyond the critical.
void ExtremeGlass(Report& report) {
  for (const double ior : {1e-3, 0.5, 1e3}) {
    Scene scene = NewScene();
    scene.settings.max_depth = 8;
    scene.materials = {Glass(ior)};
    scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0},
                     {"", Quad{{Vec3d(-3, -2, 1), {3, -2, 1}, {3, -2, -9}, {-3, -2, -9}}}, 0}};
    ExpectUniform(report, RenderSmall(report, scene), 0, 0.5 + 1e-5);
  }
}

// Between two mirrors, a ray to the limit: the number of rays stays that of the pixels.
void HallOfMirrors(Report& report) {
  Scene scene = NewScene();
  Material mirror;
  mirror.reflect = Colour(1.0);
  scene.materials = {mirror};
  for (const double z : {-5.0, 5.0}) {
    scene.objects.push_back(
        {"", Quad{{Vec3d(-1e6, -1e6, z), {1e6, -1e6, z}, {1e6, 1e6, z}, {-1e6, 1e6, z}}}, 0});
  }
  RenderOptions options = Small(scene);
  options.width = options.height = 4;
  options.max_depth = report.is_thorough() ? 10000 : 1000;
  RenderEverywhere(report, scene, options);
  RenderStats stats;
  const Result<Film> film = Render(scene, scene.cameras[0], options, &stats);
  // What is deeper counts, and is black.
  const std::uint64_t all = 16u * static_cast<std::uint64_t>(options.max_depth + 1);
  report.Expect(film.ok() && stats.rays.reflected == all,
                fmt::format("{} reflected rays, not {}", stats.rays.reflected, all));
}

// Inside a sphere that glows with 1 and reflects a half: 1 + 1/2 + 1/4 + ... to the depth limit.
void MirrorSeries(Report& report) {
  Scene scene = NewScene();
  scene.settings.ambient = Colour(1.0);
  scene.settings.max_depth = 12;
  Material mirror;
  mirror.ambient = 1;
  mirror.reflect = Colour(0.5);
  scene.materials = {mirror};
  scene.objects = {{"", Sphere{{0.1, 0.2, 0.3}, 3}, 0}};
  const double sum = 2 - std::ldexp(1, -12);
  ExpectUniform(report, RenderSmall(report, scene), sum, sum);
}

void LightsInTheWay(Report& report) {
  Scene scene = NewScene();
  scene.materials = {Matt()};
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0},
                   {"", Quad{{Vec3d(-4, -1, 0), {4, -1, 0}, {4, -1, -8}, {-4, -1, -8}}}, 0}};
  for (const Vec3d& place : {Vec3d(0, 0, -3), Vec3d(0, 0, -4), Vec3d(1, -1, -3), Vec3d(0, 0, 0),
                             Vec3d(0, 1, -4), Vec3d(2, -1 - 1e-9, -4)}) {
    scene.lights = {LampAt(place)};
    std::get<PointLight>(scene.lights[0].source).falloff = {0, 0, 1};
    RenderSmall(report, scene);
  }
  // A light within the ball lights nothing outside it.
  scene.settings.background = Colour(0.0);
  scene.lights = {LampAt({0, 0, -4})};
  ExpectUniform(report, RenderSmall(report, scene), 0, 0);
}

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

void Shininess(Report& report) {
  for (const double shininess : {0.0, 1.0, 1e6}) {
    Scene scene = NewScene();
    scene.materials = {Matt()};
    scene.materials[0].shininess = shininess;
    scene.objects = {{"", Sphere{{0, 0, -4}, 2}, 0}};
    scene.lights = {LampAt({0, 0, 0}), LampAt({3, 3, 0})};
    RenderSmall(report, scene);
  }
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

// A closed convex ball of triangles, as far from round as `rings` is low, with the normals of a
// round one.
Mesh SmoothBall(std::uint32_t rings) {
  Shapes shapes;
  AddSphereMesh(shapes, {0, 0, 0}, 1, rings);
  Mesh ball;
  for (std::uint32_t i = 0; i < shapes.vertex_count(); ++i) {
    const Vec out = shapes.vertex(i);
    ball.positions.emplace_back(out.x, out.y, out.z);
  }
  ball.normals = ball.positions;
  for (std::size_t i = 0; i < shapes.indices.size(); i += 3) {
    ball.triangles.push_back({shapes.indices[i], shapes.indices[i + 1], shapes.indices[i + 2]});
  }
  return ball;
}

// Faces that turn away from a light are dark and no others are shadowed: a convex body casts no
// shadow on itself that its faces' normals do not tell already.
void ShadowTerminator(Report& report) {
  for (const std::uint32_t rings : {3u, 5u, 12u}) {
    Film films[2];
    for (const bool shadows : {false, true}) {
      Scene scene = NewScene();
      scene.cameras[0].eye = Vec3d(0, 0.5, 3);
      scene.settings.background = Colour(0.0);
      Material white;
      white.kd = 1;
      scene.materials = {white};
      scene.objects = {{"ball", SmoothBall(rings), 0}};
      scene.lights = {LampAt({3, 1, 0.5}),
                      {"sun", DirectionalLight{{0.3, -1, -0.2}}, Colour(1.0), 1, true}};
      for (Light& light : scene.lights) light.casts_shadows = shadows;
      films[shadows] = RenderSmall(report, scene);
    }
    report.Expect(CompareFilms(films[0], films[1], 0).pixels == 0,
                  fmt::format("a ball of {} rings shadows itself", rings));
    const auto [low, high] = std::minmax_element(films[1].rgb.begin(), films[1].rgb.end());
    report.Expect(low != films[1].rgb.end() && *low == 0 && *high > 0.5f, "no dark or no lit side");
  }
}

double LargestDifference(const Film& a, const Film& b) {
  double most = a.rgb.size() == b.rgb.size() ? 0 : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.rgb.size() && i < b.rgb.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(a.rgb[i] - b.rgb[i])));
  }
  return most;
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

void OverbrightSurfaces(Report& report) {
  Scene scene = NewScene();
  scene.materials = {Matt()};
  scene.materials[0].kd = scene.materials[0].ks = 1;
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0}};
  scene.lights = {LampAt({0, 0, 0})};
  const Film film = RenderSmall(report, scene);
  float most = 0;
  for (const float value : film.rgb) most = std::max(most, value);
  report.Expect(most > 1, "kd + ks > 1 is clamped before the picture is written");
}

// Many faint lights add up to a bright one.
void ManyLights(Report& report) {
  constexpr int kCount = 1000000;
  Scene scene = NewScene();
  scene.materials = {Matt()};
  scene.objects = {{"", Sphere{{0, 0, -4}, 1}, 0}};
  scene.lights = {LampAt({2, 2, 0})};
  RenderOptions options = Small(scene);
  options.width = 4;
  options.height = 3;
  const Film one = RenderEverywhere(report, scene, options);
  scene.lights.assign(kCount, scene.lights[0]);
  for (Light& light : scene.lights) light.intensity = 1.0 / kCount;
  const Film many = RenderEverywhere(report, scene, options);
  for (std::size_t i = 0; i < one.rgb.size(); ++i) {
    // A float sum of n terms may err by n roundoffs.
    const double slack = 1e-6 + 6e-8 * kCount * static_cast<double>(one.rgb[i]);
    report.Expect(
        std::abs(static_cast<double>(many.rgb[i] - one.rgb[i])) <= slack,
        fmt::format("{} faint lights give {} and one {}", kCount, many.rgb[i], one.rgb[i]));
  }
}

// A floor of many triangles under a low sun, at any scale and place, has no acne: all of it is lit.
// Far away its corners are rounded to a part of a cell, which tilts the cells a little.
Mesh Floor(const Vec3d& at, double size) {
  constexpr std::uint32_t kCells = 8;
  Mesh floor;
  for (std::uint32_t z = 0; z <= kCells; ++z) {
    for (std::uint32_t x = 0; x <= kCells; ++x) {
      const Vec3d corner(2.0 * x / kCells - 1, 0.25 * (2.0 * x / kCells - 1), 1 - 2.0 * z / kCells);
      floor.positions.emplace_back(at + corner * size);
    }
  }
  for (std::uint32_t z = 0; z < kCells; ++z) {
    for (std::uint32_t x = 0; x < kCells; ++x) {
      const std::uint32_t first = z * (kCells + 1) + x, above = first + kCells + 1;
      floor.triangles.push_back({first, first + 1, above + 1});
      floor.triangles.push_back({first, above + 1, above});
    }
  }
  return floor;
}

void ScaledPictures(Report& report) {
  for (int power = -6; power <= 6; power += 2) {
    for (const double place : {0.0, 1e3, 1e6}) {
      const double s = std::pow(10.0, power);
      const Vec3d at = Vec3d(1, -1, 1) * (place * s);
      Scene scene = NewScene();
      scene.settings.background = Colour(0.0);
      scene.cameras[0].eye = at + Vec3d(-1, 12, 4) * s;
      scene.cameras[0].look_at = at;
      scene.cameras[0].up = Vec3d(0, 0, -1);
      Material white;
      white.kd = 1;
      scene.materials = {white};
      scene.objects = {{"floor", Floor(at, 50 * s), 0}};
      // Ten degrees above the floor's slope.
      scene.lights = {{"sun", DirectionalLight{{-1, -0.44, 0.1}}, Colour(1.0), 1, true}};
      const Film film = RenderSmall(report, scene);
      for (const float value : film.rgb) {
        report.Expect(value > 0.14f && value < 0.2f,
                      fmt::format("scale 1e{} at {}: a lit pixel is {}", power, place, value));
      }
    }
  }
}

constexpr Case kCases[] = {
    {"clear-glass", "ior 1: undeviated, no reflection", ClearGlass},
    {"extreme-glass", "ior 1e-3 to 1e3: no light is made, the same bits", ExtremeGlass},
    {"nested-glass", "nested and touching, the eye inside: no light is made", NestedGlass},
    {"hall-of-mirrors", "reflectance 1, deep: one ray a pixel and depth", HallOfMirrors},
    {"mirror-series", "reflectance 1/2 all around: the sum of the geometric series", MirrorSeries},
    {"lights-in-the-way", "a light at, on and in a surface: finite, the same bits", LightsInTheWay},
    {"bad-materials", "NaN, negative, overflowing, no number: an error of one line", BadMaterials},
    {"shininess", "0, 1 and 1e6: no NaN", Shininess},
    {"mirrored-winding", "either winding: the normal faces the eye", MirroredWinding},
    {"transforms", "singular: an error with its place; mirrored: the right normals", Transforms},
    {"shadow-terminator", "coarse balls with smooth normals: no shadow of their own",
     ShadowTerminator},
    {"odd-sizes", "1x1, 1xN, primes: the same bits as the crop", OddSizes},
    {"nothing", "no objects, no lights, no pixels: background, ambient, an error", Nothing},
    {"fields-of-view", "1e-3 and 179.9 degrees: finite, the same bits", FieldsOfView},
    {"overbright-surfaces", "kd + ks > 1: more than white, as it is", OverbrightSurfaces},
    {"many-lights", "a million faint lights are one bright one", ManyLights},
    {"scaled-pictures", "1e-6 to 1e6 in size, moved by 1e6 of it: no acne", ScaledPictures},
};

}  // namespace

std::span<const Case> PictureCases() { return kCases; }

}  // namespace sheaf::stress
