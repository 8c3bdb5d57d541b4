// What varies from point to point on a surface: emission, metal, roughness, occlusion, normals,
// alpha. Values by hand, and the same bits on every target.
#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "model_files.h"
#include "same_bits.h"
#include "sheaf/render.h"
#include "sheet_scene.h"
#include "src/formats/png.h"
#include "src/formats/write_scene_json.h"
#include "test_frames.h"

namespace sheaf {
namespace {

TEST_CASE("emission is the factor times the texture, occlusion takes ambient light") {
  Material material;
  material.emission = {2, 1, 0.5};
  material.emission_texture = RowOf({Texel(255, 0, 51), Texel(0, 102, 255)});
  const auto glow = RowIn(SheetScene(material), 2);
  CheckColour(glow[0], {2, 0, 0.1});
  CheckColour(glow[1], {0, 0.4, 0.5});

  Material shaded;
  shaded.ambient = 0.5;
  shaded.occlusion = {RowOf({Texel(255, 0, 0), Texel(0, 255, 255)}), 0.75};
  const auto corners = RowIn(SheetScene(shaded), 2);
  CheckColour(corners[0], glm::dvec3(0.5));
  CheckColour(corners[1], glm::dvec3(0.125));
}

TEST_CASE("metal and roughness are Whitted's terms at each point") {
  Material varied;
  varied.base_colour = Colour(0.8, 0.4, 0.2);
  varied.ambient = 0.25;
  varied.kd = 1;
  varied.metallic_roughness = {RowOf({Texel(0, 51, 255), Texel(0, 204, 0)}), 1, 1};
  Scene scene = SheetScene(varied);
  scene.settings.integrator = Integrator::kWhitted;
  scene.lights = {{"", DirectionalLight{{0.3, 0.1, -1}}, Colour(1.0), 0.7}};
  const auto got = RowIn(scene, 2);
  // Smooth metal, then rough plastic, by the table in docs/formats.md.
  const double metallic[] = {1, 0}, roughness[] = {0.2, 0.8};
  for (int i = 0; i < 2; ++i) {
    const double m = metallic[i], r = roughness[i], mirror = m * (1 - r) * (1 - r);
    Material plain = varied;
    plain.metallic_roughness.reset();
    plain.ambient = 0.25 * (1 - mirror);
    plain.kd = 1 - m * (1 - r);
    plain.ks = (0.2 + 0.6 * m) * (1 - r);
    plain.shininess = 2 / std::pow(r, 4) - 2;
    if (mirror > 0.02) plain.reflect = Colour(0.8, 0.4, 0.2) * mirror;
    Scene same = scene;
    same.materials = {plain};
    const auto want = RowIn(same, 2)[static_cast<std::size_t>(i)];
    for (int c = 0; c < 3; ++c) {
      CHECK(got[static_cast<std::size_t>(i)][c] == doctest::Approx(want[c]).epsilon(1e-4));
    }
  }
}

// The same samples are drawn for a texture of metal and roughness as for materials of one each.
TEST_CASE("to paths a rough metal is a rough mirror at each point") {
  Material varied;
  varied.base_colour = Colour(0.8, 0.4, 0.2);
  varied.kd = 1;
  varied.metallic_roughness = {RowOf({Texel(0, 102, 255), Texel(0, 204, 255)}), 1, 1};
  Scene scene = SheetScene(varied);
  scene.settings.environment = Gradient{Colour(0.1), Colour(0.9, 0.5, 0.3), Colour(0.0)};
  scene.settings.samples = 64;
  scene.settings.integrator = Integrator::kPath;
  const auto got = RowIn(scene, 2);
  const double roughness[] = {0.4, 0.8};
  for (std::size_t i = 0; i < 2; ++i) {
    Material plain = varied;
    plain.metallic_roughness.reset();
    plain.kd = 0;
    plain.reflect = Colour(0.8, 0.4, 0.2);
    plain.roughness = roughness[i];
    Scene same = scene;
    same.materials = {plain};
    const auto want = RowIn(same, 2)[i];
    for (int c = 0; c < 3; ++c) CHECK(got[i][c] == doctest::Approx(want[c]).epsilon(4e-3));
    CHECK(got[i].x > 0.01);
    // Without a texture it is that material to the bit.
    same.materials[0].reflect = Colour(0.0);
    same.materials[0].kd = 1;
    same.materials[0].metallic_roughness = {{}, 1, roughness[i]};
    CHECK(RowIn(same, 2)[i] == want);
  }
}

TEST_CASE("a highlight beside textures of metal has the strength that the material says") {
  Material varied;
  varied.kd = 0;
  varied.metallic_roughness = {RowOf({Texel(0, 128, 0), Texel(0, 128, 255)}), 1, 1};
  Scene scene = SheetScene(varied);
  scene.lights = {{"", DirectionalLight{{0, 0, -1}}, Colour(1.0), 1.0}};
  scene.settings.ambient = scene.settings.background = Colour(0.0);
  const auto usual = RowIn(scene, 2);
  scene.materials[0].metallic_roughness->specular = 3;
  const auto strong = RowIn(scene, 2);
  CheckColour(strong[0], usual[0] * 3.0);  // no metal
  CHECK(strong[1] == usual[1]);
}

TEST_CASE("what a texture lets through is not there for light and ambient light, and is seen") {
  Material pane;
  pane.ambient = 0.5;
  pane.transmit = {1, 0.5, 0};
  pane.transmission = {RowOf({Texel(0, 0, 0), Texel(51, 255, 255), Texel(255, 0, 0)}), 0.5};
  const glm::dvec3 sky(0.25, 0.5, 0.75), white(1.0);
  const auto seen = RowIn(SheetScene(pane), 3);
  const double red[] = {0, 0.2, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    CheckColour(seen[i], white * (0.5 * (1 - 0.5 * red[i])) + pane.transmit * red[i] * sky);
  }
  // Light behind it goes on likewise.
  Scene scene = SheetScene(pane);
  Material floor;
  floor.kd = 1;
  scene.materials.push_back(floor);
  scene.objects = {Sheet(3, 0), Sheet(0, 1)};
  scene.cameras[0].eye = {0, 0, 1};
  scene.lights = {{"sun", DirectionalLight{{0, 0, -1}}, Colour(1.0), 1.0}};
  const auto lit = RowIn(scene, 3);
  for (std::size_t i = 0; i < 3; ++i) CheckColour(lit[i], pane.transmit * red[i]);
}

// n . l of a normal that a texel (r, g, b) gives on the sheet.
double Lambert(const glm::dvec3& texel, const glm::dvec3& to_light) {
  const glm::dvec3 n = 2.0 * (texel / 255.0) - 1.0;
  const auto dot = [](const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  };
  return dot(n, to_light) / std::sqrt(dot(n, n) * dot(to_light, to_light));
}

TEST_CASE("normal maps lean to u and against v, on both sides and in mirrored coordinates") {
  Material bumpy;
  bumpy.kd = 1;
  bumpy.normal_map = {RowOf({Texel(200, 100, 220), Texel(60, 180, 200)}), 1};
  Scene scene = SheetScene(bumpy);
  const glm::dvec3 to_light(0.4, -0.3, 1);
  scene.lights = {{"", DirectionalLight{-to_light}, Colour(1.0), 1.0}};
  auto row = RowIn(scene, 2);
  CHECK(row[0].x == doctest::Approx(Lambert({200, 100, 220}, to_light)).epsilon(1e-5));
  CHECK(row[1].x == doctest::Approx(Lambert({60, 180, 200}, to_light)).epsilon(1e-5));

  SUBCASE("u runs the other way") {
    auto& mesh = std::get<Mesh>(scene.objects[0].shape);
    for (glm::vec2& uv : mesh.uv) uv.x = 1 - uv.x;
    row = RowIn(scene, 2);
    // The second texel is on the left, and its x leans to the left.
    const glm::dvec3 mirrored(-0.4, -0.3, 1);
    CHECK(row[0].x == doctest::Approx(Lambert({60, 180, 200}, mirrored)).epsilon(1e-5));
  }
  SUBCASE("seen from behind") {
    auto& mesh = std::get<Mesh>(scene.objects[0].shape);
    for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
    row = RowIn(scene, 2);
    // The front looks down: x and y stay along u and against v, and the normal is turned to the
    // eye.
    const glm::dvec3 below(-0.4, 0.3, 1);
    CHECK(row[0].x == doctest::Approx(Lambert({200, 100, 220}, below)).epsilon(1e-5));
  }
  SUBCASE("no coordinates that differ, no lean") {
    auto& mesh = std::get<Mesh>(scene.objects[0].shape);
    for (glm::vec2& uv : mesh.uv) uv = {0, 0};
    row = RowIn(scene, 2);
    CHECK(row[0].x == doctest::Approx(Lambert({127.5, 127.5, 255}, to_light)).epsilon(1e-5));
  }
}

Material Veil(AlphaMode mode, double factor) {
  Material veil;
  veil.base_colour = RowOf({Texel(255, 255, 255, 0), Texel(255, 255, 255, 127),
                            Texel(255, 255, 255, 128), Texel(255, 255, 255, 255)});
  veil.ambient = 1;
  veil.alpha = {mode, factor, 0.5};
  return veil;
}

TEST_CASE("what alpha leaves out shows what lies behind") {
  const glm::dvec3 sky(0.25, 0.5, 0.75), white(1.0);
  const auto opaque = RowIn(SheetScene(Veil(AlphaMode::kOpaque, 1)), 4);
  for (const glm::dvec3& colour : opaque) CheckColour(colour, white);
  const auto mask = RowIn(SheetScene(Veil(AlphaMode::kMask, 1)), 4);
  CheckColour(mask[0], sky);
  CheckColour(mask[1], sky);
  CheckColour(mask[2], white);
  CheckColour(mask[3], white);
  const auto blend = RowIn(SheetScene(Veil(AlphaMode::kBlend, 0.5)), 4);
  const double alphas[] = {0, 127 / 510.0, 128 / 510.0, 0.5};
  for (std::size_t i = 0; i < 4; ++i) {
    CheckColour(blend[i], white * alphas[i] + sky * (1 - alphas[i]));
  }
}

TEST_CASE("shadows follow alpha, through several sheets") {
  Scene scene = SheetScene(Veil(AlphaMode::kBlend, 1));
  Material floor;
  floor.kd = 1;
  scene.materials.push_back(floor);
  // The eye stands between the floor and the veils.
  scene.objects = {Sheet(3, 0), Sheet(2, 0), Sheet(0, 1)};
  scene.cameras[0].eye = {0, 0, 1};
  const double left[] = {1, 128 / 255.0, 127 / 255.0, 0};
  const Light lights[] = {{"sun", DirectionalLight{{0, 0, -1}}, Colour(1.0), 1.0},
                          {"lamp", PointLight{{0, 0, 1e5}, {1, 0, 0}}, Colour(1.0), 1.0}};
  for (const Light& light : lights) {
    CAPTURE(light.name);
    scene.lights = {light};
    scene.materials[0].alpha.mode = AlphaMode::kBlend;
    const auto blend = RowIn(scene, 4);
    for (std::size_t i = 0; i < 4; ++i) CheckColour(blend[i], glm::dvec3(left[i] * left[i]));
    scene.materials[0].alpha.mode = AlphaMode::kMask;
    const auto mask = RowIn(scene, 4);
    for (std::size_t i = 0; i < 4; ++i) CheckColour(mask[i], glm::dvec3(i < 2 ? 1 : 0));
  }
}

TEST_CASE("spheres have longitude and latitude") {
  // Eight columns around, seen from +z by a camera of which each pixel meets the middle of one.
  Material globe;
  globe.emission = Colour(1.0);
  globe.emission_texture =
      RowOf({0, Texel(32, 0, 0), Texel(64, 0, 0), Texel(96, 0, 0), Texel(128, 0, 0),
             Texel(160, 0, 0), Texel(192, 0, 0), Texel(224, 0, 0)});
  Scene scene = SheetScene(globe);
  scene.objects = {{"", Sphere{{0, 0, 0}, 1}, 0}};
  const auto seen = [&](const Vec3d& eye) {
    scene.cameras[0] = {"in", eye, {0, 0, 0}, {0, 1, 0.001}, Orthographic{1e-3}};
    RenderOptions options;
    options.width = 1, options.height = 1;
    return RenderOrFail(scene, scene.cameras[0], options).rgb[0] * 255 / 32;
  };
  for (int column = 0; column < 8; ++column) {
    const double angle = ((column + 0.5) / 8 - 0.5) * 2 * std::acos(-1.0);
    CHECK(seen({3 * std::sin(angle), 0.3, 3 * std::cos(angle)}) == doctest::Approx(column));
    CHECK(seen({0.3 * std::sin(angle), 0.03, 0.3 * std::cos(angle)}) ==
          doctest::Approx((column + 4) % 8));
  }
  const auto image = std::make_shared<const Image>(
      Image{"", 1, 4, {0, Texel(32, 0, 0), Texel(64, 0, 0), Texel(96, 0, 0)}});
  scene.materials[0].emission_texture->image = image;
  CHECK(seen({0, 3, 0.1}) == doctest::Approx(0));
  CHECK(seen({0, 1, 3}) == doctest::Approx(1));
  CHECK(seen({1, -1, 3}) == doctest::Approx(2));
  CHECK(seen({0, -3, 0.1}) == doctest::Approx(3));
}

TEST_CASE("coordinates are scaled, turned and moved") {
  Material material;
  material.emission = Colour(1.0);
  material.emission_texture =
      RowOf({Texel(0, 0, 0), Texel(85, 0, 0), Texel(170, 0, 0), Texel(255, 0, 0)});
  material.emission_texture->transform = {{0.5, 0}, {0.5, 1}, 0};
  auto row = RowIn(SheetScene(material), 4);
  const double moved[] = {170, 170, 255, 255};
  for (std::size_t i = 0; i < 4; ++i) CheckColour(row[i], {moved[i] / 255, 0, 0});
  // Half a turn about the origin, then moved back.
  material.emission_texture->transform = {{1, 1}, {1, 1}, 180};
  row = RowIn(SheetScene(material), 4);
  const double turned[] = {255, 170, 85, 0};
  for (std::size_t i = 0; i < 4; ++i) CheckColour(row[i], {turned[i] / 255, 0, 0});
}

Texture RandomTexture(Random& random) {
  auto image = std::make_shared<Image>(Image{"", 4, 3, {}});
  for (int i = 0; i < 12; ++i) image->texels.push_back(static_cast<std::uint32_t>(random()));
  constexpr Filter kFilters[] = {Filter::kMip, Filter::kLinear, Filter::kNearest};
  Texture texture{image, random() % 2 ? Transfer::kLinear : Transfer::kSrgb, Wrap::kMirror,
                  Wrap::kRepeat, kFilters[random() % 3]};
  if (random() % 2) {
    texture.transform = {{Uniform(random, -1, 1), 0.25}, {2, -1.5}, Uniform(random, -180, 180)};
  }
  return texture;
}

TEST_CASE("materials that vary have the same bits on every target") {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    CAPTURE(seed);
    Scene scene = EverythingScene(seed);
    Random random(seed);
    for (Material& material : scene.materials) {
      if (random() % 2) material.base_colour = RandomTexture(random);
      if (random() % 2) {
        material.emission = Colour(0.1, 0.2, 0.3);
        material.emission_texture = RandomTexture(random);
      }
      if (random() % 2) {
        material.metallic_roughness = {RandomTexture(random), 0.9, 0.8};
      } else if (random() % 2) {
        material.metallic_roughness = {{}, 0.6, 0.7};
      }
      if (random() % 2) material.occlusion = {RandomTexture(random), 0.7};
      if (random() % 2) material.transmission = {RandomTexture(random), 0.8};
      if (random() % 2) material.normal_map = {RandomTexture(random), 0.6};
      const AlphaMode modes[] = {AlphaMode::kOpaque, AlphaMode::kMask, AlphaMode::kBlend};
      material.alpha = {modes[random() % 3], Uniform(random, 0.3, 1), 0.4};
    }
    RenderOptions options;
    options.width = 61;
    options.height = 47;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Integrator integrator : kIntegrators) {
        options.integrator = integrator;
        CheckSameBits(scene, scene.cameras[0], options);
      }
    }
  }
}

TEST_CASE("filters are written and read back") {
  const Folder folder;
  REQUIRE(WritePng({1, 1, {10, 20, 30}}, Transfer::kLinear, folder / "t.png").ok());
  const std::string text = R"({"materials": [
    {"name": "a", "base_colour": {"texture": {"image": "t.png"}}},
    {"name": "b", "base_colour": {"texture": {"image": "t.png", "filter": "linear"}}},
    {"name": "c", "base_colour": {"checker": {"filter": true}}},
    {"name": "d", "base_colour": {"checker": {}}}],
    "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})";
  const Scene first = ReadOrFail(folder.Write("a.json", text));
  const Scene again = ReadOrFail(folder.Write("b.json", SceneJsonText(first)));
  for (const Scene* scene : {&first, &again}) {
    CHECK(std::get<Texture>(scene->materials[0].base_colour).filter == Filter::kMip);
    CHECK(std::get<Texture>(scene->materials[1].base_colour).filter == Filter::kLinear);
    CHECK(std::get<Checker>(scene->materials[2].base_colour).is_filtered);
    CHECK(!std::get<Checker>(scene->materials[3].base_colour).is_filtered);
  }
}

TEST_CASE("maps of materials are written and read back") {
  const Folder folder;
  REQUIRE(WritePng({1, 1, {10, 20, 30}}, Transfer::kLinear, folder / "t.png").ok());
  const std::string text = R"({"materials": [{"name": "a", "emission": 2,
    "emission_texture": {"image": "t.png", "transform": {"offset": [0.25, 0], "rotation": 30}},
    "metallic_roughness": {"texture": {"image": "t.png"}, "metallic": 0.25, "roughness": 0.5,
                           "specular": 1.5},
    "transmission": {"texture": {"image": "t.png"}, "share": 0.625},
    "occlusion": {"texture": {"image": "t.png"}, "strength": 0.75},
    "normal_map": {"texture": {"image": "t.png"}, "scale": -2},
    "alpha": {"mode": "mask", "factor": 0.5, "cutoff": 0.125}},
    {"name": "b", "metallic_roughness": {"metallic": 0.5}}],
    "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})";
  const Scene first = ReadOrFail(folder.Write("a.json", text));
  const Scene again = ReadOrFail(folder.Write("b.json", SceneJsonText(first)));
  for (const Scene* scene : {&first, &again}) {
    const Material& material = scene->materials[0];
    REQUIRE(material.emission_texture.has_value());
    CHECK(material.emission_texture->transfer == Transfer::kSrgb);
    CHECK(material.emission_texture->transform == TextureTransform{{0.25, 0}, {1, 1}, 30});
    REQUIRE(material.metallic_roughness.has_value());
    CHECK(material.metallic_roughness->texture.transfer == Transfer::kLinear);
    CHECK(material.metallic_roughness->metallic == 0.25);
    CHECK(material.metallic_roughness->roughness == 0.5);
    CHECK(material.metallic_roughness->specular == 1.5);
    REQUIRE(material.transmission.has_value());
    CHECK(material.transmission->share == 0.625);
    REQUIRE(material.occlusion.has_value());
    CHECK(material.occlusion->strength == 0.75);
    REQUIRE(material.normal_map.has_value());
    CHECK(material.normal_map->scale == -2);
    CHECK(material.alpha.mode == AlphaMode::kMask);
    CHECK(material.alpha.factor == 0.5);
    CHECK(material.alpha.cutoff == 0.125);
    REQUIRE(scene->materials[1].metallic_roughness.has_value());
    CHECK(scene->materials[1].metallic_roughness->texture.image == nullptr);
    CHECK(scene->materials[1].metallic_roughness->metallic == 0.5);
    CHECK(scene->materials[1].metallic_roughness->roughness == 1);
  }
  CheckRefused(folder.Write("c.json", R"({"materials": [{"name": "a",
    "alpha": {"mode": "cutout"}}], "cameras": []})"),
               "/materials/0/alpha/mode");
  CheckRefused(folder.Write("d.json", R"({"materials": [{"name": "a",
    "occlusion": {"strength": 2}}], "cameras": []})"),
               "/materials/0/occlusion");
}

}  // namespace
}  // namespace sheaf
