// What the viewer does beside its frames: picks, saves, metered exposure.
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "src/core/atomic_file.h"
#include "src/formats/printable.h"
#include "src/view/pick.h"
#include "src/view/save_files.h"
#include "src/view/viewer.h"

namespace sheaf {

void Viewer::PickAt(int x, int y) {
  const ViewRequest request = *submitted_;
  if (x < 0 || y < 0 || x >= request.goal.width || y >= request.goal.height) return;
  loop_->Post([this, request, x, y](ShownFilm&) {
    const Result<Pick> pick = PickPixel(request, x, y);
    const std::vector<std::string> lines =
        pick ? LinesOf(pick.value()) : std::vector{pick.error().message};
    for (const std::string& line : lines) setup_.print(line);
    LeaveForTurn([this, lines] { pick_ = lines; });
  });
}

void Viewer::SavePicture() {
  const PictureMetadata metadata = {{"Scene", setup_.scene_path}, {"Camera", rig_.camera().name}};
  loop_->Post([this, metadata](ShownFilm& film) {
    if (film.width() == 0) return;
    int number = 0;
    const std::string path = NextFreePath(setup_.save_prefix, "png", &number);
    const Status written = film.Write(path, metadata);
    const std::string line = written
                                 ? fmt::format("wrote {}, {}x{}", path, film.width(), film.height())
                                 : written.error().message;
    setup_.print(line);
    LeaveForTurn([this, line] { message_ = line; });
  });
}

void Viewer::SaveCamera() {
  int number = 0;
  const std::string path = NextFreePath(setup_.save_prefix, "json", &number);
  const std::string text = CameraFileText(rig_.camera(), fmt::format("view {}", number));
  const Status written = WriteFileWhole(path, text);
  message_ =
      written ? fmt::format("wrote {}, camera \"view {}\"", path, number) : written.error().message;
  setup_.print(message_);
}

void Viewer::Meter() {
  loop_->Post([this](ShownFilm& film) {
    if (film.width() == 0) return;
    const double ev = film.Meter();
    LeaveForTurn([this, ev] {
      if (controls_.shown == static_cast<int>(Shown::kColour)) controls_.ev = ev;
    });
  });
}

}  // namespace sheaf
