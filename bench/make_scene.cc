// Writes one of the frame scenes as scene JSON, for `sheaf render`, or for POV-Ray.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bench/frame_scenes.h"
#include "src/core/atomic_file.h"
#include "src/formats/write_scene_json.h"
#include "src/lab/pov_ray.h"

int main(int argc, char** argv) {
  using sheaf::bench::FrameScene;
  const auto scenes = sheaf::bench::FrameScenes();
  CLI::App app("Writes one of the scenes that whole frames are timed on, as scene JSON.");
  std::string name, output;
  bool lists = false, for_pov = false;
  auto* list = app.add_flag("--list", lists, "the scenes");
  app.add_option("NAME", name, "the scene")->excludes(list);
  app.add_option("-o,--output", output, "the file; stdout if absent")->option_text("FILE");
  app.add_flag("--pov", for_pov, "for POV-Ray 3.7 instead");
  try {
    app.parse(argc, argv);
    if (!lists && name.empty()) throw CLI::RequiredError("NAME");
  } catch (const CLI::CallForHelp& error) {
    return app.exit(error);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return 2;
  }
  if (lists) {
    for (const FrameScene& scene : scenes) fmt::print("{:8}{}\n", scene.name, scene.what);
    return EXIT_SUCCESS;
  }
  const auto found = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const FrameScene& scene) { return name == scene.name; });
  if (found == scenes.end()) {
    fmt::print(stderr, "make_scene: unknown scene \"{}\"; --list shows them\n", name);
    return 2;
  }
  const sheaf::Scene scene = found->make();
  const std::string text =
      for_pov ? sheaf::PovText(scene, scene.cameras.at(0)) : sheaf::SceneJsonText(scene);
  if (output.empty()) {
    const bool written = std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0;
    return written ? EXIT_SUCCESS : 4;
  }
  const sheaf::Status written = sheaf::WriteFileWhole(output, text);
  if (!written) {
    fmt::print(stderr, "make_scene: {}\n", written.error().message);
    return 4;
  }
  return EXIT_SUCCESS;
}
