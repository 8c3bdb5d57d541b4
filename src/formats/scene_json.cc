#include "src/formats/scene_json.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <memory>
#include <new>
#include <system_error>
#include <unordered_set>
#include <utility>

#include "src/formats/json_cursor.h"
#include "src/formats/json_tree.h"
#include "src/formats/printable.h"
#include "src/formats/scene_lights.h"
#include "src/formats/scene_shapes.h"
#include "src/formats/scene_values.h"

namespace sheaf {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

constexpr NumberRange kImageSide{1.0, kMaxImageSide, "an integer in [1, 65536]"};
constexpr NumberRange kSampleCount{1.0, kMaxSamples, "an integer in [1, 65536]"};
constexpr NumberRange kDepthLimit{0.0, kMaxDepth, "an integer in [0, 1000000]"};
constexpr NumberRange kExposure{kSmallestPositive, 1e6, "a number in (0, 1e6]"};
constexpr NumberRange kShininess{0.0, 1e9, "a number in [0, 1e9]"};
constexpr NumberRange kIor{1e-6, 1e6, "a number in [1e-6, 1e6]"};
constexpr NumberRange kCells{kSmallestPositive, 65536.0, "a number in (0, 65536]"};
constexpr NumberRange kFovY{kSmallestPositive, 0x1.67fffffffffffp7, "a number in (0, 180)"};
constexpr NumberRange kHeight{kSmallestPositive, 1e30, "a number in (0, 1e30]"};

Settings ReadSettings(const JsonCursor& value) {
  Settings settings;
  if (!value.present()) return settings;
  JsonObject object(value);
  if (const auto size = object.Optional("size").ReadTuple<2>("[width, height]")) {
    (*size)[0].ReadInteger(kImageSide, &settings.width);
    (*size)[1].ReadInteger(kImageSide, &settings.height);
  }
  object.Optional("samples").ReadInteger(kSampleCount, &settings.samples);
  object.Optional("max_depth").ReadInteger(kDepthLimit, &settings.max_depth);
  bool is_srgb = false;
  object.Optional("srgb").ReadBoolean(&is_srgb);
  settings.transfer = is_srgb ? Transfer::kSrgb : Transfer::kLinear;
  ReadPictureColour(object.Optional("background"), settings.transfer, &settings.background);
  // The ambient colour is light, and the colours of lights are always linear.
  Colour ambient;
  if (ReadColour(object.Optional("ambient"), kStrength, &ambient)) settings.ambient = ambient;
  object.Optional("exposure").Read(kExposure, &settings.exposure);
  object.Finish();
  return settings;
}

Checker ReadChecker(const JsonCursor& value, Transfer transfer) {
  Checker checker;
  JsonObject object(value);
  ReadPictureColour(object.Optional("even"), transfer, &checker.even);
  ReadPictureColour(object.Optional("odd"), transfer, &checker.odd);
  ReadPair(object.Optional("cells"), kCells, "[cells along u, cells along v]", &checker.cells);
  object.Finish();
  return checker;
}

void ReadBaseColour(const JsonCursor& value, Transfer transfer, Material* material) {
  if (value.Is(JsonKind::kObject)) {
    JsonObject object(value);
    const JsonCursor checker = object.Required("checker");
    if (checker.present()) material->base_colour = ReadChecker(checker, transfer);
    object.Finish();
    return;
  }
  Colour colour;
  if (ReadPictureColour(value, transfer, &colour,
                        "a colour ([r, g, b] or one number) or {\"checker\": ...}")) {
    material->base_colour = colour;
  }
}

Material ReadMaterial(const JsonCursor& value, Transfer transfer, NameTable* names) {
  Material material;
  JsonObject object(value);
  const JsonCursor name = object.Required("name");
  if (ReadNonEmptyName(name, &material.name)) names->Add(material.name, name);
  ReadBaseColour(object.Optional("base_colour"), transfer, &material);
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
Object ReadObject(const JsonCursor& value, const NameTable* materials, NameTable* names) {
  Object result;
  JsonObject object(value);
  const JsonCursor name = object.Optional("name");
  if (ReadName(name, &result.name)) names->Add(result.name, name);
  const JsonCursor shape = object.OneOf({"sphere", "quad", "triangle"});
  if (shape.present()) {
    if (shape.key() == "sphere") result.shape = ReadSphere(shape);
    if (shape.key() == "quad") result.shape = ReadQuad(shape);
    if (shape.key() == "triangle") result.shape = ReadTriangle(shape);
  }
  const JsonCursor material = object.Required("material");
  if (materials != nullptr) {
    result.material = materials->Find(material).value_or(0);
  } else {
    std::string unchecked;
    material.ReadString(&unchecked);
  }
  object.Finish();
  return result;
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

Scene ReadScene(const JsonCursor& root, const JsonErrors& errors) {
  Scene scene;
  JsonObject object(root);
  std::string schema;
  object.Optional("$schema").ReadString(&schema);
  scene.settings = ReadSettings(object.Optional("settings"));

  NameTable materials("material"), objects("object"), lights("light"), cameras("camera");
  object.Optional("materials").ForEachElement([&](const JsonCursor& element) {
    scene.materials.push_back(ReadMaterial(element, scene.settings.transfer, &materials));
  });
  const NameTable* known_materials = errors.first() ? nullptr : &materials;
  object.Optional("objects").ForEachElement([&](const JsonCursor& element) {
    scene.objects.push_back(ReadObject(element, known_materials, &objects));
  });
  object.Optional("lights").ForEachElement(
      [&](const JsonCursor& element) { scene.lights.push_back(ReadNamedLight(element, &lights)); });
  const JsonCursor camera_list = object.Required("cameras");
  if (camera_list.Is(JsonKind::kArray) && camera_list.IsEmpty()) {
    camera_list.Fail("a scene needs at least one camera");
  }
  camera_list.ForEachElement(
      [&](const JsonCursor& element) { scene.cameras.push_back(ReadCamera(element, &cameras)); });
  const NameTable* known_cameras = errors.first() ? nullptr : &cameras;
  object.Optional("views").ForEachMember(
      [&](const JsonCursor& member) { scene.views.push_back(ReadView(member, known_cameras)); });
  object.Finish();
  return scene;
}

Error InputError(const std::string& path, std::string_view what) {
  return Error{ErrorKind::kInputOutput, fmt::format("{}: {}", PrintablePath(path), what)};
}

Error SystemError(const std::string& path, std::string_view what, int code) {
  return InputError(path, fmt::format("{}: {}", what, std::generic_category().message(code)));
}

Result<std::string> ReadWholeFile(const std::string& path) {
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return SystemError(path, "cannot open", errno);
  // The size is only a hint, since pipes have none; the limit holds while reading.
  struct stat status {};
  std::string text;
  if (fstat(fileno(file.get()), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
    text.reserve(std::min(static_cast<std::size_t>(status.st_size), kMaxFileBytes) + 1);
  }
  char buffer[1 << 16];
  while (const std::size_t count = std::fread(buffer, 1, sizeof(buffer), file.get())) {
    if (text.size() + count > kMaxFileBytes) return InputError(path, "larger than 1 GiB");
    text.append(buffer, count);
  }
  if (std::ferror(file.get())) return SystemError(path, "cannot read", errno);
  return text;
}

}  // namespace

Result<Scene> ReadSceneJson(const std::string& path) {
  try {
    const Result<std::string> text = ReadWholeFile(path);
    if (!text) return text.error();
    return ParseSceneJson(text.value(), path);
  } catch (const std::bad_alloc&) {
    return InputError(path, "not enough memory to read the file");
  }
}

Result<Scene> ParseSceneJson(std::string_view text, const std::string& name) {
  // The limit also keeps the tree's 32-bit node indices from overflowing.
  if (text.size() > kMaxFileBytes) return InputError(name, "larger than 1 GiB");
  try {
    const Result<JsonTree> tree = ParseJsonTree(text, name);
    if (!tree) return tree.error();
    JsonErrors errors(tree.value(), name);
    Scene scene = ReadScene(JsonCursor(&errors, 0), errors);
    if (errors.first()) return *errors.first();
    return scene;
  } catch (const std::bad_alloc&) {
    return InputError(name, "not enough memory to read the scene");
  }
}

}  // namespace sheaf
