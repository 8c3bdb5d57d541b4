// Writes a frame's picture row by row, and its layers beside it.
#ifndef SHEAF_APP_FRAME_WRITER_H_
#define SHEAF_APP_FRAME_WRITER_H_

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/app/choose_look.h"
#include "src/formats/picture.h"
#include "src/view/show_layer.h"

namespace sheaf {

// One picture to make.
struct Frame {
  const Camera* camera;
  std::size_t camera_index;   // of the scene
  std::optional<int> number;  // in a sequence
  std::string path;
  std::string format;  // what the path has to end in, without the dot; empty: it does
  std::vector<std::pair<Layer, std::string>> beside;  // layers in files of their own
  std::optional<Look> look = {};  // of a picture of bytes; none: found when it is rendered
  bool is_denoised = false;
};

// The picture of a frame, and its layers where they have files of their own.
class FrameWriter {
 public:
  static Result<FrameWriter> Create(const Scene& scene, const Frame& frame,
                                    const RenderOptions& options, std::optional<int> bits,
                                    const std::string& scene_path);

  Status WriteRows(const Film& rows);
  Status Finish();

 private:
  struct Beside {
    Layer layer;
    LayerLook look;
    PictureWriter writer;
  };
  explicit FrameWriter(PictureWriter picture) : picture_(std::move(picture)) {}

  PictureWriter picture_;
  std::vector<Beside> beside_;
  double far_ = 1;  // where depth is shown: what it is black at
};

}  // namespace sheaf

#endif  // SHEAF_APP_FRAME_WRITER_H_
