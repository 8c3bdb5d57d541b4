// What the window does, without the window: input moves the camera and the controls, these ask the
// render loop for pictures, and tasks beside it pick, save and read the scene anew.
#ifndef SHEAF_VIEW_VIEWER_H_
#define SHEAF_VIEW_VIEWER_H_

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/view/camera_rig.h"
#include "src/view/file_watch.h"
#include "src/view/keys.h"
#include "src/view/motion_report.h"
#include "src/view/pick.h"
#include "src/view/render_loop.h"
#include "src/view/view_frame.h"
#include "src/view/window.h"

namespace sheaf {

// A scene as it was read.
struct LoadedView {
  Scene scene;                     // with at least one camera
  std::vector<std::string> files;  // that it was read from
  std::vector<std::string> warnings;
  Development development;  // by the scene or the command line
};

// Reads the scene, the first time and whenever its files change; from any thread, one at a time.
using LoadView = std::function<Result<LoadedView>()>;

struct ViewerSetup {
  LoadView load;
  std::string scene_path;
  std::size_t camera = 0;  // of the scene, to begin with
  std::string view;        // likewise; empty: all cameras
  std::optional<int> samples, max_depth;
  std::optional<double> contrast;
  double min_throughput = 0;
  Target target;
  Precision precision = Precision::kStrict;
  int threads = 0;
  double frame_seconds = 1 / 30.0;  // of a picture in motion
  std::string save_prefix;          // of files: PREFIX-1.png, PREFIX-1.json
  double spin_seconds = 0;          // above 0: turns about the scene so long, and closes
  // Takes lines for standard output; from any thread.
  std::function<void(const std::string& line)> print;
  std::function<bool()> is_interrupted;  // whether the window shall close
};

class Viewer : public WindowClient {
 public:
  Viewer(ViewerSetup setup, LoadedView first);

  void Start(const std::function<void()>& wake) override;
  void Stop() override { loop_.reset(); }
  void Turn(const WindowInput& input, WindowFrame* frame) override;

  // For those that drive it without a window.
  const Camera& camera() const { return rig_.camera(); }
  const ViewControls& controls() const { return controls_; }
  std::shared_ptr<const ViewPicture> picture() const { return picture_; }
  const MotionReport& motion() const { return motion_; }

 private:
  // What of a turn changed the picture's wish.
  void Deliver();
  void Steer(const WindowInput& input);
  void Spin(double seconds);
  void Press(int key);
  void Do(Action action);
  void FollowControls();
  void PollFiles(double seconds);
  void Submit(const WindowInput& input);
  void Fill(const WindowInput& input, WindowFrame* frame);

  void StepCamera(int step);
  void StepView();
  void ChooseCamera(int camera);
  std::vector<int> CamerasOfView() const;
  void Accept(LoadedView loaded);
  void Reload();
  void PickAt(int x, int y);
  void SavePicture();
  void SaveCamera();
  void Meter();
  ViewControls DefaultsOf(const LoadedView& loaded) const;
  ViewRequest RequestOf(int width, int height) const;
  void LeaveForTurn(std::function<void()> result);
  std::string Title() const;
  std::vector<std::string> StatusLines() const;

  const ViewerSetup setup_;
  std::shared_ptr<const Scene> scene_;
  FileWatch watch_;
  CameraRig rig_;
  bool is_moved_ = false;  // the rig, away from the scene's camera
  ViewControls controls_, defaults_, followed_;
  ViewLists lists_;
  std::vector<Target> targets_;
  std::optional<ViewRequest> submitted_;
  bool is_stale_ = true;  // what was submitted is not what is wanted
  bool closes_ = false, is_panel_shown_ = true, is_flying_ = false;
  double last_seconds_ = 0, last_poll_ = 0;
  std::optional<double> spin_start_;
  double spun_degrees_ = 0;
  std::shared_ptr<const ViewPicture> picture_;
  MotionReport motion_;
  std::vector<std::string> pick_;
  std::string message_, load_error_;

  std::mutex mutex_;  // of what tasks leave for the next turn
  std::vector<std::function<void()>> results_;
  std::unique_ptr<RenderLoop> loop_;  // last: its tasks use all the others
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_VIEWER_H_
