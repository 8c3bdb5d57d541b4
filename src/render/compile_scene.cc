#include "src/render/compile_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "simd/roundoffs.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/core/match.h"
#include "src/core/strict_tan.h"
#include "src/core/vec3.h"
#include "src/render/compile_gloss.h"
#include "src/render/compile_light.h"
#include "src/render/compile_values.h"
#include "src/scalar/sin_cos.h"
#include "src/scene/decode_table.h"
#include "src/scene/projection.h"
#include "src/scene/resolve_gloss.h"
#include "src/scene/shapes.h"

namespace sheaf {
namespace {

template <typename Real>
void StoreBaseColour(BaseColour kind, const Checker& checker, MaterialData<Real>& data) {
  data.kind = kind;
  Store(checker.even, data.even);
  Store(checker.odd, data.odd);
  for (int i = 0; i < 2; ++i) data.cells[i] = static_cast<Real>(checker.cells[i]);
}

template <typename Real>
MaterialData<Real> CompileMaterial(const Material& material, const Colour& ambient,
                                   const ScenePlacement& placement) {
  MaterialData<Real> data{};
  Match(
      material.base_colour,
      [&](const Colour& colour) {
        StoreBaseColour(BaseColour::kConstant, {colour, colour}, data);
      },
      [&](const Checker& checker) {
        StoreBaseColour(checker.is_filtered ? BaseColour::kFilteredChecker : BaseColour::kChecker,
                        checker, data);
      },
      [&](const Texture& texture) {
        StoreBaseColour(BaseColour::kTexture, {texture.factor, texture.factor}, data);
      });
  Store(material.ambient * ambient, data.ambient);
  Store(material.emission, data.emission);
  data.kd = static_cast<Real>(material.kd);
  data.ks = static_cast<Real>(material.ks);
  data.shininess = static_cast<Real>(material.shininess);
  Store(material.reflect, data.reflect);
  Store(material.transmit, data.transmit);
  data.ior = static_cast<Real>(material.ior);
  // Alpha of GGX, as glTF and most others have it.
  data.slope_width = static_cast<Real>(material.roughness * material.roughness);
  data.attenuates = material.attenuation != Colour(1.0);
  Store(material.attenuation, data.attenuation);
  data.attenuation_distance = static_cast<Real>(placement.Length(material.attenuation_distance));
  return data;
}

TextureWrap WrapOf(Wrap wrap) {
  switch (wrap) {
    case Wrap::kRepeat:
      return TextureWrap::kRepeat;
    case Wrap::kMirror:
      return TextureWrap::kMirror;
    case Wrap::kClamp:
      break;
  }
  return TextureWrap::kClamp;
}

// Where (u, v) lies on the image, as TextureTransform has it.
template <typename Real>
void StoreTransform(const TextureTransform& transform, TextureData<Real>& data) {
  if (transform == TextureTransform()) return;
  const auto [sine, cosine] = scalar::SinCosOf(transform.rotation / 90);
  const glm::dvec2 scale = transform.scale, offset = transform.offset;
  const double to_u[3] = {cosine * scale.x, sine * scale.y, offset.x};
  const double to_v[3] = {-sine * scale.x, cosine * scale.y, offset.y};
  data.is_moved = true;
  for (int i = 0; i < 3; ++i) {
    data.to_u[i] = static_cast<Real>(to_u[i]);
    data.to_v[i] = static_cast<Real>(to_v[i]);
  }
}

// The levels that the texture is seen through.
template <typename Real>
void StoreLevels(const Texture& texture, CompiledScene<Real>& compiled, TextureData<Real>& data) {
  const Image& image = *texture.image;
  data.levels.width[0] = image.width;
  data.levels.height[0] = image.height;
  if (texture.filter != Filter::kMip) return;
  auto [place, is_new] = compiled.chains.try_emplace({&image, texture.transfer});
  MipChain& chain = place->second;
  if (is_new) chain = BuildMipChain(image, texture.transfer);
  data.level_count = chain.level_count;
  data.coarsest = static_cast<Real>(1 << (chain.level_count - 1));
  data.coarse = chain.texels.data();
  data.levels = chain.levels;
}

// The index of the texture among the compiled ones.
template <typename Real>
std::uint32_t CompileTexture(const Texture& texture, CompiledScene<Real>& compiled) {
  std::vector<Real>& decode = compiled.decode[static_cast<int>(texture.transfer)];
  if (decode.empty()) decode = DecodeTable<Real>(texture.transfer);
  const Image& image = *texture.image;
  compiled.images.push_back(texture.image);
  TextureData<Real> data{
      image.texels.data(),
      image.width,
      image.height,
      decode.data(),
      WrapOf(texture.wrap_u),
      WrapOf(texture.wrap_v),
      texture.filter == Filter::kNearest ? TextureFilter::kNearest : TextureFilter::kLinear};
  const bool has_second_set = compiled.geometry().triangles.uv2[0][0] != nullptr;
  data.set = texture.set == 1 && has_second_set ? 1 : 0;
  StoreTransform(texture.transform, data);
  StoreLevels(texture, compiled, data);
  compiled.textures.push_back(data);
  return static_cast<std::uint32_t>(compiled.textures.size()) - 1;
}

// What the textures besides that of the base colour say.
template <typename Real>
void CompileFinish(const Material& material, CompiledScene<Real>& compiled,
                   MaterialData<Real>& data) {
  FinishData<Real>& finish = data.finish;
  if (const auto& texture = material.emission_texture) {
    finish.emission = CompileTexture(*texture, compiled);
    for (int i = 0; i < 3; ++i) data.emission[i] *= static_cast<Real>(texture->factor[i]);
  }
  if (const auto& gloss = material.metallic_roughness) {
    finish.is_glossy = true;
    if (gloss->texture.image) finish.metallic_roughness = CompileTexture(gloss->texture, compiled);
    finish.metallic = static_cast<Real>(gloss->metallic);
    finish.roughness = static_cast<Real>(gloss->roughness);
    finish.specular = static_cast<Real>(gloss->specular);
  }
  if (const auto& occlusion = material.occlusion) {
    finish.occlusion = CompileTexture(occlusion->texture, compiled);
    finish.occlusion_strength = static_cast<Real>(occlusion->strength);
  }
  if (const auto& transmission = material.transmission) {
    finish.transmission = CompileTexture(transmission->texture, compiled);
    finish.transmission_share = static_cast<Real>(transmission->share);
  }
  if (const auto& normals = material.normal_map) {
    finish.normals = CompileTexture(normals->texture, compiled);
    finish.normal_scale = static_cast<Real>(normals->scale);
  }
  if (material.alpha.mode == AlphaMode::kOpaque) return;
  finish.alpha = material.alpha.mode == AlphaMode::kMask ? AlphaUse::kMask : AlphaUse::kBlend;
  finish.alpha_factor = static_cast<Real>(material.alpha.factor);
  finish.alpha_cutoff = static_cast<Real>(material.alpha.cutoff);
  // What is not there does not bend rays.
  if (!AnyPositive(data.transmit)) data.ior = 1;
}

// A pixel's step on the plane of a camera that has one; else 1.
double PlaneStep(const ProjectionKind& kind, double number, int height) {
  if (kind.surface == ProjectionSurface::kSphere) return 1;
  switch (kind.unit) {
    case ProjectionUnit::kNone:
      break;
    case ProjectionUnit::kDegrees:
      return 2 * StrictTanDegrees(number / 2) / height;
    case ProjectionUnit::kLength:
      return number / height;
  }
  return 1;
}

template <typename Real>
void CompileEnvironment(const Environment& environment, CompiledScene<Real>& compiled) {
  EnvironmentData<Real>& data = compiled.environment;
  Match(
      environment,
      [&](const Gradient& gradient) {
        data.kind = EnvironmentKind::kGradient;
        Store(gradient.zenith, data.zenith);
        Store(gradient.horizon, data.horizon);
        Store(gradient.nadir, data.nadir);
      },
      [&](const EnvironmentMap& map) {
        data.kind = EnvironmentKind::kMap;
        compiled.environment_image = map.image;
        data.rgb = map.image->rgb.data();
        data.width = map.image->width;
        data.height = map.image->height;
        data.strength = static_cast<Real>(map.strength);
        data.turns = static_cast<Real>(map.rotation / 360);
      });
}

// A row's share of the sphere is the difference of the cosines of its edges.
Colour MeanOf(const FloatImage& image) {
  Colour sum(0.0);
  const double quarters = 2.0 / image.height;
  for (int y = 0; y < image.height; ++y) {
    Colour row(0.0);
    const auto width = static_cast<std::size_t>(image.width);
    const float* rgb = image.rgb.data() + 3 * width * static_cast<std::size_t>(y);
    for (std::size_t x = 0; x < width; ++x, rgb += 3) row += Colour(rgb[0], rgb[1], rgb[2]);
    const double share =
        scalar::SinCosOf(quarters * y).cos - scalar::SinCosOf(quarters * (y + 1)).cos;
    sum += row * (share / 2 / image.width);
  }
  return sum;
}

// What a texture asks of its material's surfaces besides the coordinates.
template <typename Real>
std::uint32_t NeedsOf(const TextureData<Real>& texture) {
  return (texture.level_count > 1 ? kNeedsFootprint | kNeedsWidth : 0) |
         (texture.set == 1 ? kNeedsSecondSet : 0);
}

// What materials ask for besides their own data: what their textures do, and the cones of rays that
// may come to such materials.
template <typename Real>
void AddTextureNeeds(CompiledScene<Real>& compiled) {
  bool has_cones = false;
  for (MaterialData<Real>& material : compiled.materials) {
    const FinishData<Real>& finish = material.finish;
    const std::uint32_t base =
        material.kind == BaseColour::kTexture ? material.texture : kNoTexture;
    for (const std::uint32_t texture : {base, finish.emission, finish.metallic_roughness,
                                        finish.occlusion, finish.transmission, finish.normals}) {
      if (texture != kNoTexture) material.needs |= NeedsOf(compiled.textures[texture]);
    }
    has_cones = has_cones || (material.needs & kNeedsFootprint) != 0;
  }
  if (!has_cones) return;
  for (MaterialData<Real>& material : compiled.materials) {
    if (material.needs & kNeedsChildren) material.needs |= kNeedsWidth;
  }
}

// Paths find the light that is around by themselves, and go on from what is diffuse.
template <typename Real>
void FollowOneRay(MaterialData<Real>& data) {
  for (Real& light : data.ambient) light = 0;
  const bool is_diffuse = data.kd > 0 || data.finish.is_glossy;
  if (is_diffuse) data.needs |= kNeedsChildren;
  if (data.needs & kNeedsChildren) data.needs |= kNeedsChoice;
}

// What shines is a light too, whose points are drawn.
template <typename Real>
void AddEmitters(CompiledScene<Real>& compiled) {
  compiled.emitters = std::make_unique<EmitterTable<Real>>();
  CompileEmitters<Real>(compiled.objects, compiled.materials, *compiled.emitters);
  if (compiled.emitters->view.count == 0) return;
  LightData<Real> light{};
  light.kind = LightKind::kPointFromSurface;
  light.shape = LightShape::kEmitters;
  light.casts_shadows = 1;
  light.emitters = &compiled.emitters->view;
  for (Real& channel : light.rgb) channel = 1;
  compiled.lights.push_back(light);
}

}  // namespace

Colour AmbientLightOf(const Settings& settings) {
  if (settings.ambient) return *settings.ambient;
  if (!settings.environment) return settings.background;
  return Match(
      *settings.environment,
      [](const Gradient& gradient) {
        return gradient.horizon * 0.5 + (gradient.zenith + gradient.nadir) * 0.25;
      },
      [](const EnvironmentMap& map) { return MeanOf(*map.image) * map.strength; });
}

template <typename Real>
CompiledScene<Real> CompileScene(const Scene& scene, const ScenePlacement& placement,
                                 Integrator integrator) {
  CompiledScene<Real> compiled;
  const PointBounds bounds = CompileGeometry(scene, placement, compiled.objects);
  const Colour ambient = AmbientLightOf(scene.settings);
  const bool draws_facets = integrator != Integrator::kWhitted;
  const GlossModel gloss =
      integrator == Integrator::kPath ? GlossModel::kFacets : GlossModel::kFading;
  for (const Material& given : scene.materials) {
    const Material material = ResolveGloss(given, gloss);
    MaterialData<Real> data = CompileMaterial<Real>(material, ambient, placement);
    if (const auto* texture = std::get_if<Texture>(&material.base_colour)) {
      data.texture = CompileTexture(*texture, compiled);
    }
    CompileFinish(material, compiled, data);
    if (scene.settings.shadows == Shadows::kThrough) Store(material.transmit, data.passes);
    data.finish.has_facets = data.finish.is_glossy && gloss == GlossModel::kFacets;
    const bool sends_rays = AnyPositive(data.reflect) || AnyPositive(data.transmit);
    if (data.finish.is_glossy || !draws_facets || !sends_rays) data.slope_width = 0;
    if (HasFacets(data)) data.gloss = compiled.gloss.TableOf(data);
    data.needs = NeedsOf(data);
    if (integrator == Integrator::kPath) FollowOneRay(data);
    compiled.materials.push_back(data);
  }
  AddTextureNeeds(compiled);
  ForEachObject(scene, [&](const Object& object) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) return;
    std::uint32_t& needs = compiled.materials[object.material].needs;
    if (!mesh->normals.empty()) needs |= kNeedsNormals;
    if (!mesh->colours.empty()) needs |= kNeedsTint;
    if (ShowsAlphas(*mesh, scene.materials[object.material])) needs |= kNeedsVertexAlpha;
  });
  for (const Light& light : scene.lights) {
    compiled.lights.push_back(CompileLight<Real>(light, scene.settings, placement, bounds));
    LightData<Real>& data = compiled.lights.back();
    if (integrator == Integrator::kWhitted) ShrinkToMiddle(data);
    // The end of a ray that is mapped into an object errs more than its start.
    const bool is_from_light = data.kind == LightKind::kPointFromLight;
    if (is_from_light && !compiled.objects.places.empty()) data.kind = LightKind::kPointFromSurface;
  }
  if (integrator == Integrator::kPath) AddEmitters(compiled);
  if (compiled.lights.empty()) {
    for (auto& material : compiled.materials) material.needs &= ~(kNeedsLights | kNeedsHighlight);
  }
  Store(scene.settings.background, compiled.background);
  if (scene.settings.environment) CompileEnvironment(*scene.settings.environment, compiled);
  return compiled;
}

template <typename Real>
void CompileLens(const Lens& lens, const Camera& camera, const glm::dvec3& right,
                 const glm::dvec3& up, const ScenePlacement& placement, CameraData<Real>& data) {
  const double radius = placement.Length(lens.aperture) / 2;
  const double focus = lens.focus ? *lens.focus : LengthOf(camera.look_at - camera.eye);
  data.lens = LensUse::kThin;
  Store(right * radius, data.lens_right);
  Store(up * radius, data.lens_up);
  data.focus = static_cast<Real>(placement.Length(focus));
  data.blades = static_cast<Real>(lens.blades);
  const double turn = lens.rotation / 90;
  data.blade_turn = static_cast<Real>(turn - 4 * std::floor(turn / 4));
}

template <typename Real>
CameraData<Real> CompileCamera(const Camera& camera, int width, int height,
                               const ScenePlacement& placement) {
  CameraData<Real> data{};
  const glm::dvec3 forward = Unit(camera.look_at - camera.eye);
  const glm::dvec3 right = Unit(CrossOf(forward, camera.up));
  const glm::dvec3 up = CrossOf(right, forward);
  static_assert(static_cast<std::size_t>(kLastCameraModel) + 1 == std::variant_size_v<Projection>);
  data.model = static_cast<CameraModel>(camera.projection.index());
  const ProjectionKind& kind = KindOf(camera.projection);
  double number = ParameterOf(camera.projection);
  if (kind.unit == ProjectionUnit::kLength) number = placement.Length(number);
  const double step = PlaneStep(kind, number, height);
  if (kind.surface == ProjectionSurface::kSphere) {
    // A number of degrees spans the height, alike in all directions; else the picture spans all.
    const bool spans_all = kind.unit == ProjectionUnit::kNone;
    data.turns_x = static_cast<Real>(spans_all ? 4.0 / width : number / 90 / height);
    data.turns_y = static_cast<Real>(spans_all ? 2.0 / height : number / 90 / height);
  }
  Store(placement.Point(camera.eye), data.eye);
  Store(forward, data.forward);
  Store(right * step, data.right);
  Store(up * step, data.up);
  if (camera.lens) CompileLens(*camera.lens, camera, right, up, placement, data);
  data.half_width = static_cast<Real>(width) / 2;
  data.half_height = static_cast<Real>(height) / 2;
  return data;
}

template <typename Real>
PixelCone<Real> CompileCone(const CameraData<Real>& camera, double samples_a_pixel) {
  constexpr double kQuarterTurn = 1.5707963267948966;
  const double part = 1 / std::sqrt(samples_a_pixel);
  const auto up = FromArray(camera.up).template To<double>();
  switch (camera.model) {
    case CameraModel::kPerspective:
      return {0, static_cast<Real>(std::sqrt(Dot(up, up)) * part)};
    case CameraModel::kOrthographic:
      return {static_cast<Real>(std::sqrt(Dot(up, up)) * part), 0};
    case CameraModel::kEquirectangular:
    case CameraModel::kFisheye:
      break;
  }
  return {0, static_cast<Real>(static_cast<double>(camera.turns_y) * kQuarterTurn * part)};
}

template struct CompiledScene<float>;
template struct CompiledScene<double>;
template CompiledScene<float> CompileScene(const Scene&, const ScenePlacement&, Integrator);
template CompiledScene<double> CompileScene(const Scene&, const ScenePlacement&, Integrator);
template CameraData<float> CompileCamera(const Camera&, int, int, const ScenePlacement&);
template CameraData<double> CompileCamera(const Camera&, int, int, const ScenePlacement&);
template PixelCone<float> CompileCone(const CameraData<float>&, double);
template PixelCone<double> CompileCone(const CameraData<double>&, double);

}  // namespace sheaf
