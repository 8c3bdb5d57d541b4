// What vertices carry besides normals and colours: alphas, and a second set of coordinates. Values
// by hand, and the same bits on every target.
#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <vector>

#include "bits.h"
#include "model_files.h"
#include "same_bits.h"
#include "sheet_scene.h"
#include "src/formats/png.h"
#include "src/formats/write_scene_json.h"
#include "src/scalar/surface.h"
#include "src/scalar/triangle.h"
#include "targets.h"
#include "test_frames.h"

namespace sheaf {
namespace {

Mesh& MeshOf(Object& object) { return std::get<Mesh>(object.shape); }

// A sheet whose alpha grows from 0 on the left to 1 on the right.
Object FadingSheet(double z, std::uint32_t material) {
  Object sheet = Sheet(z, material);
  MeshOf(sheet).alphas = {0, 1, 1, 0};
  return sheet;
}

Scene FadingScene(const Alpha& alpha) {
  Material veil;
  veil.ambient = 1;
  veil.alpha = alpha;
  Scene scene = SheetScene(veil);
  scene.objects = {FadingSheet(0, 0)};
  return scene;
}

TEST_CASE("the alpha of vertices is blended, and multiplies the material's") {
  const glm::dvec3 sky(0.25, 0.5, 0.75), white(1.0);
  const double across[] = {0.125, 0.375, 0.625, 0.875};
  for (const double factor : {1.0, 0.5}) {
    CAPTURE(factor);
    const auto blend = RowIn(FadingScene({AlphaMode::kBlend, factor, 0.5}), 4);
    for (std::size_t i = 0; i < 4; ++i) {
      const double alpha = factor * across[i];
      CheckColour(blend[i], white * alpha + sky * (1 - alpha));
    }
    const auto mask = RowIn(FadingScene({AlphaMode::kMask, factor, 0.3}), 4);
    for (std::size_t i = 0; i < 4; ++i) {
      CheckColour(mask[i], factor * across[i] >= 0.3 ? white : sky);
    }
  }
  const auto opaque = RowIn(FadingScene({}), 4);
  for (const glm::dvec3& colour : opaque) CheckColour(colour, white);

  Scene textured = FadingScene({AlphaMode::kBlend, 1, 0.5});
  textured.materials[0].base_colour = RowOf({Texel(255, 255, 255, 51), Texel(255, 255, 255, 51),
                                             Texel(255, 255, 255, 255), Texel(255, 255, 255, 255)});
  const auto product = RowIn(textured, 4);
  const double alphas[] = {0.2 * 0.125, 0.2 * 0.375, 0.625, 0.875};
  for (std::size_t i = 0; i < 4; ++i) {
    CheckColour(product[i], white * alphas[i] + sky * (1 - alphas[i]));
  }
}

TEST_CASE("shadows follow the alpha of vertices") {
  Scene scene = FadingScene({AlphaMode::kBlend, 1, 0.5});
  Material floor;
  floor.kd = 1;
  scene.materials.push_back(floor);
  // The eye stands between the floor and two veils.
  scene.objects = {FadingSheet(3, 0), FadingSheet(2, 0), Sheet(0, 1)};
  scene.cameras[0].eye = {0, 0, 1};
  scene.lights = {{"sun", DirectionalLight{{0, 0, -1}}, Colour(1.0), 1.0}};
  const auto blend = RowIn(scene, 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const double gap = 1 - (0.125 + 0.25 * static_cast<double>(i));
    CheckColour(blend[i], glm::dvec3(gap * gap));
  }
  scene.materials[0].alpha.mode = AlphaMode::kMask;
  const auto mask = RowIn(scene, 4);
  for (std::size_t i = 0; i < 4; ++i) CheckColour(mask[i], glm::dvec3(i < 2 ? 1 : 0));
}

TEST_CASE("each texture lies by its own set of coordinates") {
  Material material;
  material.ambient = 1;
  material.base_colour = RowOf({Texel(255, 0, 0), Texel(0, 255, 0)});
  material.occlusion = {RowOf({Texel(255, 0, 0), Texel(51, 0, 0)}), 1};
  material.occlusion->texture.set = 1;
  Scene scene = SheetScene(material);
  // The second set runs against x.
  MeshOf(scene.objects[0]).uv2 = {{1, 1}, {0, 1}, {0, 0}, {1, 0}};
  auto row = RowIn(scene, 2);
  CheckColour(row[0], {0.2, 0, 0});
  CheckColour(row[1], {0, 1, 0});
  std::get<Texture>(scene.materials[0].base_colour).set = 1;
  scene.materials[0].occlusion->texture.set = 0;
  row = RowIn(scene, 2);
  CheckColour(row[0], {0, 1, 0});
  CheckColour(row[1], {0.2, 0, 0});

  SUBCASE("shapes without a second set have the first in its place") {
    MeshOf(scene.objects[0]).uv2.clear();
    row = RowIn(scene, 2);
    CheckColour(row[0], {1, 0, 0});
    CheckColour(row[1], {0, 0.2, 0});
    // Beside a mesh that has one.
    Object far = Sheet(-9, 0);
    MeshOf(far).uv2 = MeshOf(far).uv;
    scene.objects.push_back(far);
    CHECK(RowIn(scene, 2) == row);
    scene.objects[0].shape = Quad{{Vec3d(-1, 1, 0), {1, 1, 0}, {1, -1, 0}, {-1, -1, 0}}};
    CHECK(RowIn(scene, 2) == row);
    scene.objects[0].shape = Disk{{0, 0, 0}, 1, {0, 0, 1}};
    CHECK(RowIn(scene, 2) == row);
    scene.objects[0].shape = Sphere{{0, 0, 0}, 1};
    row = RowIn(scene, 2);
    scene.objects.pop_back();
    CHECK(RowIn(scene, 2) == row);
  }
  SUBCASE("a normal map leans along its own") {
    Material bumpy;
    bumpy.kd = 1;
    bumpy.normal_map = {RowOf({Texel(200, 128, 220)}), 1};
    bumpy.normal_map->texture.set = 1;
    scene.materials[0] = bumpy;
    scene.lights = {{"", DirectionalLight{{-1, 0, -1}}, Colour(1.0), 1}};
    const auto against = RowIn(scene, 1);
    scene.materials[0].normal_map->texture.set = 0;
    const auto along = RowIn(scene, 1);
    CHECK(along[0].x > 0.9);
    CHECK(against[0].x < 0.5);
  }
  SUBCASE("levels are those of the set's own footprint") {
    // A texel in two is white: from afar all is grey, but by the first set near.
    std::vector<std::uint32_t> stripes;
    for (int i = 0; i < 64; ++i) stripes.push_back(i % 2 ? Texel(255, 255, 255) : Texel(0, 0, 0));
    Texture striped{std::make_shared<const Image>(Image{"", 64, 1, stripes}), Transfer::kLinear};
    striped.set = 1;
    Material painted;
    painted.ambient = 1;
    painted.base_colour = striped;
    scene.materials[0] = painted;
    for (glm::vec2& uv : MeshOf(scene.objects[0]).uv) uv *= 1.0f / 64;
    // Not all of five pixels meet a middle between two texels, where one look at the image is grey.
    for (const glm::dvec3& colour : RowIn(scene, 5)) {
      CHECK(colour.x == doctest::Approx(0.5).epsilon(0.01));
    }
    std::get<Texture>(scene.materials[0].base_colour).set = 0;
    CHECK(RowIn(scene, 4)[0].x < 0.4);
  }
}

TEST_CASE_TEMPLATE("alphas and second coordinates of surfaces", Real, float, double) {
  Random random(5);
  Scene described;
  described.materials.push_back({});
  described.materials[0].alpha.mode = AlphaMode::kBlend;
  Texture texture{std::make_shared<const Image>(Image{"", 4, 1, {1, 2, 3, 4}})};
  texture.set = 1;
  described.materials[0].base_colour = texture;
  Mesh mesh = RandomMesh(random, 12);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.alphas.push_back(static_cast<float>(Uniform(random, 0, 1)));
    mesh.uv2.push_back(glm::vec2(UniformPoint(random, -2, 2)));
  }
  described.objects = {{"mesh", mesh, 0}};
  const CompiledScene<Real> scene = CompileScene<Real>(described);
  const auto triangles = scene.geometry().triangles;
  constexpr std::uint32_t kNeeds = kNeedsVertexAlpha | kNeedsSecondSet;
  REQUIRE((scene.materials[0].needs & kNeeds) == kNeeds);
  for (const std::uint32_t count : {1u, 2u, 7u, 8u, 16u, 17u, 33u, 200u}) {
    HitStream<Real> hits;
    AlignedArray<std::uint32_t> ray, index, primitive;
    hits.Allocate(count);
    for (auto* list : {&ray, &index, &primitive}) list->Allocate(StreamCapacity(count));
    const auto hit = hits.output();
    std::vector<scalar::Surface<Real>> want(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      ray[i] = count - 1 - i;
      index[i] = primitive[i] = static_cast<std::uint32_t>(random() % 12);
      hit.u[ray[i]] = static_cast<Real>(Uniform(random, 0, 0.5));
      hit.v[ray[i]] = static_cast<Real>(Uniform(random, 0, 0.5));
      const scalar::Hit<Real> here = {1, index[i], hit.u[ray[i]], hit.v[ray[i]]};
      const scalar::Ray<Real> any{{0, 0, 0}, {0, 0, 1}};
      want[i] = scalar::TriangleSurface(any, here, triangles, index[i]);
    }
    const HitBatch batch{ray.data(), index.data(), primitive.data(), count};
    ForEachTarget([&](Target target) {
      SurfaceStream<Real> surfaces;
      surfaces.Allocate(count);
      StrictKernels<Real>(target.id())
          .blend_vertices(triangles, hits.view(), batch, kNeeds, surfaces.output());
      const auto got = surfaces.view();
      for (std::uint32_t i = 0; i < count; ++i) {
        REQUIRE(SameBits(want[i].alpha, got.alpha[i]));
        REQUIRE(SameBits(want[i].u2, got.u2[i]));
        REQUIRE(SameBits(want[i].v2, got.v2[i]));
      }
    });
  }
}

// All shapes, alphas in every mode, textures of either set, with levels and without.
TEST_CASE("frames with what vertices carry have the same bits on every target") {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    Scene scene = EverythingScene(seed);
    Random random(seed);
    auto image = std::make_shared<Image>(Image{"", 9, 16, {}});
    for (int i = 0; i < 144; ++i) image->texels.push_back(static_cast<std::uint32_t>(random()));
    const auto texture = [&](int set) {
      Texture made{image, Transfer::kLinear};
      if (random() % 3 == 0) made.filter = Filter::kLinear;
      made.set = set;
      return made;
    };
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
      Material& material = scene.materials[i];
      const int set = static_cast<int>(i % 2);
      if (i % 3 != 0) material.base_colour = texture(set);
      if (i % 3 != 1) material.occlusion = {texture(1 - set), 0.7};
      if (i % 2 != 0) material.normal_map = {texture(static_cast<int>(i / 2 % 2)), 0.6};
      const AlphaMode modes[] = {AlphaMode::kOpaque, AlphaMode::kMask, AlphaMode::kBlend};
      material.alpha = {modes[(i + seed) % 3], 0.9, 0.4};
    }
    for (std::uint32_t material = 0; material < 6; ++material) {
      Mesh mesh = RandomMesh(random, 3);
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (material % 3 != 2) mesh.alphas.push_back(static_cast<float>(Uniform(random, 0, 1)));
        if (material % 3 != 1) mesh.uv2.push_back(glm::vec2(UniformPoint(random, -2, 2)));
      }
      scene.objects.push_back({"", mesh, material});
    }
    scene.objects.push_back({"", Disk{{0, -3, 0}, 9, {0.1, 1, 0.2}}, 1});
    RenderOptions options;
    options.width = 61, options.height = 47;
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      options.precision = precision;
      for (const Camera& camera : scene.cameras) CheckSameBits(scene, camera, options);
    }
  }
}

TEST_CASE("alphas and second coordinates in scene files") {
  const Folder folder;
  REQUIRE(WritePng({1, 1, {10, 20, 30}}, Transfer::kLinear, folder / "t.png").ok());
  const auto text = [](const std::string& set, const std::string& mesh) {
    return R"({"materials": [{"name": "a", "alpha": {"mode": "blend"},
      "occlusion": {"texture": {"image": "t.png", "set": )" +
           set + R"(}}}],
      "objects": [{"material": "a", "mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                   "triangles": [[0, 1, 2]], )" +
           mesh + R"(}}], "cameras": [{"name": "c", "eye": [0, 0, 5], "look_at": [0, 0, 0]}]})";
  };
  const std::string sound = R"("alphas": [0, 0.3, 1], "uv2": [[0, 1], [0.1, 0], [-3, 9]])";
  const Scene first = ReadOrFail(folder.Write("a.json", text("1", sound)));
  const Scene again = ReadOrFail(folder.Write("b.json", SceneJsonText(first)));
  for (const Scene* scene : {&first, &again}) {
    CHECK(scene->materials[0].occlusion->texture.set == 1);
    CHECK(MeshAt(*scene, 0).alphas == std::vector<float>{0, 0.3f, 1});
    CHECK(MeshAt(*scene, 0).uv2 == std::vector<glm::vec2>{{0, 1}, {0.1f, 0}, {-3, 9}});
  }
  const auto refuse = [&](const std::string& set, const std::string& mesh, const char* place) {
    CheckRefused(folder.Write("c.json", text(set, mesh)), place);
  };
  refuse("2", sound, "/materials/0/occlusion/texture/set");
  refuse("1", R"("alphas": [0, 1])", "2 elements for 3 positions");
  refuse("1", R"("alphas": [0, 1, 1.5])", "/objects/0/mesh/alphas/2");
  refuse("1", R"("uv2": [[0, 1]])", "1 elements for 3 positions");

  Scene wrong = first;
  MeshOf(wrong.objects[0]).alphas[1] = 2;
  CHECK(Validate(wrong).error().message.find("one of the alphas") != std::string::npos);
  MeshOf(wrong.objects[0]).alphas.pop_back();
  CHECK(Validate(wrong).error().message.find("2 alphas for 3 vertices") != std::string::npos);
  wrong = first;
  wrong.materials[0].occlusion->texture.set = 2;
  CHECK(Validate(wrong).error().message.find("occlusion.set") != std::string::npos);
}

}  // namespace
}  // namespace sheaf
