// The viewer, driven turn by turn as the window drives it, but without one.
#include <doctest/doctest.h>

#include <chrono>
#include <cstdint>
#include <glm/geometric.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "folder.h"
#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/formats/quantize.h"
#include "src/lab/object_at.h"
#include "src/lab/stress.h"
#include "src/scene/develop.h"
#include "src/view/keys.h"
#include "src/view/pick.h"
#include "src/view/show_layer.h"
#include "src/view/viewer.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

constexpr int kWidth = 64, kHeight = 48;

// A viewer, the clock of its turns, and what it prints.
class Hand {
 public:
  explicit Hand(const std::string& path, int samples = 4) {
    setup_.scene_path = path;
    setup_.samples = samples;
    setup_.save_prefix = folder_ / "saved";
    setup_.load = [path]() -> Result<LoadedView> {
      Result<ReadSceneResult> read = ReadScene(path);
      if (!read) return read.error();
      LoadedView loaded{
          std::move(read.value().scene), read.value().files, read.value().warnings, {}};
      loaded.development.ev = loaded.scene.settings.ev.value_or(0);
      return loaded;
    };
    setup_.print = [this](const std::string& line) {
      const std::lock_guard lock(mutex_);
      printed_ += line + "\n";
    };
    setup_.is_interrupted = [] { return false; };
    Result<LoadedView> first = setup_.load();
    REQUIRE(first);
    viewer_ = std::make_unique<Viewer>(setup_, std::move(first).value());
    viewer_->Start([] {});
  }
  ~Hand() { viewer_->Stop(); }

  const Viewer& viewer() const { return *viewer_; }
  WindowFrame frame;
  WindowInput input;  // of the next turn

  void Turn() {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    input.seconds = seconds_ += 0.016;
    if (input.width == 0) {
      input.width = kWidth;
      input.height = kHeight;
    }
    viewer_->Turn(input, &frame);
    const int width = input.width, height = input.height;
    input = {};
    input.width = width;
    input.height = height;
  }
  void Press(int key) {
    input.pressed = {key};
    Turn();
  }

  // Turns until it holds, or half a minute is over.
  template <typename Condition>
  bool Until(Condition condition) {
    for (int i = 0; i < 3000; ++i) {
      Turn();
      if (condition()) return true;
    }
    return false;
  }
  // Until nothing finer will come, of what was asked for last.
  bool UntilFinished() {
    for (int i = 0; i < 12; ++i) Turn();  // the render thread has seen the last request by then
    return Until([&] {
      const auto picture = viewer_->picture();
      return picture && picture->is_finished && picture->width == input.width;
    });
  }

  std::string printed() {
    const std::lock_guard lock(mutex_);
    return printed_;
  }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  Folder folder_;
  ViewerSetup setup_;
  std::mutex mutex_;
  std::string printed_;
  double seconds_ = 0;
  std::unique_ptr<Viewer> viewer_;
};

Scene CrystalBall() {
  Result<ReadSceneResult> read = ReadScene(kScene);
  REQUIRE(read);
  return std::move(read.value().scene);
}

Film Rendered(const Scene& scene, const Camera& camera, RenderOptions options) {
  options.width = kWidth;
  options.height = kHeight;
  const Result<Film> film = Render(scene, camera, options);
  REQUIRE(film);
  return film.value();
}

RenderOptions WithSamples(int samples) {
  RenderOptions options;
  options.samples = samples;
  return options;
}

std::vector<std::uint8_t> BytesOf(const Film& film) {
  return QuantizeTo8Bit(film, Transfer::kLinear);  // as the scene's settings have it
}

TEST_CASE("a picture at rest has the bits of the renderer, from wherever a hand moves the camera") {
  Hand hand(kScene);
  const Scene scene = CrystalBall();
  REQUIRE(hand.UntilFinished());
  CHECK(hand.viewer().picture()->rgb == BytesOf(Rendered(scene, scene.cameras[0], WithSamples(4))));

  hand.input.drag_x[static_cast<int>(Drag::kOrbit)] = 60;
  hand.input.drag_y[static_cast<int>(Drag::kOrbit)] = -20;
  hand.Turn();
  for (int i = 0; i < 5; ++i) {
    hand.input.held = "WD";
    hand.Turn();
  }
  hand.input.drag_x[static_cast<int>(Drag::kLook)] = 9;
  hand.input.drag_y[static_cast<int>(Drag::kPan)] = 3;
  hand.input.wheel = 2;
  hand.Turn();
  const Camera camera = hand.viewer().camera();
  CHECK(camera.eye != scene.cameras[0].eye);
  REQUIRE(hand.UntilFinished());
  const std::vector<std::uint8_t> expected = BytesOf(Rendered(scene, camera, WithSamples(4)));
  CHECK(expected != BytesOf(Rendered(scene, scene.cameras[0], WithSamples(4))));
  CHECK(hand.viewer().picture()->rgb == expected);
  CHECK(hand.frame.title == kScene + " - front, moved - 64x48, 4 samples");

  // Another size, another exposure without another frame, and back to the scene's camera.
  hand.input.width = kWidth / 2;
  REQUIRE(hand.UntilFinished());
  CHECK(hand.viewer().picture()->width == kWidth / 2);
  hand.input.width = kWidth;
  hand.Press('R');
  hand.Press('=');
  REQUIRE(hand.UntilFinished());
  Film brighter = Rendered(scene, scene.cameras[0], WithSamples(4));
  Develop(1.0 / 3, Tone::kLinear, brighter);
  CHECK(hand.viewer().picture()->rgb == BytesOf(brighter));
}

TEST_CASE("each layer that a key shows is that of the renderer") {
  Hand hand(kScene, 1);
  const Scene scene = CrystalBall();
  const Camera& camera = scene.cameras[0];
  const Layer layers[] = {Layer::kDepth, Layer::kNormal, Layer::kAlbedo, Layer::kId};
  for (int i = 0; i < 4; ++i) {
    hand.Press(kKeyF1 + 1 + i);
    REQUIRE(hand.UntilFinished());
    RenderOptions options = WithSamples(1);
    options.layers.Add(layers[i]);
    const Film film = ShowLayer(Rendered(scene, camera, options), layers[i], LayerLook::kDisplay,
                                FarthestDepth(scene, camera));
    CHECK(hand.viewer().picture()->rgb == BytesOf(film));
  }
  for (const int key : {kKeyF1 + 5, kKeyF1 + 6}) {  // heat and lanes are measured
    hand.Press(key);
    REQUIRE(hand.UntilFinished());
    const std::vector<std::uint8_t>& rgb = hand.viewer().picture()->rgb;
    CHECK(rgb[1] > 0);
    // A tile has one value: its middle is its corner.
    CHECK(std::equal(&rgb[0], &rgb[3], &rgb[3 * (16 * kWidth + 16)]));
  }
}

TEST_CASE("targets and precisions change live, and two targets stand beside each other") {
  Hand hand(kScene);
  const Scene scene = CrystalBall();
  const auto expected = BytesOf(Rendered(scene, scene.cameras[0], WithSamples(4)));
  hand.Press('G');
  REQUIRE(hand.UntilFinished());
  REQUIRE(hand.viewer().picture()->sides.size() == 2);
  CHECK(hand.viewer().picture()->sides[0].target == UsableTargets().front());
  CHECK(hand.viewer().picture()->sides[1].target == "scalar");
  CHECK(hand.viewer().picture()->rgb == expected);
  hand.Press('G');
  for (std::size_t i = 0; i < UsableTargets().size(); ++i) {
    hand.Press('T');
    REQUIRE(hand.UntilFinished());
    REQUIRE(hand.viewer().picture()->sides.size() == 1);
    const std::string name = i + 1 < UsableTargets().size() ? UsableTargets()[i + 1] : "scalar";
    CHECK(hand.viewer().picture()->sides[0].target == name);
    CHECK(hand.viewer().picture()->rgb == expected);
  }
  hand.frame.controls->precision = static_cast<int>(Precision::kDouble);
  REQUIRE(hand.UntilFinished());
  RenderOptions options = WithSamples(4);
  options.precision = Precision::kDouble;
  CHECK(hand.viewer().picture()->rgb == BytesOf(Rendered(scene, scene.cameras[0], options)));
}

TEST_CASE("the integrator is the scene's, and changes live") {
  const std::string path = SHEAF_SOURCE_DIR "/scenes/soft-light.json";
  Hand hand(path);
  const Result<ReadSceneResult> read = ReadScene(path);
  REQUIRE(read.ok());
  const Scene& scene = read.value().scene;
  hand.Turn();
  CHECK(hand.frame.lists->integrators ==
        std::vector<std::string>{"whitted", "distributed", "path"});
  for (const Integrator integrator :
       {scene.settings.integrator, Integrator::kPath, Integrator::kWhitted}) {
    if (integrator != scene.settings.integrator) {
      hand.frame.controls->integrator = static_cast<int>(integrator);
    }
    REQUIRE(hand.UntilFinished());
    RenderOptions options = WithSamples(4);
    options.integrator = integrator;
    const Film film = Rendered(scene, scene.cameras[0], options);
    CHECK(hand.viewer().picture()->rgb == QuantizeTo8Bit(film, scene.settings.transfer));
  }
}

TEST_CASE("cameras and views go by name") {
  Hand hand(kScene, 1);
  hand.Turn();
  const ViewLists& lists = *hand.frame.lists;
  REQUIRE(lists.cameras.size() == 7);
  CHECK(lists.views ==
        std::vector<std::string>{"all cameras", "seven", "sides", "heights", "distances"});
  CHECK(hand.viewer().camera().name == "front");
  hand.Press('N');
  CHECK(hand.viewer().camera().name == lists.cameras[1]);
  hand.Press('B');
  hand.Press('B');
  CHECK(hand.viewer().camera().name == lists.cameras[6]);
  // Within "sides" there are two.
  hand.Press('V');
  hand.Press('V');
  CHECK(hand.viewer().camera().name == "left");
  hand.Press('N');
  CHECK(hand.viewer().camera().name == "right");
  hand.Press('N');
  CHECK(hand.viewer().camera().name == "left");
  hand.frame.controls->camera = 0;
  hand.Turn();
  CHECK(hand.viewer().camera().name == "front");
}

TEST_CASE("a pick names the object, and its ray hits where it says") {
  const Scene scene = CrystalBall();
  ViewRequest request;
  request.scene = std::make_shared<const Scene>(scene);
  request.camera = scene.cameras[0];
  request.goal = {kWidth, kHeight, 16};
  int hits = 0;
  for (int y = 1; y < kHeight; y += 9) {
    for (int x = 2; x < kWidth; x += 9) {
      const Result<Pick> pick = PickPixel(request, x, y);
      REQUIRE(pick);
      const auto object = ObjectAt(scene, request.camera, kWidth, kHeight, x, y);
      CHECK(pick.value().object.has_value() == object.has_value());
      CHECK(pick.value().rays.primary == 1);
      CHECK(stress::ParseRay(pick.value().ray));
      if (!object) continue;
      ++hits;
      CHECK(*pick.value().object == *object);
      CHECK(pick.value().object_name == scene.objects[*object].name);
      const auto* ball = std::get_if<Sphere>(&scene.objects[*object].shape);
      const Vec3d& point = pick.value().point;
      if (ball != nullptr) {
        CHECK(glm::length(point - ball->center) == doctest::Approx(ball->radius).epsilon(1e-5));
      } else {
        CHECK(point.y == doctest::Approx(-3).epsilon(1e-5));
        CHECK(pick.value().normal == Vec3d(0, 1, 0));
      }
    }
  }
  CHECK(hits > 10);

  Hand hand(kScene);
  REQUIRE(hand.UntilFinished());
  hand.input.is_clicked = true;
  hand.input.click_x = 52;
  hand.input.click_y = 34;
  hand.Turn();
  REQUIRE(hand.Until([&] { return !hand.frame.pick.empty(); }));
  CHECK(hand.frame.pick[1] == "object 2 \"floor\", material \"tiles\"");
  CHECK(Contains(hand.printed(), "normal (0, 1, 0)\n"));
  CHECK(Contains(hand.printed(), "ray "));
}

TEST_CASE("a scene that changes on disk is read anew; a bad one leaves the old picture") {
  const Folder folder;
  const std::string text = ReadText(kScene);
  const std::string path = folder.Write("scene.json", text);
  Hand hand(path);
  REQUIRE(hand.UntilFinished());
  const auto before = hand.viewer().picture()->rgb;

  folder.Write("scene.json", "{ \"objects\": 1 }");
  REQUIRE(hand.Until([&] { return !hand.frame.error.empty(); }));
  CHECK(Contains(hand.frame.error, path + ":1"));
  CHECK(hand.viewer().picture()->rgb == before);

  // A smaller ball; the camera that a hand has moved stays.
  hand.input.drag_x[static_cast<int>(Drag::kOrbit)] = 8;
  hand.Turn();
  const Camera moved = hand.viewer().camera();
  std::string smaller = text;
  const std::string radius = "\"radius\": 1.5";
  REQUIRE(smaller.find(radius) != std::string::npos);
  smaller.replace(smaller.find(radius), radius.size(), "\"radius\": 1.1");
  folder.Write("scene.json", smaller);
  REQUIRE(hand.Until([&] { return hand.frame.error.empty(); }));
  CHECK(Contains(hand.frame.message, "read anew: "));
  CHECK(hand.viewer().camera().eye == moved.eye);
  REQUIRE(hand.UntilFinished());
  const Result<ReadSceneResult> read = ReadScene(path);
  REQUIRE(read);
  CHECK(hand.viewer().picture()->rgb ==
        BytesOf(Rendered(read.value().scene, moved, WithSamples(4))));
}

TEST_CASE("pictures and cameras are saved beside what was saved before") {
  Hand hand(kScene);
  hand.input.drag_x[static_cast<int>(Drag::kOrbit)] = 31;
  hand.Turn();
  REQUIRE(hand.UntilFinished());
  hand.Press('P');
  hand.Press('K');
  REQUIRE(hand.Until([&] { return Contains(hand.printed(), "png"); }));
  hand.Press('K');
  CHECK(Contains(hand.printed(), hand / "saved-2.json"));

  // The numbers of the camera come back to the bit.
  const std::string saved = ReadText(hand / "saved-1.json");
  const std::string whole = "{\"objects\": [], \"materials\": [], " + saved.substr(saved.find('"'));
  const Result<Scene> scene = ParseSceneJson(whole, "saved");
  REQUIRE_MESSAGE(scene.ok(), (scene.ok() ? "" : scene.error().message));
  const Camera& camera = scene.value().cameras.front();
  CHECK(camera.name == "view 1");
  CHECK(camera.eye == hand.viewer().camera().eye);
  CHECK(camera.look_at == hand.viewer().camera().look_at);
  CHECK(camera.up == hand.viewer().camera().up);

  const Result<ReadPictureResult> picture = ReadPicture(hand / "saved-1.png");
  REQUIRE(picture);
  const Film film = Rendered(CrystalBall(), camera, WithSamples(4));
  CHECK(QuantizeTo8Bit(picture.value().film, Transfer::kLinear) == BytesOf(film));
}

}  // namespace
}  // namespace sheaf
