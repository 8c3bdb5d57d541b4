#include "src/app/scene_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>
#include <vector>

#include "src/scene/placed_groups.h"
#include "src/scene/projection.h"
#include "src/scene/shapes.h"
#include "src/scene/textures.h"

namespace sheaf {
namespace {

bool IsBlack(const Colour& colour) { return colour == Colour(0.0); }

// What is sampled, and the kinds of cameras.
void AddSampling(const Scene& scene, const std::vector<const Material*>& used,
                 std::vector<Feature>& features) {
  const auto any_camera = [&](auto test) {
    return std::any_of(scene.cameras.begin(), scene.cameras.end(), test);
  };
  features.push_back({"rough reflection and refraction",
                      std::any_of(used.begin(), used.end(),
                                  [](const Material* m) { return m->roughness > 0.0; })});
  features.push_back(
      {"depth of field", any_camera([](const Camera& camera) { return camera.lens.has_value(); })});
  for (const ProjectionKind& kind : kProjectionKinds) {
    const auto is_kind = [&](const Camera& c) { return &KindOf(c.projection) == &kind; };
    features.push_back({fmt::format("{} cameras", kind.name), any_camera(is_kind)});
  }
  features.push_back({"several samples a pixel", scene.settings.samples > 1});
  features.push_back({"sRGB transfer", scene.settings.transfer == Transfer::kSrgb});
}

}  // namespace

SceneSummary Summarize(const Scene& scene) {
  SceneSummary summary;
  summary.bounds = BoundsOf(scene);
  const auto counts = CountPrimitives(scene);
  summary.spheres = counts[PrimitiveKind::kSphere];
  summary.triangles = counts[PrimitiveKind::kTriangle];
  summary.disks = counts[PrimitiveKind::kDisk];
  std::vector<const Material*> used;
  ForEachObject(scene,
                [&](const Object& object) { used.push_back(&scene.materials[object.material]); });

  const auto any_material = [&](auto test) {
    return std::any_of(used.begin(), used.end(), [&](const Material* m) { return test(*m); });
  };
  const auto any_mesh = [&](auto test) {
    bool is_any = false;
    ForEachObject(scene, [&](const Object& object) {
      const auto* mesh = std::get_if<Mesh>(&object.shape);
      is_any = is_any || (mesh != nullptr && test(*mesh));
    });
    return is_any;
  };
  const auto any_light = [&](auto test) {
    return std::any_of(scene.lights.begin(), scene.lights.end(), test);
  };
  const bool has_environment = scene.settings.environment.has_value();
  const Colour ambient_light =
      scene.settings.ambient.value_or(has_environment ? Colour(1.0) : scene.settings.background);
  const bool lit = any_material(
      [](const Material& m) { return m.kd > 0.0 || m.ks > 0.0 || m.metallic_roughness; });
  summary.features = {
      {"spheres", summary.spheres > 0},
      {"triangles", summary.triangles > 0},
      {"disks", summary.disks > 0},
      {"instances", CountPlacedGroups(scene) > 0},
      {"checker textures", any_material([](const Material& m) {
         return std::holds_alternative<Checker>(m.base_colour);
       })},
      {"image textures", any_material([](const Material& m) {
         bool has_texture = false;
         ForEachTexture(
             m, [&](const char* /*name*/, const Texture& /*texture*/) { has_texture = true; });
         return has_texture;
       })},
      {"environment", has_environment},
      {"normal maps", any_material([](const Material& m) { return m.normal_map.has_value(); })},
      {"alpha", any_material([](const Material& m) { return m.alpha.mode != AlphaMode::kOpaque; })},
      {"smooth normals", any_mesh([](const Mesh& m) { return !m.normals.empty(); })},
      {"vertex colours", any_mesh([](const Mesh& m) { return !m.colours.empty(); })},
      {"emission", any_material([](const Material& m) { return !IsBlack(m.emission); })},
      {"ambient light",
       !IsBlack(ambient_light) && any_material([](const Material& m) { return m.ambient > 0.0; })},
      {"point lights",
       any_light([](const Light& l) { return std::holds_alternative<PointLight>(l.source); })},
      {"spot lights", any_light([](const Light& l) {
         const auto* point = std::get_if<PointLight>(&l.source);
         return point != nullptr && point->cone.has_value();
       })},
      {"directional lights", any_light([](const Light& l) {
         return std::holds_alternative<DirectionalLight>(l.source);
       })},
      {"lights with a size", any_light([](const Light& l) {
         const auto* sun = std::get_if<DirectionalLight>(&l.source);
         return sun ? sun->angle > 0 : !std::holds_alternative<PointLight>(l.source);
       })},
      {"shadows", lit && any_light([](const Light& l) { return l.casts_shadows; })},
      {"highlights", !scene.lights.empty() && any_material([](const Material& m) {
         return m.ks > 0.0 || m.metallic_roughness;
       })},
      {"mirror reflection", any_material([](const Material& m) {
         return m.metallic_roughness ? m.metallic_roughness->metallic > 0 : !IsBlack(m.reflect);
       })},
      {"refraction and Fresnel reflection",
       any_material([](const Material& m) { return !IsBlack(m.transmit); })},
  };
  AddSampling(scene, used, summary.features);
  return summary;
}

}  // namespace sheaf
