#include "src/formats/scene_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "src/formats/format_table.h"
#include "src/formats/json_cursor.h"
#include "src/formats/json_tree.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/scene_cameras.h"
#include "src/formats/scene_lights.h"
#include "src/formats/scene_materials.h"
#include "src/formats/scene_settings.h"
#include "src/formats/scene_shapes.h"
#include "src/formats/scene_transform.h"
#include "src/formats/scene_values.h"
#include "src/scene/affine_map.h"

namespace sheaf {
namespace {

// What readers of one file share.
struct Reading {
  ColourSource source;
  Scene& scene;

  const std::string& path() const { return source.path; }
  SceneFiles& files() { return source.files; }
};

// The groups of one file by name. Files that it takes in have groups too, so that a group's place
// among the scene's is not that among the names.
class NamedGroups {
 public:
  void Add(const std::string& name, const JsonCursor& place, std::size_t group) {
    names_.Add(name, place);
    groups_.push_back(static_cast<std::uint32_t>(group));
  }
  std::optional<std::uint32_t> Find(const JsonCursor& reference) const {
    const std::optional<std::uint32_t> found = names_.Find(reference);
    return found ? std::optional(groups_[*found]) : std::nullopt;
  }

 private:
  NameTable names_{"group"};
  std::vector<std::uint32_t> groups_;  // of the scene
};

// `materials` is null where they hold an error: a misspelt name there would be blamed on its users.
std::uint32_t FindMaterial(const JsonCursor& material, const NameTable* materials) {
  if (materials != nullptr) return materials->Find(material).value_or(0);
  std::string unchecked;
  material.ReadString(&unchecked);
  return 0;
}

// Objects, instances, lights, cameras and materials of another file, appended. Objects of a scene
// without materials have those of `to`.
void Append(Scene&& from, Scene* to) {
  const auto first_material =
      static_cast<std::uint32_t>(from.materials.empty() ? 0 : to->materials.size());
  const auto first_group = static_cast<std::uint32_t>(to->groups.size());
  for (Material& material : from.materials) to->materials.push_back(std::move(material));
  for (Object& object : from.objects) {
    object.material += first_material;
    to->objects.push_back(std::move(object));
  }
  for (Group& group : from.groups) {
    for (Object& object : group.objects) object.material += first_material;
    for (Instance& instance : group.instances) instance.group += first_group;
    to->groups.push_back(std::move(group));
  }
  for (Instance& instance : from.instances) {
    instance.group += first_group;
    to->instances.push_back(std::move(instance));
  }
  for (Light& light : from.lights) to->lights.push_back(std::move(light));
  for (Camera& camera : from.cameras) {
    const bool is_taken =
        std::any_of(to->cameras.begin(), to->cameras.end(),
                    [&](const Camera& other) { return other.name == camera.name; });
    if (!is_taken) to->cameras.push_back(std::move(camera));
  }
}

Result<Scene> ReadReferenced(const std::string& reference, Reading* reading) {
  const Result<std::string> path = reading->files().Resolve(reading->path(), reference);
  if (!path)
    return Error{ErrorKind::kScene,
                 fmt::format("{}: {}", Printable(reference), path.error().message)};
  if (IsModelPath(path.value())) return ReadSceneFile(path.value(), reading->files());
  if (!IsScenePath(path.value())) {
    return Error{ErrorKind::kScene,
                 fmt::format("{}: the name must end in {}", Printable(reference), SceneEndings())};
  }
  if (!reading->files().Enter(path.value())) {
    return Error{ErrorKind::kScene,
                 fmt::format("{}: the file includes itself", Printable(reference))};
  }
  Result<Scene> scene = ReadSceneJson(path.value(), reading->files());
  reading->files().Leave();
  return scene;
}

// {"mesh": "file"} takes the objects of a file, {"include": "file"} its lights and cameras too.
void ReadFile(const JsonCursor& file, JsonObject* object, const std::string& name,
              const NameTable* materials, Reading* reading) {
  const bool is_mesh = file.key() == "mesh";
  const Transform transform = ReadTransform(object->Optional("transform"));
  const JsonCursor material = is_mesh ? object->Optional("material") : JsonCursor();
  const std::uint32_t index = material.present() ? FindMaterial(material, materials) : 0;
  object->Finish();
  std::string reference;
  if (!file.ReadString(&reference)) return;
  Result<Scene> read = ReadReferenced(reference, reading);
  if (!read) return file.Fail(read.error().message);
  Scene& found = read.value();
  if (is_mesh) {
    found.lights.clear();
    found.cameras.clear();
  }
  const std::string fault = TransformScene(transform, &found);
  if (!fault.empty()) return file.Fail(fault);
  if (!name.empty()) {
    for (std::size_t i = 0; i < found.objects.size(); ++i) {
      found.objects[i].name = found.objects.size() == 1 ? name : fmt::format("{} {}", name, i + 1);
    }
  }
  if (material.present()) {
    found.materials.clear();
    for (Object& each : found.objects) each.material = index;
    for (Group& group : found.groups) {
      for (Object& each : group.objects) each.material = index;
    }
  }
  Append(std::move(found), &reading->scene);
}

void ReadObject(const JsonCursor& value, const NameTable* materials, NameTable* names,
                Reading* reading) {
  Object result;
  JsonObject object(value);
  const JsonCursor name = object.Optional("name");
  if (ReadName(name, &result.name)) names->Add(result.name, name);
  std::vector<std::string_view> keys = ShapeKeys();
  keys.push_back("include");
  const JsonCursor shape = object.OneOf(keys);
  if (shape.present()) {
    const bool is_mesh_file = shape.key() == "mesh" && !shape.Is(JsonKind::kObject);
    if (is_mesh_file || shape.key() == "include") {
      return ReadFile(shape, &object, result.name, materials, reading);
    }
    result.shape = ReadShape(shape);
  }
  result.material = FindMaterial(object.Required("material"), materials);
  const JsonCursor moved = object.Optional("transform");
  if (moved.present()) {
    Scene one;
    one.objects.push_back(std::move(result));
    const std::string fault = TransformScene(ReadTransform(moved), &one);
    if (!fault.empty()) moved.Fail(fault);
    result = std::move(one.objects[0]);
  }
  object.Finish();
  reading->scene.objects.push_back(std::move(result));
}

Instance ReadInstance(const JsonCursor& value, const NamedGroups& groups, NameTable* names) {
  Instance instance;
  JsonObject object(value);
  const JsonCursor name = object.Optional("name");
  if (ReadName(name, &instance.name)) names->Add(instance.name, name);
  instance.group = groups.Find(object.Required("group")).value_or(0);
  const JsonCursor moved = object.Optional("transform");
  const Transform transform = ReadTransform(moved);
  if (const std::string fault = FaultOf(MapOf(transform)); !fault.empty()) moved.Fail(fault);
  instance.linear = transform.linear;
  instance.translation = transform.translation;
  object.Finish();
  return instance;
}

// Objects and instances of groups before this one.
void ReadGroup(const JsonCursor& value, const NameTable* materials, NamedGroups* groups,
               Reading* reading) {
  Group group;
  JsonObject object(value);
  const JsonCursor name = object.Required("name");
  ReadName(name, &group.name);
  NameTable objects("object"), instances("instance");
  // What an object brings goes to the scene: it is read as if the group were one.
  Scene& scene = reading->scene;
  std::vector<Object> outer = std::exchange(scene.objects, {});
  std::vector<Instance> outer_instances = std::exchange(scene.instances, {});
  const std::size_t lights = scene.lights.size(), cameras = scene.cameras.size();
  const JsonCursor list = object.Optional("objects");
  list.ForEachElement(
      [&](const JsonCursor& element) { ReadObject(element, materials, &objects, reading); });
  if (scene.lights.size() > lights || scene.cameras.size() > cameras) {
    list.Fail("a group takes no lights or cameras: \"mesh\" leaves out those of a file");
  }
  group.objects = std::exchange(scene.objects, std::move(outer));
  group.instances = std::exchange(scene.instances, std::move(outer_instances));
  object.Optional("instances").ForEachElement([&](const JsonCursor& element) {
    group.instances.push_back(ReadInstance(element, *groups, &instances));
  });
  object.Finish();
  groups->Add(group.name, name, scene.groups.size());
  scene.groups.push_back(std::move(group));
}

Light ReadNamedLight(const JsonCursor& value, NameTable* names) {
  JsonObject object(value);
  std::string label;
  const JsonCursor name = object.Optional("name");
  if (ReadName(name, &label)) names->Add(label, name);
  Light light = ReadLight(&object);
  light.name = std::move(label);
  object.Finish();
  return light;
}

// `cameras` is null where they hold an error.
View ReadView(const JsonCursor& value, const NameTable* cameras) {
  View view;
  view.name = value.key();
  if (view.name.empty()) value.Fail("the name of the view is empty");
  if (HasControlCharacter(view.name)) value.Fail("a name must not hold control characters");
  std::unordered_set<std::uint32_t> listed;
  if (value.Is(JsonKind::kArray) && value.IsEmpty()) value.Fail("a view needs at least one camera");
  value.ForEachElement([&](const JsonCursor& element) {
    if (cameras == nullptr) return;
    const auto camera = cameras->Find(element);
    if (!camera) return;
    if (!listed.insert(*camera).second) element.Fail("the view has this camera already");
    view.cameras.push_back(*camera);
  });
  return view;
}

Scene ReadRoot(const JsonCursor& root, const JsonErrors& errors, const std::string& path,
               SceneFiles& files) {
  Scene scene;
  Reading reading{{path, files}, scene};
  JsonObject object(root);
  std::string schema;
  object.Optional("$schema").ReadString(&schema);
  scene.settings = ReadSettings(object.Optional("settings"), &reading.source);

  NameTable materials("material"), objects("object"), lights("light"), cameras("camera");
  object.Optional("materials").ForEachElement([&](const JsonCursor& element) {
    scene.materials.push_back(ReadMaterial(element, &reading.source, &materials));
  });
  const NameTable* known_materials = errors.first() ? nullptr : &materials;
  object.Optional("objects").ForEachElement(
      [&](const JsonCursor& element) { ReadObject(element, known_materials, &objects, &reading); });
  NamedGroups groups;
  object.Optional("groups").ForEachElement(
      [&](const JsonCursor& element) { ReadGroup(element, known_materials, &groups, &reading); });
  NameTable instances("instance");
  object.Optional("instances").ForEachElement([&](const JsonCursor& element) {
    scene.instances.push_back(ReadInstance(element, groups, &instances));
  });
  object.Optional("lights").ForEachElement(
      [&](const JsonCursor& element) { scene.lights.push_back(ReadNamedLight(element, &lights)); });
  // Included cameras come after this file's own, of which the first is the default.
  std::vector<Camera> included = std::exchange(scene.cameras, {});
  const JsonCursor camera_list =
      included.empty() ? object.Required("cameras") : object.Optional("cameras");
  if (included.empty() && camera_list.Is(JsonKind::kArray) && camera_list.IsEmpty()) {
    camera_list.Fail("a scene needs at least one camera");
  }
  camera_list.ForEachElement(
      [&](const JsonCursor& element) { scene.cameras.push_back(ReadCamera(element, &cameras)); });
  const NameTable* known_cameras = errors.first() ? nullptr : &cameras;
  object.Optional("views").ForEachMember(
      [&](const JsonCursor& member) { scene.views.push_back(ReadView(member, known_cameras)); });
  object.Finish();
  Scene others;
  others.cameras = std::move(included);
  Append(std::move(others), &scene);
  return scene;
}

}  // namespace

Result<Scene> ReadSceneJson(const std::string& path) {
  SceneFiles files(path, {});
  files.Enter(path);
  return ReadSceneJson(path, files);
}

Result<Scene> ReadSceneJson(const std::string& path, SceneFiles& files) {
  const Result<std::string> text = ReadWholeFile(path, kMaxTextBytes);
  if (!text) return text.error();
  return ParseSceneJson(text.value(), path, files);
}

Result<Scene> ParseSceneJson(std::string_view text, const std::string& name) {
  SceneFiles files(name, {});
  return ParseSceneJson(text, name, files);
}

Result<Scene> ParseSceneJson(std::string_view text, const std::string& name, SceneFiles& files) {
  // The limit also keeps the tree's 32-bit node indices from overflowing.
  if (text.size() > kMaxTextBytes) return InputError(name, "larger than 1 GiB");
  const Result<JsonTree> tree = ParseJsonTree(text, name);
  if (!tree) return tree.error();
  JsonErrors errors(tree.value(), name);
  Scene scene = ReadRoot(JsonCursor(&errors, 0), errors, name, files);
  if (errors.first()) return *errors.first();
  return scene;
}

}  // namespace sheaf
