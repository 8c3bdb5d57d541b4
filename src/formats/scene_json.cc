#include "src/formats/scene_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <unordered_set>
#include <utility>

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

namespace sheaf {
namespace {

// What readers of one file share.
struct Reading {
  ColourSource source;
  Scene& scene;

  const std::string& path() const { return source.path; }
  SceneFiles& files() { return source.files; }
};

// `materials` is null where they hold an error: a misspelt name there would be blamed on its users.
std::uint32_t FindMaterial(const JsonCursor& material, const NameTable* materials) {
  if (materials != nullptr) return materials->Find(material).value_or(0);
  std::string unchecked;
  material.ReadString(&unchecked);
  return 0;
}

// Objects, lights, cameras and materials of another file, appended.
void Append(Scene&& from, Scene* to) {
  const auto first_material = static_cast<std::uint32_t>(to->materials.size());
  for (Material& material : from.materials) to->materials.push_back(std::move(material));
  for (Object& object : from.objects) {
    object.material += first_material;
    to->objects.push_back(std::move(object));
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
  if (!material.present()) return Append(std::move(found), &reading->scene);
  for (Object& each : found.objects) {
    each.material = index;
    reading->scene.objects.push_back(std::move(each));
  }
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
