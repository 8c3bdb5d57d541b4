// What the materials and images of glTF become.
#include <doctest/doctest.h>
#include <png.h>

#include <cmath>
#include <string>
#include <vector>

#include "model_files.h"
#include "same_bits.h"
#include "src/scene/resolve_gloss.h"

namespace sheaf {
namespace {

// Two texels of red, of which the second has this alpha, as a data URI.
std::string Png(std::uint8_t alpha) {
  const std::uint8_t texels[] = {255, 0, 0, 255, 255, 0, 0, alpha};
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = 2, image.height = 1, image.format = PNG_FORMAT_RGBA;
  png_alloc_size_t size = 0;
  REQUIRE(png_image_write_to_memory(&image, nullptr, &size, 0, texels, 0, nullptr) != 0);
  std::string bytes(size, '\0');
  REQUIRE(png_image_write_to_memory(&image, bytes.data(), &size, 0, texels, 0, nullptr) != 0);
  return "data:image/png;base64," + Base64(bytes);
}

// 8 x 8 of red in four inks, as libjpeg-turbo writes them: with Adobe's segment.
constexpr const char* kInkJpeg =
    "data:image/jpeg;base64,"
    "/9j/7gAOQWRvYmUAZAAAAAAC/9sAQwADAgIDAgIDAwMDBAMDBAUIBQUEBAUKBwcGCAwKDAwLCgsLDQ4SEA0OEQ4LCx"
    "AWEBETFBUVFQwPFxgWFBgSFBUU/9sAQwEDBAQFBAUJBQUJFA0LDRQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQU"
    "FBQUFBQUFBQUFBQUFBQUFBQUFBQU/8AAFAgACAAIBAERAAIRAQMRAQQRAP/EAB8AAAEFAQEBAQEBAAAAAAAAAAABAg"
    "MEBQYHCAkKC//EALUQAAIBAwMCBAMFBQQEAAABfQECAwAEEQUSITFBBhNRYQcicRQygZGhCCNCscEVUtHwJDNicoIJ"
    "ChYXGBkaJSYnKCkqNDU2Nzg5OkNERUZHSElKU1RVVldYWVpjZGVmZ2hpanN0dXZ3eHl6g4SFhoeIiYqSk5SVlpeYmZ"
    "qio6Slpqeoqaqys7S1tre4ubrCw8TFxsfIycrS09TV1tfY2drh4uPk5ebn6Onq8fLz9PX29/j5+v/EAB8BAAMBAQEB"
    "AQEBAQEAAAAAAAABAgMEBQYHCAkKC//EALURAAIBAgQEAwQHBQQEAAECdwABAgMRBAUhMQYSQVEHYXETIjKBCBRCka"
    "GxwQkjM1LwFWJy0QoWJDThJfEXGBkaJicoKSo1Njc4OTpDREVGR0hJSlNUVVZXWFlaY2RlZmdoaWpzdHV2d3h5eoKD"
    "hIWGh4iJipKTlJWWl5iZmqKjpKWmp6ipqrKztLW2t7i5usLDxMXGx8jJytLT1NXW19jZ2uLj5OXm5+jp6vLz9PX29/"
    "j5+v/aAA4EAQACEQMRBAAAPwD6Ir9zP8qj9U6//9k=";

// A square before the eye, with coordinates, and one material of a texture of two images.
json TexturedGltf(const json& material) {
  std::string buffer = GltfBuffer();
  for (const auto& p : kSquare) {
    for (int i = 0; i < 2; ++i) Put(buffer, static_cast<float>(p[i]), false);
  }
  json gltf = SquareGltf();
  gltf["buffers"][0] = {{"byteLength", buffer.size()},
                        {"uri", "data:;charset=utf-8;base64," + Base64(buffer)}};
  gltf["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 100}, {"byteLength", 32}});
  gltf["accessors"].push_back(
      {{"bufferView", 5}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}});
  gltf["meshes"] = {{{"primitives",
                      {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 4}}},
                        {"indices", 1},
                        {"material", 0}}}}}};
  gltf["nodes"] = {{{"mesh", 0}}};
  gltf["scenes"] = {{{"nodes", {0}}}};
  gltf["images"] = {{{"uri", Png(255)}}, {{"uri", Png(0)}}};
  gltf["textures"] = {{{"source", 0}}, {{"source", 1}}};
  gltf["materials"] = {material};
  return gltf;
}

struct Read {
  Material material;
  std::vector<std::string> warnings;
  Scene scene;
};

Read ReadGltf(const json& gltf) {
  const Folder folder;
  auto result = ReadScene(folder.Write("a.gltf", gltf.dump()));
  CAPTURE(MessageOf(result));
  REQUIRE(result.ok());
  const Scene& scene = result.value().scene;
  RenderOptions options;
  options.width = 64, options.height = 48;
  CheckSameBits(scene, scene.cameras[0], options);
  return {scene.materials.at(0), result.value().warnings, scene};
}

// The one warning has this in it.
void CheckWarned(const Read& read, const std::string& part) {
  CAPTURE(part);
  REQUIRE(read.warnings.size() == 1);
  CHECK(read.warnings[0].find(part) != std::string::npos);
  CHECK(read.warnings[0].size() < 250);
}

const json kTexture0 = {{"index", 0}}, kTexture1 = {{"index", 1}};

TEST_CASE("glTF textures of emission, normals, gloss and occlusion") {
  json material = {{"pbrMetallicRoughness",
                    {{"metallicFactor", 0.5},
                     {"roughnessFactor", 0.25},
                     {"baseColorTexture", kTexture0},
                     {"metallicRoughnessTexture", kTexture1}}},
                   {"emissiveFactor", {1, 0.5, 0}},
                   {"emissiveTexture", kTexture1},
                   {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                   {"occlusionTexture", {{"index", 0}, {"strength", 0.75}}}};
  material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 4;
  const Read read = ReadGltf(TexturedGltf(material));
  const Material& m = read.material;
  CHECK(read.warnings.empty());
  CHECK(m.emission == Colour(4, 2, 0));
  REQUIRE(m.emission_texture);
  CHECK(m.emission_texture->transfer == Transfer::kSrgb);
  REQUIRE(m.metallic_roughness);
  CHECK(m.metallic_roughness->metallic == 0.5);
  CHECK(m.metallic_roughness->roughness == 0.25);
  CHECK(m.metallic_roughness->texture.transfer == Transfer::kLinear);
  CHECK(m.kd == 1);
  REQUIRE(m.normal_map);
  CHECK(m.normal_map->scale == 0.5);
  REQUIRE(m.occlusion);
  CHECK(m.occlusion->strength == 0.75);
  CHECK(m.alpha.mode == AlphaMode::kOpaque);
  CHECK(m.emission_texture->image == m.metallic_roughness->texture.image);  // read once
}

TEST_CASE("glTF alpha, where anything is transparent") {
  const auto read = [](const char* mode, const json& texture, double factor) {
    json pbr = {{"baseColorFactor", {1, 1, 1, factor}}};
    if (!texture.is_null()) pbr["baseColorTexture"] = texture;
    return ReadGltf(TexturedGltf(
                        {{"alphaMode", mode}, {"alphaCutoff", 0.3}, {"pbrMetallicRoughness", pbr}}))
        .material.alpha;
  };
  CHECK(read("MASK", kTexture1, 1).mode == AlphaMode::kMask);
  CHECK(read("MASK", kTexture1, 1).cutoff == 0.3);
  CHECK(read("BLEND", kTexture1, 0.5).mode == AlphaMode::kBlend);
  CHECK(read("BLEND", kTexture1, 0.5).factor == 0.5);
  CHECK(read("BLEND", nullptr, 0.25).factor == 0.25);
  CHECK(read("BLEND", nullptr, 0.25).mode == AlphaMode::kBlend);
  CHECK(read("BLEND", kTexture0, 1).mode == AlphaMode::kOpaque);
  CHECK(read("MASK", kTexture0, 0.5).mode == AlphaMode::kOpaque);
  CHECK(read("MASK", kTexture0, 0.2).mode == AlphaMode::kMask);
  CHECK(read("OPAQUE", kTexture1, 0.2).mode == AlphaMode::kOpaque);
}

TEST_CASE("glTF extensions that are required and harmless") {
  json unlit =
      TexturedGltf({{"extensions", {{"KHR_materials_unlit", json::object()}}},
                    {"pbrMetallicRoughness",
                     {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"baseColorTexture", kTexture0}}}});
  unlit["extensionsUsed"] =
      unlit["extensionsRequired"] = {"KHR_materials_unlit", "KHR_materials_variants"};
  const Read seen = ReadGltf(unlit);
  CHECK(seen.warnings.empty());
  CHECK(seen.material.emission == Colour(1, 0.5, 0.25));
  CHECK(seen.material.emission_texture);
  CHECK(Colour(seen.material.kd, seen.material.ks, seen.material.ambient) == Colour(0.0));

  json moved = kTexture0;
  moved["extensions"]["KHR_texture_transform"] = {
      {"scale", {0.25, 0.5}}, {"offset", {0.5, 1}}, {"rotation", std::acos(0.0)}};
  json gltf = TexturedGltf({{"pbrMetallicRoughness", {{"baseColorTexture", moved}}}});
  gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_texture_transform"};
  const Read read = ReadGltf(gltf);
  CHECK(read.warnings.empty());
  const auto transform = std::get<Texture>(read.material.base_colour).transform;
  CHECK(transform.scale == glm::dvec2(0.25, 0.5));
  CHECK(transform.offset == glm::dvec2(0.5, 1));
  CHECK(transform.rotation == doctest::Approx(90));

  gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_materials_clearcoat"};
  CheckWarned(ReadGltf(gltf), "KHR_materials_clearcoat");
}

TEST_CASE("glTF metals mirror, and shine with nothing else") {
  const auto read_only = [](double metallic, double roughness, const json& extensions) {
    return ReadGltf(TexturedGltf({{"extensions", extensions},
                                  {"pbrMetallicRoughness",
                                   {{"baseColorFactor", {1, 0.5, 0.25, 1}},
                                    {"metallicFactor", metallic},
                                    {"roughnessFactor", roughness}}}}))
        .material;
  };
  const auto read = [&](double metallic, double roughness, const json& extensions) {
    return ResolveGloss(read_only(metallic, roughness, extensions), GlossModel::kFading);
  };
  const Material polished = read(1, 0, json::object());
  CHECK(polished.ambient == 0);
  CHECK(polished.kd == 0);
  CHECK(polished.reflect == Colour(1, 0.5, 0.25));
  CHECK(read(1, 0.5, json::object()).ambient == doctest::Approx(0.25 * 0.75));
  CHECK(read(0, 0.5, json::object()).ambient == 0.25);

  json glass;
  glass["KHR_materials_transmission"]["transmissionFactor"] = 1;
  glass["KHR_materials_ior"]["ior"] = 1.25;
  const Material metal = read(1, 0.5, glass);
  CHECK(metal.transmit == Colour(0.0));
  CHECK(metal.kd == 0.5);
  const Material clear = read(0, 0.5, glass);
  CHECK(clear.transmit == Colour(1, 0.5, 0.25));
  CHECK(clear.kd == 0);
  CHECK(clear.ior == 1.25);

  glass["KHR_materials_transmission"]["transmissionTexture"]["index"] = 0;
  const Material painted = read(0.25, 0.5, glass);
  REQUIRE(painted.transmission.has_value());
  CHECK(painted.transmission->share == 0.75);
  CHECK(painted.transmit == Colour(1, 0.5, 0.25) * 0.75);
  CHECK(painted.kd == 1 - 0.25 * 0.5);
  CHECK(painted.ambient == doctest::Approx(0.25 * (1 - 0.25 * 0.25)));

  // Where facets are drawn a metal is a mirror, however rough, and glass is as rough as it says.
  const auto with_facets = [&](double metallic, double roughness, const json& extensions) {
    return ResolveGloss(read_only(metallic, roughness, extensions), GlossModel::kFacets);
  };
  const Material rough = with_facets(1, 0.5, json::object());
  CHECK(rough.reflect == Colour(1, 0.5, 0.25));
  CHECK(rough.roughness == 0.5);
  CHECK(rough.kd == 0);
  CHECK(rough.ambient == 0);
  CHECK(with_facets(0, 0.5, json::object()).reflect == Colour(0.0));
  glass["KHR_materials_transmission"].erase("transmissionTexture");
  CHECK(with_facets(0, 0.5, glass).roughness == 0.5);
  CHECK(with_facets(0, 0.5, glass).transmit == Colour(1, 0.5, 0.25));

  json specular;
  specular["KHR_materials_specular"]["specularFactor"] = 0.5;
  CHECK(read(0, 0.5, json::object()).ks == 0.1);
  CHECK(read(0, 0.5, specular).ks == doctest::Approx(0.05));
  CHECK(read(1, 0.5, specular).ks == doctest::Approx(0.4));
}

TEST_CASE("glTF of specular colour and glossiness") {
  const auto read = [](const json& old) {
    json gltf = TexturedGltf({{"extensions", {{"KHR_materials_pbrSpecularGlossiness", old}}}});
    gltf["extensionsUsed"] = gltf["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
    const Read all = ReadGltf(gltf);
    CHECK(all.warnings.empty());
    return ResolveGloss(all.material, GlossModel::kFading);
  };
  const Material painted =
      read({{"diffuseTexture", kTexture0}, {"diffuseFactor", {1, 0.5, 0.5, 1}}});
  CHECK(std::get<Texture>(painted.base_colour).factor == Colour(1, 0.5, 0.5));
  CHECK(painted.kd == 1);
  CHECK(painted.reflect == Colour(0.0));
  const Material plain = read({{"specularFactor", {0.04, 0.04, 0.04}}, {"glossinessFactor", 0.5}});
  CHECK(plain.ks == doctest::Approx(0.1));
  CHECK(plain.shininess == doctest::Approx(30));
  const Material gold = read({{"diffuseFactor", {0, 0, 0, 1}}, {"specularFactor", {1, 0.8, 0.3}}});
  CHECK(gold.reflect == Colour(1, 0.8, 0.3));
  // The mean alpha of the texture is 1/2.
  CHECK(read({{"specularFactor", {0.04, 0.04, 0.04}}, {"specularGlossinessTexture", kTexture1}})
            .shininess == doctest::Approx(30));
}

TEST_CASE("glTF samplers choose the filter") {
  const json material = {{"pbrMetallicRoughness", {{"baseColorTexture", kTexture0}}}};
  const auto filter_of = [&](const json& sampler) {
    json gltf = TexturedGltf(material);
    gltf["samplers"] = {sampler};
    gltf["textures"][0]["sampler"] = 0;
    const Read read = ReadGltf(gltf);
    return std::get<Texture>(read.material.base_colour).filter;
  };
  CHECK(filter_of(json::object()) == Filter::kMip);
  for (const int mipmapped : {9984, 9985, 9986, 9987}) {
    CHECK(filter_of({{"minFilter", mipmapped}, {"magFilter", 9729}}) == Filter::kMip);
  }
  CHECK(filter_of({{"minFilter", 9728}}) == Filter::kLinear);
  CHECK(filter_of({{"minFilter", 9729}}) == Filter::kLinear);
  CHECK(filter_of({{"magFilter", 9728}}) == Filter::kNearest);
}

TEST_CASE("glTF images that cannot be had leave the factor") {
  const json material = {
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"baseColorTexture", kTexture0}}}};
  const auto read = [&](const json& image) {
    json gltf = TexturedGltf(material);
    gltf["images"][0] = image;
    const Read all = ReadGltf(gltf);
    if (!all.warnings.empty()) {
      CHECK(std::get<Colour>(all.material.base_colour) == Colour(1, 0.5, 0.25));
    }
    return all;
  };
  const std::string webp = "data:image/webp;base64," + Base64("RIFF0000WEBPVP8 ");
  CheckWarned(read({{"uri", "gone.png"}}), "/images/0");
  CheckWarned(read({{"uri", webp}}), "WebP");
  CheckWarned(read({{"uri", "data:image/png;base64,####" + std::string(3000, 'A')}}),
              "data URI of");
  CheckWarned(read({{"uri", "../t.png"}}), "outside the scene's folder");
  CheckWarned(read({{"bufferView", 99}}), "bufferView 99");
  json only_webp = TexturedGltf(material);
  only_webp["images"][0] = {{"uri", webp}};
  only_webp["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  only_webp["extensionsUsed"] = only_webp["extensionsRequired"] = {"EXT_texture_webp"};
  CheckWarned(ReadGltf(only_webp), "WebP");

  const Read inks = read({{"uri", kInkJpeg}});
  CHECK(inks.warnings.empty());
  const Texture& texture = std::get<Texture>(inks.material.base_colour);
  REQUIRE(texture.image->texels.size() == 64);
  const std::uint32_t texel = texture.image->texels[0];
  const std::uint32_t red = texel & 255, green = texel >> 8 & 255, blue = texel >> 16 & 255;
  CHECK(red >= 250);
  CHECK(green <= 5);
  CHECK(blue <= 5);
  const std::uint32_t alpha = texel >> 24;
  CHECK(alpha == 255);
}

TEST_CASE("glTF textures lie by two sets of coordinates") {
  const json second = {{"index", 1}, {"texCoord", 1}};
  json gltf = TexturedGltf({{"pbrMetallicRoughness", {{"baseColorTexture", second}}},
                            {"emissiveFactor", {1, 1, 1}},
                            {"emissiveTexture", second}});
  auto& attributes = gltf["meshes"][0]["primitives"][0]["attributes"];
  attributes = {{"POSITION", 0}, {"TEXCOORD_1", 4}};
  const Read read = ReadGltf(gltf);
  CHECK(read.warnings.empty());
  CHECK(MeshAt(read.scene, 0).uv[2] == glm::vec2(1, 1));
  attributes = {{"POSITION", 0}};
  CheckWarned(ReadGltf(gltf), "no coordinates: TEXCOORD_1");
  attributes = {{"POSITION", 0}, {"TEXCOORD_0", 4}, {"TEXCOORD_1", 5}};
  const float turned[] = {1, 1, 0, 1, 0, 0, 1, 0};
  std::string buffer;
  for (const float number : turned) Put(buffer, number, false);
  gltf["buffers"].push_back(
      {{"byteLength", buffer.size()}, {"uri", "data:;base64," + Base64(buffer)}});
  gltf["bufferViews"].push_back({{"buffer", 1}, {"byteLength", buffer.size()}});
  gltf["accessors"].push_back(
      {{"bufferView", 6}, {"componentType", 5126}, {"count", 4}, {"type", "VEC2"}});
  gltf["materials"][0]["emissiveTexture"]["texCoord"] = 0;
  const Read mixed = ReadGltf(gltf);
  CHECK(mixed.warnings.empty());
  // The base colour comes first: its set is the first here.
  CHECK(std::get<Texture>(mixed.material.base_colour).set == 0);
  CHECK(mixed.material.emission_texture.value().set == 1);
  CHECK(MeshAt(mixed.scene, 0).uv[0] == glm::vec2(1, 1));
  CHECK(MeshAt(mixed.scene, 0).uv2[2] == glm::vec2(1, 1));
  CHECK(MeshAt(mixed.scene, 0).uv2[0] == glm::vec2(0, 0));
  gltf["materials"][0]["occlusionTexture"] = {{"index", 0}, {"texCoord", 2}};
  const Read third = ReadGltf(gltf);
  CheckWarned(third, "TEXCOORD_2 beside TEXCOORD_1 and TEXCOORD_0");
  CHECK_FALSE(third.material.occlusion.has_value());
}

}  // namespace
}  // namespace sheaf
