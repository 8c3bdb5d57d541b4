// What the window does without the window: the plan of frames, the camera in hand, files on watch.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <string>
#include <variant>

#include "folder.h"
#include "sheaf/scene.h"
#include "src/view/camera_rig.h"
#include "src/view/file_watch.h"
#include "src/view/frame_plan.h"
#include "src/view/motion_report.h"

namespace sheaf {
namespace {

constexpr double kBudget = 1 / 30.0;

// Renders in no time but the clock's: what a pixel and a frame cost.
struct Pretender {
  double seconds_a_pixel, fixed;
  double now = 0;

  // The next job, done; its seconds.
  double Do(FramePlan& plan, FrameJob* done = nullptr) {
    const std::optional<FrameJob> job = plan.Next(now);
    REQUIRE(job);
    const double seconds =
        fixed + seconds_a_pixel * job->samples * job->width * static_cast<double>(job->height);
    now += seconds;
    plan.Finish(*job, seconds, fixed);
    if (done != nullptr) *done = *job;
    return seconds;
  }
};

TEST_CASE("a picture in motion has as many pixels as its time allows") {
  for (const double whole : {0.001, 0.02, 0.05, 0.5, 20.0}) {
    CAPTURE(whole);
    const FrameGoal goal{1280, 960, 16};
    Pretender machine{whole / (1280 * 960), 0};
    FramePlan plan(kBudget);
    plan.SetGoal(goal, 0);
    FrameJob job;
    double seconds = 0;
    for (int i = 0; i < 12; ++i) {
      plan.Restart(machine.now);
      seconds = machine.Do(plan, &job);
      CHECK(job.is_draft);
      CHECK(job.samples == 1);
    }
    CHECK(seconds <= kBudget * 1.01);
    // A side more by 2^(1/8) would not fit with room to spare.
    const bool is_whole = job.width == goal.width && job.height == goal.height;
    CHECK(is_whole == (whole <= 0.92 * kBudget));
    if (!is_whole) CHECK(seconds >= kBudget * 0.92 / std::exp2(0.25) * 0.97);
    CHECK(std::abs(job.width * 3.0 / 4 - job.height) <= 1);
  }
}

TEST_CASE("a tree that takes the time of a frame leaves a picture of some pixels") {
  Pretender machine{1e-7, 0.2};
  FramePlan plan(kBudget);
  plan.SetGoal({1280, 960, 1}, 0);
  FrameJob job;
  for (int i = 0; i < 12; ++i) {
    plan.Restart(machine.now);
    machine.Do(plan, &job);
  }
  CHECK(job.width > 200);
}

TEST_CASE("a frame that was given up makes the next one smaller") {
  FramePlan plan(kBudget);
  plan.SetGoal({1280, 960, 1}, 0);
  const FrameJob before = *plan.Next(0);
  plan.GiveUp(0.2, 1000);
  const FrameJob after = *plan.Next(0.2);
  CHECK(after.width < before.width);
  CHECK(after.width * after.height * (0.2 / 1000) <= kBudget);
}

TEST_CASE("a picture at rest gets finer, up to the samples that are wanted") {
  Pretender machine{1e-6, 0.001};
  FramePlan plan(kBudget);
  plan.SetGoal({640, 480, 24}, 0);
  FrameJob job;
  machine.Do(plan, &job);
  CHECK(job.is_draft);
  CHECK(job.width < 640);
  // Not at once: a hand that moves the camera would be in the way of its own drafts.
  CHECK(!plan.Next(machine.now));
  const double wait = plan.Wait(machine.now);
  CHECK(wait > 0);
  CHECK(wait < 0.2);
  machine.now += wait;
  for (const int samples : {1, 4, 16, 24}) {
    CHECK(!plan.is_finished());
    machine.Do(plan, &job);
    CHECK(job == FrameJob{640, 480, samples, false});
  }
  CHECK(plan.is_finished());
  CHECK(!plan.Next(machine.now));
  CHECK(plan.Wait(machine.now) == 0);

  plan.Restart(machine.now);
  CHECK(plan.Next(machine.now)->is_draft);
  CHECK(!plan.is_finished());
}

TEST_CASE("a draft of all pixels is the first picture at rest") {
  Pretender machine{1e-9, 0};
  FramePlan plan(kBudget);
  plan.SetGoal({64, 48, 4}, 0);
  machine.Do(plan);  // in an eighth, because nothing is known yet
  plan.Restart(machine.now);
  FrameJob job;
  machine.Do(plan, &job);
  CHECK(job == FrameJob{64, 48, 1, true});
  machine.now += 1;
  machine.Do(plan, &job);
  CHECK(job == FrameJob{64, 48, 4, false});
  CHECK(plan.is_finished());
}

Camera Looking() {
  Camera camera;
  camera.eye = {0, 0, 5};
  camera.look_at = {0, 0, 0};
  return camera;
}

bool IsNear(const Vec3d& a, const Vec3d& b) { return glm::length(a - b) < 1e-9; }

TEST_CASE("an orbit keeps the distance and what is looked at") {
  CameraRig rig(Looking());
  rig.Orbit(90, 0);
  CHECK(IsNear(rig.camera().eye, {5, 0, 0}));
  rig.Orbit(0, 30);
  CHECK(IsNear(rig.camera().eye, {5 * std::sqrt(0.75), 2.5, 0}));
  CHECK(rig.camera().look_at == Vec3d(0));
  CHECK(rig.camera().up == Vec3d(0, 1, 0));  // to the bit
  // Never over the pole.
  rig.Orbit(0, 1000);
  CHECK(rig.camera().eye.y == doctest::Approx(5 * std::sin(89 * 3.14159265358979 / 180)));
  rig.Orbit(0, -1000);
  CHECK(rig.camera().eye.y == doctest::Approx(-5 * std::sin(89 * 3.14159265358979 / 180)));
  CHECK(Validate(rig.camera()));
}

TEST_CASE("looking around turns about the eye") {
  CameraRig rig(Looking());
  rig.Look(90, 0);
  CHECK(rig.camera().eye == Vec3d(0, 0, 5));
  CHECK(IsNear(rig.camera().look_at, {5, 0, 5}));
  rig.Look(0, 30);
  CHECK(rig.camera().look_at.y == doctest::Approx(2.5));
}

TEST_CASE("flight, zoom and angle") {
  CameraRig rig(Looking());
  rig.Fly(0, 0, 0.2);
  CHECK(IsNear(rig.camera().eye, {0, 0, 4}));
  CHECK(IsNear(rig.camera().look_at, {0, 0, -1}));
  rig.Fly(0.2, 0.4, 0);
  CHECK(IsNear(rig.camera().eye, {1, 2, 4}));
  rig.Zoom(0.5);
  CHECK(IsNear(rig.camera().eye, {1, 2, 1.5}));
  CHECK(IsNear(rig.camera().look_at, {1, 2, -1}));
  for (int i = 0; i < 1000; ++i) rig.Zoom(0.5);
  CHECK(Validate(rig.camera()));
  for (int i = 0; i < 1000; ++i) rig.Zoom(2);
  for (int i = 0; i < 1000; ++i) rig.Fly(0, 0, 1);
  CHECK(Validate(rig.camera()));

  rig = CameraRig(Looking());
  rig.Widen(0.5);
  CHECK(std::get<Perspective>(rig.camera().projection).fov_y == 30);
  for (int i = 0; i < 100; ++i) rig.Widen(2);
  CHECK(Validate(rig.camera()));

  Camera flat = Looking();
  flat.projection = Orthographic{4};
  rig = CameraRig(flat);
  rig.Zoom(0.5);
  CHECK(std::get<Orthographic>(rig.camera().projection).height == 2);
  CHECK(rig.camera().eye == flat.eye);
}

void Write(const std::string& path, const std::string& text) { std::ofstream(path) << text; }

TEST_CASE("a file that changed is seen once, when it stands still") {
  const Folder folder;
  const std::string scene = folder / "scene", part = folder / "part";
  Write(scene, "one");
  Write(part, "one");
  FileWatch watch;
  watch.Watch({scene, part});
  CHECK(!watch.HasChanged());
  CHECK(!watch.HasChanged());

  Write(part, "a longer one");
  CHECK(!watch.HasChanged());  // it may still be written
  CHECK(watch.HasChanged());
  CHECK(!watch.HasChanged());

  // Another file in its place, of one size and time, and none.
  const auto time = std::filesystem::last_write_time(scene);
  Write(folder / "other", "two");
  std::filesystem::last_write_time(folder / "other", time);
  std::filesystem::rename(folder / "other", scene);
  CHECK(!watch.HasChanged());
  CHECK(watch.HasChanged());
  std::filesystem::remove(part);
  CHECK(!watch.HasChanged());
  CHECK(watch.HasChanged());
  CHECK(!watch.HasChanged());

  // A change between the look and the new watch is not lost.
  Write(scene, "changed while it is read");
  watch.Watch({scene});
  CHECK(!watch.HasChanged());
  CHECK(watch.HasChanged());
}

TEST_CASE("pictures in motion are counted by their intervals") {
  MotionReport report;
  ViewPicture picture;
  picture.width = 640;
  picture.height = 480;
  CHECK(report.Text().empty());
  for (int i = 0; i <= 20; ++i) report.Add(picture, 10 + i * 0.05);
  report.Pause();
  report.Add(picture, 100);  // a pause is no interval
  CHECK(report.Text() ==
        "in motion: 20 pictures in 1.00 s, 20.0 a second, median 640x480, longest interval 50 ms");
  CHECK(report.RecentRate(100.5) == 1);
  CHECK(report.RecentRate(102) == 0);
}

}  // namespace
}  // namespace sheaf
