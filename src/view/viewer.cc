#include "src/view/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "src/core/atomic_file.h"
#include "src/formats/printable.h"
#include "src/view/save_files.h"

namespace sheaf {
namespace {

constexpr double kDegreesAPixel = 0.25;   // of a drag
constexpr double kZoomANotch = 1 / 1.15;  // of the wheel
constexpr double kFlightASecond = 0.6;    // in distances to what is looked at
constexpr double kPollSeconds = 0.25;     // between looks at files
constexpr double kSpinDegrees = 40;       // a second
constexpr int kUsualSamples = 16;         // where the scene asks for one
constexpr double kUsualContrast = 0.05;   // likewise
constexpr int kMostSamples = 4096;        // that keys and sliders ask for

template <typename T>
std::vector<std::string> NamesOf(const std::vector<T>& items) {
  std::vector<std::string> names;
  for (const T& item : items) names.push_back(Printable(item.name));
  return names;
}

template <typename T>
int IndexOfName(const std::vector<T>& items, const std::string& name, int otherwise) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const T& item) { return item.name == name; });
  return found == items.end() ? otherwise : static_cast<int>(found - items.begin());
}

}  // namespace

Viewer::Viewer(ViewerSetup setup, LoadedView first) : setup_(std::move(setup)) {
  for (const std::string& name : UsableTargets()) targets_.push_back(*Target::Named(name));
  targets_.push_back(Target::Scalar());
  lists_.besides = {"nothing"};
  for (const Target& target : targets_) {
    lists_.targets.push_back(target.name());
    lists_.besides.push_back(target.name());
  }
  for (const Integrator integrator : kIntegrators) {
    lists_.integrators.push_back(IntegratorName(integrator));
  }
  for (const Precision precision : kPrecisions) {
    lists_.precisions.push_back(PrecisionName(precision));
  }
  for (int i = 0; i < kShownCount; ++i) lists_.shown.push_back(ShownName(static_cast<Shown>(i)));
  lists_.tones = {"linear", "filmic"};

  controls_.precision = static_cast<int>(setup_.precision);
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    if (targets_[i].name() == setup_.target.name()) controls_.target = static_cast<int>(i);
  }
  Accept(std::move(first));
  ChooseCamera(static_cast<int>(setup_.camera));
  controls_.view = 1 + IndexOfName(scene_->views, setup_.view, -1);
  followed_ = controls_;
}

void Viewer::Start(const std::function<void()>& wake) {
  loop_ = std::make_unique<RenderLoop>(setup_.frame_seconds, wake);
}

ViewControls Viewer::DefaultsOf(const LoadedView& loaded) const {
  const Settings& settings = loaded.scene.settings;
  ViewControls defaults;
  const bool is_plain = !setup_.samples && settings.samples == 1 && !setup_.contrast;
  defaults.samples = setup_.samples.value_or(is_plain ? kUsualSamples : settings.samples);
  std::optional<double> contrast = setup_.contrast;
  if (!setup_.samples && !contrast) contrast = is_plain ? kUsualContrast : settings.contrast;
  defaults.contrast = contrast.value_or(0);
  defaults.integrator = static_cast<int>(settings.integrator);
  defaults.max_depth = setup_.max_depth.value_or(settings.max_depth);
  defaults.ev = loaded.development.ev;
  defaults.tone = loaded.development.tone == Tone::kFilmic ? 1 : 0;
  return defaults;
}

// What the user has changed stays; what is as the scene had it follows the scene.
void Viewer::Accept(LoadedView loaded) {
  const ViewControls old = defaults_;
  const bool is_first = !scene_;
  const auto old_scene = scene_;
  defaults_ = DefaultsOf(loaded);
  const auto follow = [&](auto member) {
    if (is_first || controls_.*member == old.*member) controls_.*member = defaults_.*member;
  };
  follow(&ViewControls::samples);
  follow(&ViewControls::integrator);
  follow(&ViewControls::max_depth);
  follow(&ViewControls::contrast);
  follow(&ViewControls::ev);
  follow(&ViewControls::tone);
  watch_.Watch(loaded.files);
  scene_ = std::make_shared<const Scene>(std::move(loaded.scene));
  lists_.cameras = NamesOf(scene_->cameras);
  lists_.views = {"all cameras"};
  for (const std::string& name : NamesOf(scene_->views)) lists_.views.push_back(name);
  if (!is_first) {
    const std::string camera = old_scene->cameras[static_cast<std::size_t>(controls_.camera)].name;
    const int index = IndexOfName(scene_->cameras, camera, 0);
    if (is_moved_) {
      controls_.camera = index;
    } else {
      ChooseCamera(index);
    }
    const auto view = static_cast<std::size_t>(controls_.view);
    const std::string view_name = view > 0 ? old_scene->views[view - 1].name : std::string();
    controls_.view = 1 + IndexOfName(scene_->views, view_name, -1);
    followed_ = controls_;
  }
  is_stale_ = true;
}

void Viewer::LeaveForTurn(std::function<void()> result) {
  const std::lock_guard lock(mutex_);
  results_.push_back(std::move(result));
}

void Viewer::Deliver() {
  std::vector<std::function<void()>> results;
  {
    const std::lock_guard lock(mutex_);
    results.swap(results_);
  }
  for (const std::function<void()>& result : results) result();
}

void Viewer::Reload() {
  loop_->Post([this](ShownFilm&) {
    auto loaded = std::make_shared<Result<LoadedView>>(setup_.load());
    LeaveForTurn([this, loaded] {
      if (!loaded->ok()) {
        load_error_ = loaded->error().message;
        return;
      }
      load_error_.clear();
      message_ = "read anew: " + PrintablePath(setup_.scene_path);
      if (!loaded->value().warnings.empty()) message_ += "; " + loaded->value().warnings.front();
      Accept(std::move(*loaded).value());
    });
  });
}

void Viewer::PollFiles(double seconds) {
  if (seconds - last_poll_ < kPollSeconds) return;
  last_poll_ = seconds;
  if (watch_.HasChanged()) Reload();
}

void Viewer::ChooseCamera(int camera) {
  controls_.camera = camera;
  rig_ = CameraRig(scene_->cameras[static_cast<std::size_t>(camera)]);
  is_moved_ = false;
  is_stale_ = true;
}

std::vector<int> Viewer::CamerasOfView() const {
  std::vector<int> cameras;
  if (controls_.view > 0) {
    for (const std::uint32_t i :
         scene_->views[static_cast<std::size_t>(controls_.view) - 1].cameras) {
      cameras.push_back(static_cast<int>(i));
    }
  } else {
    for (std::size_t i = 0; i < scene_->cameras.size(); ++i) cameras.push_back(static_cast<int>(i));
  }
  return cameras;
}

void Viewer::StepCamera(int step) {
  const std::vector<int> cameras = CamerasOfView();
  const auto at = std::find(cameras.begin(), cameras.end(), controls_.camera);
  const int count = static_cast<int>(cameras.size());
  const int from =
      at == cameras.end() ? (step > 0 ? -1 : 0) : static_cast<int>(at - cameras.begin());
  ChooseCamera(cameras[static_cast<std::size_t>((from + step + count) % count)]);
}

void Viewer::StepView() {
  controls_.view = (controls_.view + 1) % static_cast<int>(lists_.views.size());
}

// The panel changed the controls between two turns, or a key did in this one.
void Viewer::FollowControls() {
  if (controls_ == followed_) return;
  if (controls_.view != followed_.view && controls_.camera == followed_.camera) {
    const std::vector<int> cameras = CamerasOfView();
    if (std::find(cameras.begin(), cameras.end(), controls_.camera) == cameras.end()) {
      controls_.camera = cameras.front();
    }
  }
  if (controls_.camera != followed_.camera) ChooseCamera(controls_.camera);
  controls_.samples = std::clamp(controls_.samples, 1, kMaxSamples);
  controls_.max_depth = std::clamp(controls_.max_depth, 0, kMaxDepth);
  controls_.contrast = std::clamp(controls_.contrast, 0.0, 1.0);
  controls_.ev = std::clamp(controls_.ev, -kMaxEv, kMaxEv);
  followed_ = controls_;
  is_stale_ = true;
}

void Viewer::Steer(const WindowInput& input) {
  const double passed = std::clamp(input.seconds - last_seconds_, 0.0, 0.1);
  const auto x = [&](Drag drag) { return input.drag_x[static_cast<int>(drag)]; };
  const auto y = [&](Drag drag) { return input.drag_y[static_cast<int>(drag)]; };
  const auto is_dragged = [&](Drag drag) { return x(drag) != 0 || y(drag) != 0; };
  bool is_steered = false;
  // The scene follows the hand: a drag to the right takes the eye to the left.
  if (is_dragged(Drag::kOrbit)) {
    rig_.Orbit(-kDegreesAPixel * x(Drag::kOrbit), kDegreesAPixel * y(Drag::kOrbit));
    is_steered = true;
  }
  if (is_dragged(Drag::kLook)) {
    rig_.Look(kDegreesAPixel * x(Drag::kLook), -kDegreesAPixel * y(Drag::kLook));
    is_steered = true;
  }
  if (is_dragged(Drag::kPan) && input.height > 0) {
    rig_.Fly(-x(Drag::kPan) / input.height, y(Drag::kPan) / input.height, 0);
    is_steered = true;
  }
  if (input.wheel != 0) {
    rig_.Zoom(std::pow(kZoomANotch, input.wheel));
    is_steered = true;
  }
  const auto held = [&](char key) { return input.held.find(key) != std::string::npos ? 1.0 : 0.0; };
  const Vec3d way(held('D') - held('A'), held('E') - held('Q'), held('W') - held('S'));
  is_flying_ = way != Vec3d(0.0);
  if (is_flying_) {
    const Vec3d step = way * (passed * kFlightASecond * (input.is_fast ? 4 : 1));
    rig_.Fly(step.x, step.y, step.z);
    is_steered = true;
  }
  is_moved_ |= is_steered;
  is_stale_ |= is_steered;
}

void Viewer::Spin(double seconds) {
  if (setup_.spin_seconds <= 0 || !picture_) return;
  if (!spin_start_) spin_start_ = seconds;
  const double passed = seconds - *spin_start_;
  closes_ |= passed >= setup_.spin_seconds;
  rig_.Orbit(kSpinDegrees * passed - spun_degrees_, 0);
  spun_degrees_ = kSpinDegrees * passed;
  is_moved_ = true;
  is_stale_ = true;
}

void Viewer::Press(int key) {
  for (const Key& known : Keys()) {
    if (known.key == key) return Do(known.action);
  }
}

void Viewer::Do(Action action) {
  constexpr double kThird = 1.0 / 3;
  switch (action) {
    case Action::kClose:
      closes_ = true;
      return;
    case Action::kNextCamera:
      return StepCamera(1);
    case Action::kPreviousCamera:
      return StepCamera(-1);
    case Action::kNextView:
      return StepView();
    case Action::kReset:
      return ChooseCamera(controls_.camera);
    case Action::kNextTarget:
      controls_.target = (controls_.target + 1) % static_cast<int>(targets_.size());
      return;
    case Action::kBeside:
      controls_.beside = controls_.beside == 0 ? static_cast<int>(targets_.size()) : 0;
      return;
    case Action::kBrighter:
      controls_.ev += kThird;
      return;
    case Action::kDarker:
      controls_.ev -= kThird;
      return;
    case Action::kMeter:
      return Meter();
    case Action::kMoreSamples:
      controls_.samples = std::min(controls_.samples * 2, kMostSamples);
      return;
    case Action::kFewerSamples:
      controls_.samples = std::max(controls_.samples / 2, 1);
      return;
    case Action::kWider:
    case Action::kNarrower:
      rig_.Widen(action == Action::kWider ? 1.1 : 1 / 1.1);
      is_moved_ = is_stale_ = true;
      return;
    case Action::kSavePicture:
      return SavePicture();
    case Action::kSaveCamera:
      return SaveCamera();
    case Action::kPanel:
      is_panel_shown_ = !is_panel_shown_;
      return;
    default:  // the actions that show something
      controls_.shown = static_cast<int>(action) - static_cast<int>(Action::kShowFirst);
  }
}

ViewRequest Viewer::RequestOf(int width, int height) const {
  ViewRequest request;
  request.scene = scene_;
  request.camera = rig_.camera();
  request.shown = static_cast<Shown>(controls_.shown);
  // A layer is that of the first sample; only what a frame took depends on the others.
  const bool is_layer = request.shown != Shown::kColour && request.shown != Shown::kHeat &&
                        request.shown != Shown::kLanes;
  request.goal = {width, height, is_layer ? 1 : controls_.samples};
  request.max_depth = controls_.max_depth;
  request.integrator = static_cast<Integrator>(controls_.integrator);
  if (controls_.contrast > 0) request.contrast = controls_.contrast;
  request.min_throughput = setup_.min_throughput;
  request.precision = static_cast<Precision>(controls_.precision);
  request.target = targets_[static_cast<std::size_t>(controls_.target)];
  if (controls_.beside > 0) {
    request.beside = targets_[static_cast<std::size_t>(controls_.beside) - 1];
  }
  request.threads = setup_.threads;
  request.development = {controls_.ev, controls_.tone == 1 ? Tone::kFilmic : Tone::kLinear};
  return request;
}

void Viewer::Submit(const WindowInput& input) {
  if (input.width <= 0 || input.height <= 0) return;
  const int width = std::min(input.width, kMaxImageSide);
  const int height = std::min(input.height, kMaxImageSide);
  const bool is_resized =
      !submitted_ || submitted_->goal.width != width || submitted_->goal.height != height;
  if (!is_stale_ && !is_resized) return;
  submitted_ = RequestOf(width, height);
  loop_->Submit(*submitted_);
  is_stale_ = false;
}

void Viewer::Turn(const WindowInput& input, WindowFrame* frame) {
  closes_ |= setup_.is_interrupted();
  Deliver();
  for (const int key : input.pressed) Press(key);
  FollowControls();
  Steer(input);
  Spin(input.seconds);
  PollFiles(input.seconds);
  Submit(input);
  if (input.is_clicked && submitted_) PickAt(input.click_x, input.click_y);
  last_seconds_ = input.seconds;
  Fill(input, frame);
}

}  // namespace sheaf
