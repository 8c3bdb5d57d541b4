#include "src/app/convert_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/choose_look.h"
#include "src/app/open_scene.h"
#include "src/app/output_path.h"
#include "src/app/picture_as_read.h"
#include "src/core/atomic_file.h"
#include "src/formats/format_table.h"
#include "src/formats/picture.h"
#include "src/formats/png.h"
#include "src/formats/printable.h"
#include "src/formats/read_scene.h"
#include "src/formats/write_scene_json.h"
#include "src/scene/textures.h"

namespace sheaf {
namespace {

struct ConvertRequest {
  SceneOptions options;
  std::string input, output;
  std::string format;  // of --format; empty: by the path's ending
  std::optional<int> bits;
  std::string transfer;  // empty: keep
  LookOptions look;
};

// The first option that only pictures take; null where there is none.
const char* GivenPictureOption(const ConvertRequest& request) {
  if (request.bits) return "--bits";
  if (!request.format.empty()) return "--format";
  if (!request.transfer.empty()) return "--transfer";
  return GivenLookOption(request.look);
}

// ---- Scenes ----

// With alpha only where it counts.
Status WriteImage(const Image& image, Transfer transfer, int channels, const std::string& path) {
  Picture8 picture{image.width, image.height, {}, channels};
  picture.rgb.reserve(static_cast<std::size_t>(channels) * image.texels.size());
  for (const std::uint32_t texel : image.texels) {
    for (int c = 0; c < channels; ++c) {
      picture.rgb.push_back(static_cast<std::uint8_t>(texel >> (8 * c) & 255));
    }
  }
  return WritePng(picture, transfer, path);
}

// The files of textures, by image. They are written beside the scene, as PNG.
struct TextureFile {
  std::string name;
  Transfer transfer = Transfer::kSrgb;  // of the first that uses the image
  int channels = 3;
};
using TextureFiles = std::map<const Image*, TextureFile>;

TextureFiles NameTextures(const Scene& scene, const std::filesystem::path& output) {
  TextureFiles files;
  for (const Material& material : scene.materials) {
    ForEachTexture(material, [&](const char* /*name*/, const Texture& texture) {
      const auto [entry, is_new] = files.try_emplace(texture.image.get());
      if (is_new) {
        entry->second = {fmt::format("{}-texture-{}.png", output.stem().string(), files.size()),
                         texture.transfer};
      }
      const bool is_base = std::get_if<Texture>(&material.base_colour) == &texture;
      if (is_base && material.alpha.mode != AlphaMode::kOpaque) entry->second.channels = 4;
    });
  }
  return files;
}

std::string PathBeside(const std::string& output, const std::string& name) {
  return (std::filesystem::path(output).parent_path() / name).string();
}

Status WriteTextures(const TextureFiles& files, const std::string& output, Scene* scene) {
  std::map<const Image*, std::shared_ptr<const Image>> renamed;
  for (const auto& [image, file] : files) {
    const Status status =
        WriteImage(*image, file.transfer, file.channels, PathBeside(output, file.name));
    if (!status) return status;
    Image copy = *image;
    copy.name = file.name;
    renamed[image] = std::make_shared<const Image>(std::move(copy));
  }
  for (Material& material : scene->materials) {
    ForEachTexture(material, [&](const char* /*name*/, Texture& texture) {
      texture.image = renamed[texture.image.get()];
    });
  }
  return Done{};
}

// The picture of the surroundings is written beside the scene, as PFM.
std::string EnvironmentName(const std::string& output) {
  return fmt::format("{}-environment.pfm", std::filesystem::path(output).stem().string());
}

EnvironmentMap* EnvironmentMapOf(Scene& scene) {
  auto& environment = scene.settings.environment;
  return environment ? std::get_if<EnvironmentMap>(&*environment) : nullptr;
}

Status WriteEnvironment(const std::string& output, Scene* scene) {
  EnvironmentMap* map = EnvironmentMapOf(*scene);
  if (map == nullptr) return Done{};
  FloatImage renamed = *map->image;
  renamed.name = EnvironmentName(output);
  Film film(renamed.width, renamed.height);
  std::copy(renamed.rgb.begin(), renamed.rgb.end(), film.rgb.begin());
  const std::string path = PathBeside(output, renamed.name);
  map->image = std::make_shared<const FloatImage>(std::move(renamed));
  return WritePicture(film, Transfer::kLinear, path);
}

Status ConvertScene(const ConvertRequest& request) {
  if (const char* option = GivenPictureOption(request)) {
    return Usage(
        fmt::format("{}: for pictures, and {} is a scene", option, PrintablePath(request.input)));
  }
  if (!IsScenePath(request.output) || IsModelPath(request.output)) {
    return Usage(fmt::format("-o {}: a scene becomes scene JSON, whose name ends in {}",
                             request.output, EndingsText([](const FileFormat& format) {
                               return format.content == FileContent::kScene;
                             })));
  }
  if (const Status writable = CheckWritable(request.output); !writable) return writable;
  SceneOptions options = request.options;
  options.floor = Floor::kUnderLoneModels;  // as render has it
  Result<OpenedScene> opened = OpenSceneAndFiles(request.input, options);
  if (!opened) return opened.error();
  Scene& scene = opened.value().scene;
  const TextureFiles textures = NameTextures(scene, request.output);
  std::vector<Output> outputs = {{"-o", request.output}};
  for (const auto& [image, file] : textures) {
    outputs.push_back({"-o", PathBeside(request.output, file.name)});
  }
  if (EnvironmentMapOf(scene) != nullptr) {
    outputs.push_back({"-o", PathBeside(request.output, EnvironmentName(request.output))});
  }
  const Status apart = CheckOutputs(outputs, opened.value().files);
  if (!apart) return apart;
  const Status written = WriteTextures(textures, request.output, &scene);
  if (!written) return written;
  const Status surrounded = WriteEnvironment(request.output, &scene);
  if (!surrounded) return surrounded;
  MakeNamesUnique(&scene);
  return WriteFileWhole(request.output, SceneJsonText(scene));
}

// ---- Pictures ----

Status ConvertPicture(const ConvertRequest& request) {
  if (const auto option = GivenSceneOption(request.options)) {
    return Usage(
        fmt::format("{}: for scenes, and {} is a picture", *option, PrintablePath(request.input)));
  }
  const Status wanted = CheckWritten(request.output, request.format, request.look, request.bits);
  if (!wanted) return wanted;
  if (const Status writable = CheckWritable(request.output); !writable) return writable;
  Result<ReadPictureResult> read = ReadPicture(request.input);
  if (!read) return read.error();
  ReadPictureResult& picture = read.value();
  const Film& film = picture.film;
  const bool keeps = request.transfer.empty() || request.transfer == "keep";
  const std::string named = FormatPath(request.output, request.format);
  PictureSpec spec = SpecAsRead(picture, named, request.bits, request.transfer);
  spec.format = request.format;
  const bool is_developed = GivenLookOption(request.look) != nullptr;
  if (keeps && picture.is_display && !HoldsFloats(named) && !is_developed) {
    // A .png that says nothing of its transfer makes one that says nothing.
    const bool is_known = picture.is_srgb || picture.is_linear;
    spec.values = is_known ? Values::kEncoded : Values::kNumbers;
  } else {
    DecodeLight(picture);
  }
  if (request.look.exposure) spec.ev = request.look.exposure->ev.value_or(MeterExposure(film));
  spec.tone = ToneOf(request.look, Tone::kLinear);
  if (HoldsLayers(named)) spec.layers = film.held_layers();
  return WritePicture(film, spec, request.output);
}

void AddConvertOptions(CLI::App& app, ConvertRequest& request) {
  AddInput(app, "INPUT", request.input, Presence::kNeeded, "A scene, a model or a picture");
  AddOutput(app, request.output, "PATH", "The ending chooses the format (needed)");
  AddPictureFormat(app, request.format);
  AddBits(app, request.bits);
  AddTransfer(app, request.transfer);
  AddLookOptions(app, request.look);
  AddSceneOptions(app, request.options);
  AddMomentOptions(app, request.options);
}

Status RunConvert(const ConvertRequest& given) {
  ConvertRequest request = given;
  if (request.output == "-") request.output = kStandardOutputPath;
  const Status apart = CheckOutputs({{"-o", request.output}}, {request.input});
  if (!apart) return apart;
  if (CheckPicturePath(request.input)) return ConvertPicture(request);
  if (IsScenePath(request.input)) return ConvertScene(request);
  return Usage(fmt::format("{}: neither a scene ({}) nor a picture ({})", request.input,
                           SceneEndings(), PictureEndings()));
}

}  // namespace

Command ConvertCommand() { return MakeCommand(&AddConvertOptions, &RunConvert); }

}  // namespace sheaf
