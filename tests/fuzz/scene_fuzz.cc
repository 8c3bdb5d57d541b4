// A scene or model from memory, of the format that SHEAF_FUZZ_ENDING names. An OBJ has its library
// behind the first zero byte. What is read keeps the rules of <sheaf/scene.h>, and written as scene
// JSON it can be read again.
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/formats/format_table.h"
#include "src/formats/scene_files.h"
#include "src/formats/scene_json.h"
#include "src/formats/write_scene_json.h"
#include "src/scene/textures.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using namespace sheaf;

// A folder of this process alone, in memory where the system has such.
std::string Folder() {
  // Never destroyed: it is read at exit.
  static const std::string& folder = *new std::string([] {
    std::error_code failed;
    const std::filesystem::path memory("/dev/shm");
    const auto root = std::filesystem::is_directory(memory, failed)
                          ? memory
                          : std::filesystem::temp_directory_path();
    const auto path = root / ("sheaf-fuzz-" + std::to_string(getpid()));
    std::filesystem::create_directories(path);
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(Folder(), ignored);
    });
    return path.string();
  }());
  return folder;
}

bool HasImages(const Scene& scene) {
  bool has = scene.settings.environment &&
             std::holds_alternative<EnvironmentMap>(*scene.settings.environment);
  for (const Material& material : scene.materials) {
    ForEachTexture(material, [&](const char*, const Texture&) { has = true; });
  }
  return has;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = Folder() + "/scene" SHEAF_FUZZ_ENDING;
  std::string_view text(reinterpret_cast<const char*>(data), size);
  if (std::string_view(SHEAF_FUZZ_ENDING) == ".obj") {
    const std::size_t end = text.find('\0');
    if (end != std::string_view::npos) {
      std::ofstream(Folder() + "/a.mtl", std::ios::binary) << text.substr(end + 1);
      text = text.substr(0, end);
    }
  }
  SceneFiles files(path, {});
  files.Enter(path);
  Result<Scene> read = FindFormat(path)->parse(text, path, files);
  if (!read) {
    if (read.error().message.empty()) fuzz::Fail("an error without a message");
    return 0;
  }
  Scene& scene = read.value();
  if (const Status valid = Validate(scene); !valid) fuzz::Fail(valid.error().message);
  if (HasImages(scene)) return 0;  // they would have to be written first
  // A model without a camera is framed only as a whole scene is read.
  if (scene.cameras.empty()) scene.cameras.emplace_back();
  MakeNamesUnique(&scene);
  const std::string written = SceneJsonText(scene);
  if (const Result<Scene> again = ParseSceneJson(written, "written.json"); !again) {
    fuzz::Fail(again.error().message + "\n" + written.substr(0, 4000));
  }
  return 0;
}
