#include "src/formats/scene_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <new>
#include <unordered_set>
#include <utility>

#include "src/formats/format_table.h"
#include "src/formats/image.h"
#include "src/formats/json_cursor.h"
#include "src/formats/json_tree.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/read_scene.h"
#include "src/formats/scene_lights.h"
#include "src/formats/scene_mesh.h"
#include "src/formats/scene_shapes.h"
#include "src/formats/scene_transform.h"
#include "src/formats/scene_values.h"
#include "src/formats/suggest_name.h"

namespace sheaf {
namespace {

constexpr NumberRange kImageSide{1.0, kMaxImageSide, "an integer in [1, 65536]"};
constexpr NumberRange kSampleCount{1.0, kMaxSamples, "an integer in [1, 65536]"};
constexpr NumberRange kDepthLimit{0.0, kMaxDepth, "an integer in [0, 1000000]"};
constexpr NumberRange kExposure{kSmallestPositive, 1e6, "a number in (0, 1e6]"};
constexpr NumberRange kShininess{0.0, 1e9, "a number in [0, 1e9]"};
constexpr NumberRange kIor{1e-6, 1e6, "a number in [1e-6, 1e6]"};
constexpr NumberRange kCells{kSmallestPositive, 65536.0, "a number in (0, 65536]"};
constexpr NumberRange kFovY{kSmallestPositive, 0x1.67fffffffffffp7, "a number in (0, 180)"};
constexpr NumberRange kHeight{kSmallestPositive, 1e30, "a number in (0, 1e30]"};

// `decode`: how colours of the file are encoded.
Settings ReadSettings(const JsonCursor& value, Transfer* decode) {
  Settings settings;
  if (!value.present()) return settings;
  JsonObject object(value);
  if (const auto size = object.Optional("size").ReadTuple<2>("[width, height]")) {
    (*size)[0].ReadInteger(kImageSide, &settings.width);
    (*size)[1].ReadInteger(kImageSide, &settings.height);
  }
  object.Optional("samples").ReadInteger(kSampleCount, &settings.samples);
  object.Optional("max_depth").ReadInteger(kDepthLimit, &settings.max_depth);
  const JsonCursor srgb = object.Optional("srgb");
  bool is_srgb = false;
  if (srgb.Is(JsonKind::kString)) {
    if (srgb.text() != "pictures") srgb.Fail("expected true, false or \"pictures\"");
    settings.transfer = Transfer::kSrgb;
  } else if (srgb.ReadBoolean(&is_srgb)) {
    settings.transfer = *decode = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
  }
  ReadPictureColour(object.Optional("background"), *decode, &settings.background);
  // The ambient colour is light, and the colours of lights are always linear.
  Colour ambient;
  if (ReadColour(object.Optional("ambient"), kStrength, &ambient)) settings.ambient = ambient;
  object.Optional("exposure").Read(kExposure, &settings.exposure);
  object.Finish();
  return settings;
}

// What readers of one file share.
struct Reading {
  const std::string& path;
  SceneFiles& files;
  Scene& scene;
  ImageCache images = {};
  Transfer decode = Transfer::kLinear;  // what the file's colours need
};

Checker ReadChecker(const JsonCursor& value, Transfer transfer) {
  Checker checker;
  JsonObject object(value);
  ReadPictureColour(object.Optional("even"), transfer, &checker.even);
  ReadPictureColour(object.Optional("odd"), transfer, &checker.odd);
  ReadPair(object.Optional("cells"), kCells, "[cells along u, cells along v]", &checker.cells);
  object.Finish();
  return checker;
}

template <typename Choice, std::size_t count>
void ReadChoice(const JsonCursor& value,
                const std::pair<std::string_view, Choice> (&choices)[count], Choice* out) {
  std::string word;
  if (!value.ReadString(&word)) return;
  std::vector<std::string_view> known;
  for (const auto& [name, choice] : choices) {
    known.push_back(name);
    if (name != word) continue;
    *out = choice;
    return;
  }
  value.Fail(fmt::format("expected one of {}{}", fmt::join(known, ", "), DidYouMean(word, known)));
}

constexpr std::pair<std::string_view, Wrap> kWraps[] = {
    {"repeat", Wrap::kRepeat}, {"mirror", Wrap::kMirror}, {"clamp", Wrap::kClamp}};
constexpr std::pair<std::string_view, Filter> kFilters[] = {{"linear", Filter::kLinear},
                                                            {"nearest", Filter::kNearest}};

// Nothing where the image cannot be had, which is an error.
std::optional<Texture> ReadTexture(const JsonCursor& value, Reading* reading) {
  Texture texture;
  JsonObject object(value);
  const JsonCursor image = object.Required("image");
  std::string reference;
  if (image.ReadString(&reference)) {
    auto loaded = reading->images.Load(reading->path, reference, reading->files);
    if (loaded) {
      texture.image = loaded.value();
    } else {
      image.Fail(loaded.error().message);
    }
  }
  const JsonCursor wrap = object.Optional("wrap");
  if (wrap.Is(JsonKind::kArray)) {
    if (const auto both = wrap.ReadTuple<2>("[along u, along v]")) {
      ReadChoice((*both)[0], kWraps, &texture.wrap_u);
      ReadChoice((*both)[1], kWraps, &texture.wrap_v);
    }
  } else {
    ReadChoice(wrap, kWraps, &texture.wrap_u);
    texture.wrap_v = texture.wrap_u;
  }
  ReadChoice(object.Optional("filter"), kFilters, &texture.filter);
  bool is_srgb = true;
  object.Optional("srgb").ReadBoolean(&is_srgb);
  texture.transfer = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
  ReadPictureColour(object.Optional("factor"), reading->decode, &texture.factor);
  object.Finish();
  return texture.image ? std::optional(texture) : std::nullopt;
}

void ReadBaseColour(const JsonCursor& value, Reading* reading, Material* material) {
  const Transfer transfer = reading->decode;
  if (value.Is(JsonKind::kObject)) {
    JsonObject object(value);
    const JsonCursor texture = object.Optional("texture");
    const JsonCursor checker =
        texture.present() ? object.AtMostOneOf({"checker"}) : object.Required("checker");
    if (texture.present() && checker.present()) {
      checker.Fail("a base colour is a checker or a texture, not both");
    } else if (checker.present()) {
      material->base_colour = ReadChecker(checker, transfer);
    } else if (texture.present()) {
      if (const auto read = ReadTexture(texture, reading)) material->base_colour = *read;
    }
    object.Finish();
    return;
  }
  Colour colour;
  if (ReadPictureColour(value, transfer, &colour,
                        "a colour ([r, g, b] or one number) or {\"checker\": ...}")) {
    material->base_colour = colour;
  }
}

Material ReadMaterial(const JsonCursor& value, Reading* reading, NameTable* names) {
  Material material;
  JsonObject object(value);
  const JsonCursor name = object.Required("name");
  if (ReadNonEmptyName(name, &material.name)) names->Add(material.name, name);
  ReadBaseColour(object.Optional("base_colour"), reading, &material);
  ReadColour(object.Optional("emission"), kStrength, &material.emission);
  object.Optional("ambient").Read(kStrength, &material.ambient);
  object.Optional("kd").Read(kStrength, &material.kd);
  object.Optional("ks").Read(kStrength, &material.ks);
  object.Optional("shininess").Read(kShininess, &material.shininess);
  ReadColour(object.Optional("reflect"), kFraction, &material.reflect);
  ReadColour(object.Optional("transmit"), kFraction, &material.transmit);
  object.Optional("ior").Read(kIor, &material.ior);
  object.Finish();
  return material;
}

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
  const Result<std::string> path = reading->files.Resolve(reading->path, reference);
  if (!path)
    return Error{ErrorKind::kScene,
                 fmt::format("{}: {}", Printable(reference), path.error().message)};
  if (IsModelPath(path.value())) return ReadSceneFile(path.value(), reading->files);
  if (!IsScenePath(path.value())) {
    return Error{ErrorKind::kScene,
                 fmt::format("{}: the name must end in {}", Printable(reference), SceneEndings())};
  }
  if (!reading->files.Enter(path.value())) {
    return Error{ErrorKind::kScene,
                 fmt::format("{}: the file includes itself", Printable(reference))};
  }
  Result<Scene> scene = ReadSceneJson(path.value(), reading->files);
  reading->files.Leave();
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
  const JsonCursor shape = object.OneOf({"sphere", "quad", "triangle", "mesh", "include"});
  if (shape.present()) {
    const bool is_mesh = shape.key() == "mesh";
    if (shape.key() == "include" || (is_mesh && !shape.Is(JsonKind::kObject))) {
      return ReadFile(shape, &object, result.name, materials, reading);
    }
    if (shape.key() == "sphere") result.shape = ReadSphere(shape);
    if (shape.key() == "quad") result.shape = ReadQuad(shape);
    if (shape.key() == "triangle") result.shape = ReadTriangle(shape);
    if (is_mesh) result.shape = ReadMesh(shape);
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

Camera ReadCamera(const JsonCursor& value, NameTable* names) {
  Camera camera;
  JsonObject object(value);
  const JsonCursor name = object.Required("name");
  if (ReadNonEmptyName(name, &camera.name)) names->Add(camera.name, name);
  const bool has_eye = ReadVector(object.Required("eye"), &camera.eye);
  const JsonCursor look_at = object.Required("look_at");
  const bool has_target = ReadVector(look_at, &camera.look_at);
  const JsonCursor up = object.Optional("up");
  const bool has_up = !up.present() || ReadDirection(up, &camera.up);

  const JsonCursor projection = object.AtMostOneOf({"fov_y", "orthographic"});
  if (projection.present() && projection.key() == "orthographic") {
    Orthographic orthographic;
    JsonObject lens(projection);
    lens.Required("height").Read(kHeight, &orthographic.height);
    lens.Finish();
    camera.projection = orthographic;
  } else {
    Perspective perspective;
    projection.Read(kFovY, &perspective.fov_y);
    camera.projection = perspective;
  }
  object.Finish();

  if (!has_eye || !has_target || !has_up) return camera;
  const Vec3d view = camera.look_at - camera.eye;
  if (std::abs(view.x) < 1e-30 && std::abs(view.y) < 1e-30 && std::abs(view.z) < 1e-30) {
    look_at.Fail("the camera looks at its own eye");
  } else if (glm::length(glm::cross(Normalized(view), Normalized(camera.up))) < 1e-6) {
    (up.present() ? up : look_at).Fail("the view direction is parallel to up");
  }
  return camera;
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

Scene ReadScene(const JsonCursor& root, const JsonErrors& errors, const std::string& path,
                SceneFiles& files) {
  Scene scene;
  Reading reading{path, files, scene};
  JsonObject object(root);
  std::string schema;
  object.Optional("$schema").ReadString(&schema);
  scene.settings = ReadSettings(object.Optional("settings"), &reading.decode);

  NameTable materials("material"), objects("object"), lights("light"), cameras("camera");
  object.Optional("materials").ForEachElement([&](const JsonCursor& element) {
    scene.materials.push_back(ReadMaterial(element, &reading, &materials));
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
  try {
    const Result<std::string> text = ReadWholeFile(path, kMaxTextBytes);
    if (!text) return text.error();
    return ParseSceneJson(text.value(), path, files);
  } catch (const std::bad_alloc&) {
    return InputError(path, "not enough memory to read the file");
  }
}

Result<Scene> ParseSceneJson(std::string_view text, const std::string& name) {
  SceneFiles files(name, {});
  return ParseSceneJson(text, name, files);
}

Result<Scene> ParseSceneJson(std::string_view text, const std::string& name, SceneFiles& files) {
  // The limit also keeps the tree's 32-bit node indices from overflowing.
  if (text.size() > kMaxTextBytes) return InputError(name, "larger than 1 GiB");
  try {
    const Result<JsonTree> tree = ParseJsonTree(text, name);
    if (!tree) return tree.error();
    JsonErrors errors(tree.value(), name);
    Scene scene = ReadScene(JsonCursor(&errors, 0), errors, name, files);
    if (errors.first()) return *errors.first();
    return scene;
  } catch (const std::bad_alloc&) {
    return InputError(name, "not enough memory to read the scene");
  }
}

}  // namespace sheaf
