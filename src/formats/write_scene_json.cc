#include "src/formats/write_scene_json.h"

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "src/formats/scene_cameras.h"
#include "src/formats/scene_lights.h"
#include "src/formats/scene_materials.h"
#include "src/formats/scene_settings.h"
#include "src/formats/scene_shapes.h"
#include "src/formats/scene_values.h"

namespace sheaf {
namespace {

Json ObjectJson(const Scene& scene, const Object& object) {
  Json json = ShapeJson(object.shape);
  json["material"] = scene.materials[object.material].name;
  if (!object.name.empty()) json["name"] = object.name;
  return json;
}

Json InstanceJson(const Scene& scene, const Instance& instance) {
  const auto row = [&](int k) {
    const glm::dmat3& m = instance.linear;
    return Json{m[0][k], m[1][k], m[2][k], instance.translation[k]};
  };
  Json json = {{"group", scene.groups[instance.group].name},
               {"transform", {{"matrix", Json::array({row(0), row(1), row(2)})}}}};
  if (!instance.name.empty()) json["name"] = instance.name;
  return json;
}

Json GroupJson(const Scene& scene, const Group& group) {
  Json json = {{"name", group.name}, {"objects", Json::array()}};
  for (const Object& object : group.objects) json["objects"].push_back(ObjectJson(scene, object));
  for (const Instance& instance : group.instances) {
    json["instances"].push_back(InstanceJson(scene, instance));
  }
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
  MakeUnique(&scene->instances, "");
  MakeUnique(&scene->groups, "group");
  for (Group& group : scene->groups) {
    MakeUnique(&group.objects, "");
    MakeUnique(&group.instances, "");
  }
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
  for (const Group& group : scene.groups) json["groups"].push_back(GroupJson(scene, group));
  for (const Instance& instance : scene.instances) {
    json["instances"].push_back(InstanceJson(scene, instance));
  }
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
