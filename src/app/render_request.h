// What the command line of `sheaf render` asks for.
#ifndef SHEAF_APP_RENDER_REQUEST_H_
#define SHEAF_APP_RENDER_REQUEST_H_

#include <optional>
#include <string>

#include "sheaf/render.h"
#include "src/app/choose.h"
#include "src/app/choose_look.h"
#include "src/app/open_scene.h"
#include "src/app/parse_options.h"

namespace CLI {
class App;
}

namespace sheaf {

// What --tile says: which of how many parts of the picture, from 1.
struct PicturePart {
  int part, parts;
};

// The frames of an animation, both ends included.
struct FrameRange {
  int first, last;
  int count() const { return last - first + 1; }
};

// The command line as it was given. What is absent comes from the scene.
struct RenderRequest {
  SceneOptions options;
  std::string scene;
  CameraChoice choice;
  std::optional<FrameRange> frames;
  std::optional<int> turntable;  // frames of a whole turn
  std::string output;            // "-": standard output
  std::string format;            // of --format; empty: by the path's ending
  std::optional<PixelSize> size;
  std::string integrator;  // empty: the scene's
  std::optional<int> samples, max_depth;
  std::optional<double> error, contrast, min_throughput;
  std::optional<double> budget;  // seconds a picture
  std::string target = "auto";
  std::string precision = "strict";
  std::optional<int> threads, bits, tile_size;
  std::optional<PicturePart> part;
  std::optional<PixelRect> crop;
  LookOptions look;
  Layers layers;        // of --aov
  std::string denoise;  // the filter; empty: none
  bool resume = false;
  std::string identity;  // the options that a picture's bits depend on, as text
  std::string work;      // the same, of all that ranks must have in common
  std::string progress = "auto";
  bool quiet = false, no_floor = false;
  std::string statistics;  // empty: none; "-": stdout; else a file
};

// Parsing then fills `request`, which has to outlive `app`.
void AddRenderOptions(CLI::App& app, RenderRequest& request);

}  // namespace sheaf

#endif  // SHEAF_APP_RENDER_REQUEST_H_
