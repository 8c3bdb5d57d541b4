#include "src/formats/write_scene_json.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "src/formats/scene_values.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

Json VectorJson(const Vec3d& v) { return {v.x, v.y, v.z}; }

const char* WrapName(Wrap wrap) {
  return wrap == Wrap::kRepeat ? "repeat" : wrap == Wrap::kMirror ? "mirror" : "clamp";
}

Json MaterialJson(const Material& material) {
  Json json = {{"name", material.name}};
  if (const auto* checker = std::get_if<Checker>(&material.base_colour)) {
    json["base_colour"]["checker"] = {{"even", VectorJson(checker->even)},
                                      {"odd", VectorJson(checker->odd)},
                                      {"cells", {checker->cells.x, checker->cells.y}}};
  } else if (const auto* texture = std::get_if<Texture>(&material.base_colour)) {
    json["base_colour"]["texture"] = {
        {"image", texture->image->name},
        {"wrap", {WrapName(texture->wrap_u), WrapName(texture->wrap_v)}},
        {"filter", texture->filter == Filter::kLinear ? "linear" : "nearest"},
        {"srgb", texture->transfer == Transfer::kSrgb},
        {"factor", VectorJson(texture->factor)}};
  } else {
    json["base_colour"] = VectorJson(std::get<Colour>(material.base_colour));
  }
  if (material.emission != Colour(0.0)) json["emission"] = VectorJson(material.emission);
  json["ambient"] = material.ambient;
  json["kd"] = material.kd;
  json["ks"] = material.ks;
  json["shininess"] = material.shininess;
  json["reflect"] = VectorJson(material.reflect);
  json["transmit"] = VectorJson(material.transmit);
  json["ior"] = material.ior;
  return json;
}

struct ShapeWriter {
  Json operator()(const Sphere& sphere) const {
    return {{"sphere", {{"center", VectorJson(sphere.center)}, {"radius", sphere.radius}}}};
  }
  Json operator()(const Quad& quad) const {
    Json corners = Json::array();
    for (const Vec3d& corner : quad.corners) corners.push_back(VectorJson(corner));
    return {{"quad", {{"corners", corners}}}};
  }
  Json operator()(const Mesh& mesh) const {
    const auto list = [](const auto& vectors) {
      Json json = Json::array();
      for (const auto& vector : vectors) {
        Json numbers = Json::array();
        // 1e30 as a float lies above 1e30, and is what the reader makes of 1e30 again.
        for (int i = 0; i < vector.length(); ++i) {
          numbers.push_back(
              std::clamp(static_cast<double>(vector[i]), -kMaxCoordinate, kMaxCoordinate));
        }
        json.push_back(std::move(numbers));
      }
      return json;
    };
    Json json = {{"positions", list(mesh.positions)}};
    if (!mesh.normals.empty()) json["normals"] = list(mesh.normals);
    if (!mesh.uv.empty()) json["uv"] = list(mesh.uv);
    if (!mesh.colours.empty()) json["colours"] = list(mesh.colours);
    json["triangles"] = mesh.triangles;
    return {{"mesh", std::move(json)}};
  }
  Json operator()(const Triangle& triangle) const {
    Json vertices = Json::array(), uv = Json::array();
    for (const Vec3d& vertex : triangle.vertices) vertices.push_back(VectorJson(vertex));
    Json json = {{"triangle", {{"vertices", vertices}}}};
    if (triangle.uv == Triangle{}.uv) return json;
    for (const glm::dvec2& p : triangle.uv) uv.push_back(Json{p.x, p.y});
    json["triangle"]["uv"] = uv;
    return json;
  }
};

Json ObjectJson(const Scene& scene, const Object& object) {
  Json json = std::visit(ShapeWriter(), object.shape);
  json["material"] = scene.materials[object.material].name;
  if (!object.name.empty()) json["name"] = object.name;
  return json;
}

Json LightJson(const Light& light) {
  Json json = Json::object();
  if (!light.name.empty()) json["name"] = light.name;
  if (const auto* point = std::get_if<PointLight>(&light.source)) {
    const Falloff& falloff = point->falloff;
    Json& source = json[point->cone ? "spot" : "point"];
    source = {{"position", VectorJson(point->position)},
              {"falloff", {falloff.constant, falloff.linear, falloff.quadratic}}};
    if (point->cone) {
      source["direction"] = VectorJson(point->cone->direction);
      source["inner"] = point->cone->inner;
      source["outer"] = point->cone->outer;
    }
  } else {
    const Vec3d& direction = std::get<DirectionalLight>(light.source).direction;
    json["directional"] = {{"direction", VectorJson(direction)}};
  }
  json["colour"] = VectorJson(light.colour);
  json["intensity"] = light.intensity;
  json["shadows"] = light.casts_shadows;
  return json;
}

Json CameraJson(const Camera& camera) {
  Json json = {{"name", camera.name},
               {"eye", VectorJson(camera.eye)},
               {"look_at", VectorJson(camera.look_at)},
               {"up", VectorJson(camera.up)}};
  if (const auto* perspective = std::get_if<Perspective>(&camera.projection)) {
    json["fov_y"] = perspective->fov_y;
  } else {
    json["orthographic"] = {{"height", std::get<Orthographic>(camera.projection).height}};
  }
  return json;
}

Json SettingsJson(const Settings& settings) {
  Json json = {{"size", {settings.width, settings.height}},
               {"samples", settings.samples},
               {"max_depth", settings.max_depth},
               {"background", VectorJson(settings.background)},
               {"exposure", settings.exposure}};
  if (settings.ambient) json["ambient"] = VectorJson(*settings.ambient);
  if (settings.transfer == Transfer::kSrgb) json["srgb"] = "pictures";
  return json;
}

template <typename T>
void MakeUnique(std::vector<T>* things, const std::string& otherwise) {
  std::set<std::string> taken;
  std::map<std::string, int> next;  // number to try after a name, where it is taken
  for (T& thing : *things) {
    for (char& c : thing.name) {
      if (HasControlCharacter({&c, 1})) c = '_';
    }
    if (thing.name.empty() && otherwise.empty()) continue;
    const std::string base = thing.name.empty() ? otherwise : thing.name;
    thing.name = base;
    int& number = next.try_emplace(base, 2).first->second;
    while (!taken.insert(thing.name).second) thing.name = base + " " + std::to_string(number++);
  }
}

}  // namespace

void MakeNamesUnique(Scene* scene) {
  MakeUnique(&scene->materials, "material");
  MakeUnique(&scene->cameras, "camera");
  MakeUnique(&scene->views, "view");
  MakeUnique(&scene->objects, "");
  MakeUnique(&scene->lights, "");
}

std::string SceneJsonText(const Scene& scene) {
  Json json = {{"settings", SettingsJson(scene.settings)},
               {"materials", Json::array()},
               {"objects", Json::array()},
               {"lights", Json::array()},
               {"cameras", Json::array()}};
  for (const Material& material : scene.materials) {
    json["materials"].push_back(MaterialJson(material));
  }
  for (const Object& object : scene.objects) json["objects"].push_back(ObjectJson(scene, object));
  for (const Light& light : scene.lights) json["lights"].push_back(LightJson(light));
  for (const Camera& camera : scene.cameras) json["cameras"].push_back(CameraJson(camera));
  for (const View& view : scene.views) {
    Json names = Json::array();
    for (const std::uint32_t index : view.cameras) names.push_back(scene.cameras[index].name);
    json["views"][view.name] = names;
  }
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sheaf
