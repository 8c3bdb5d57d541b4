// `sheaf view` as a user has it: a real window on a virtual X server, moved by real input, whose
// pixels are read back from the server's screen.
#include <doctest/doctest.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "folder.h"
#include "sheaf/formats.h"
#include "src/core/build_info.h"
#include "src/formats/quantize.h"
#include "src/lab/has_program.h"
#include "src/lab/stress.h"
#include "tests/run_command.h"

namespace sheaf {
namespace {

bool HasWindow() {
  for (const OptionalPart& part : OptionalParts()) {
    if (std::string_view(part.name) == "window") return part.is_built_in;
  }
  FAIL("no part of that name");
  return false;
}

void Sleep(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// An X server without a screen, which keeps its pixels in a file.
class VirtualScreen {
 public:
  VirtualScreen() {
    server_ = fork();
    if (server_ == 0) {
      const int out = open((folder_ / "display").c_str(), O_WRONLY | O_CREAT, 0644);
      const int err = open((folder_ / "errors").c_str(), O_WRONLY | O_CREAT, 0644);
      dup2(out, 1);
      dup2(err, 2);
      const std::string folder = folder_ / "";
      execlp("Xvfb", "Xvfb", "-displayfd", "1", "-screen", "0", "900x700x24", "-nocursor", "-fbdir",
             folder.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    for (int i = 0; i < 600 && !Contains(ReadText(folder_ / "display"), "\n"); ++i) Sleep(50);
    std::string number = ReadText(folder_ / "display");
    REQUIRE_MESSAGE(Contains(number, "\n"), ReadText(folder_ / "errors"));
    number.pop_back();
    setenv("DISPLAY", (":" + number).c_str(), 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    // What drivers and the X libraries keep until the end is not ours. Some of it has no name,
    // because they are unloaded by then, so that leaks do not decide the exit code: see IsClean.
    setenv("LSAN_OPTIONS", "exitcode=0:suppressions=" SHEAF_SOURCE_DIR "/tests/window_leaks.supp",
           0);
  }
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;
  ~VirtualScreen() {
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
    unsetenv("DISPLAY");
  }

  // What xdotool prints of these words.
  std::string Do(const std::string& words) const {
    const std::string out = folder_ / "answer";
    const int code = std::system(("xdotool " + words + " >" + out + " 2>/dev/null").c_str());
    return code == 0 ? ReadText(out) : "";
  }

  // The top left pixels: red, green and blue in turn. The file is an X window dump.
  std::vector<std::uint8_t> Pixels(int width, int height) const {
    const std::string dump = ReadText(folder_ / "Xvfb_screen0");
    const auto number = [&](std::size_t i) {
      std::size_t value = 0;
      for (std::size_t b = 0; b < 4; ++b) {
        value = value << 8 | static_cast<std::uint8_t>(dump[4 * i + b]);
      }
      return value;
    };
    REQUIRE(dump.size() > 100);
    REQUIRE(number(11) == 32);  // bits a pixel
    REQUIRE(number(7) == 0);    // the lowest byte first
    const std::size_t first = number(0) + 12 * number(19), row = number(12);
    std::vector<std::uint8_t> rgb;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        for (const std::size_t byte : {2, 1, 0}) {
          rgb.push_back(static_cast<std::uint8_t>(dump.at(first + y * row + 4 * x + byte)));
        }
      }
    }
    return rgb;
  }

 private:
  Folder folder_;
  pid_t server_ = 0;
};

// The window of a running `sheaf view`, by its title.
class Window {
 public:
  explicit Window(const VirtualScreen& screen) : screen_(screen) {
    for (int i = 0; i < 600 && id_.empty(); ++i) {
      Sleep(100);
      id_ = screen.Do("search --name crystal-ball");
    }
    REQUIRE(!id_.empty());
    id_ = id_.substr(0, id_.find('\n'));
    screen.Do("windowfocus " + id_);
  }

  const std::string& id() const { return id_; }
  std::string Title() const { return screen_.Do("getwindowname " + id_); }

  // Until the title ends so: it says when a picture is finished.
  bool Shows(const std::string& end) const {
    for (int i = 0; i < 1200; ++i) {
      if (Title().ends_with(end + "\n")) return true;
      Sleep(50);
    }
    MESSAGE(Title());
    return false;
  }

  // The screen has what the title says a moment later.
  bool ShowsPixels(const std::vector<std::uint8_t>& rgb, int width, int height) const {
    for (int i = 0; i < 100; ++i) {
      if (screen_.Pixels(width, height) == rgb) return true;
      Sleep(50);
    }
    return false;
  }

 private:
  const VirtualScreen& screen_;
  std::string id_;
};

// The picture that `sheaf render` writes, as bytes.
std::vector<std::uint8_t> RenderedBytes(const Workspace& work,
                                        const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"render"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  for (const char* word : {"-q", "-o"}) words.push_back(word);
  words.push_back(work / "rendered.png");
  const Outcome outcome = work.Run(words);
  REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const Result<ReadPictureResult> picture = ReadPicture(work / "rendered.png");
  REQUIRE(picture);
  return QuantizeTo8Bit(picture.value().film, Transfer::kLinear);  // value / 255, back again
}

// Under a sanitizer: no leak and no error whose stack has a function of ours.
bool IsClean(const std::string& err) { return !Contains(err, "sheaf"); }

bool CanTest() {
  if (!HasWindow()) {
    MESSAGE("skipped: no window in this build");
    return false;
  }
  if (HasProgram("Xvfb") && HasProgram("xdotool")) return true;
  MESSAGE("skipped: no Xvfb or no xdotool");
  return false;
}

TEST_CASE("the window shows the bits of sheaf render, wherever real input moves the camera") {
  if (!CanTest()) return;
  const VirtualScreen screen;
  const Workspace work, render;
  const Process view =
      work.Start({"view", kScene, "--size", "320x240", "--spp", "2", "--save", work / "saved"});
  const Window window(screen);
  REQUIRE(window.Shows("front - 320x240, 2 samples"));
  screen.Do("mousemove 250 120 key h");  // the panel away
  CHECK(window.ShowsPixels(RenderedBytes(render, {kScene, "--size", "320x240", "--spp", "2"}), 320,
                           240));

  screen.Do("mousedown 1 mousemove --sync 230 130 mousemove --sync 190 140 mouseup 1");
  screen.Do("keydown d sleep 0.3 keyup d click 4");
  REQUIRE(window.Shows("front, moved - 320x240, 2 samples"));
  screen.Do("key k");
  const std::string saved = work / "saved-1.json";
  for (int i = 0; i < 200 && ReadText(saved).empty(); ++i) Sleep(50);
  // The scene with the saved camera instead of its own.
  std::string scene = ReadText(kScene);
  const std::size_t cameras = scene.find("\"cameras\""), views = scene.find("\"views\"");
  REQUIRE(cameras < views);
  const std::string camera = ReadText(saved);
  const std::size_t list = camera.find("\"cameras\"");
  REQUIRE(list != std::string::npos);
  scene = scene.substr(0, cameras) + camera.substr(list);
  WriteText(render / "moved.json", scene);
  CHECK(window.ShowsPixels(
      RenderedBytes(render, {render / "moved.json", "--size", "320x240", "--spp", "2"}), 320, 240));

  screen.Do("windowsize " + window.id() + " 401 303");
  REQUIRE(window.Shows("front, moved - 401x303, 2 samples"));
  CHECK(window.ShowsPixels(
      RenderedBytes(render, {render / "moved.json", "--size", "401x303", "--spp", "2"}), 401, 303));

  screen.Do("mousemove 200 280 click 1");
  for (int i = 0; i < 200 && !Contains(ReadText(work / "../out"), "ray "); ++i) Sleep(50);
  screen.Do("key Escape");
  const Outcome outcome = view.Wait();
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK_MESSAGE(IsClean(outcome.err), outcome.err);
  CHECK(Contains(outcome.out, "wrote " + saved + ", camera \"view 1\"\n"));
  CHECK(Contains(outcome.out, "\npixel 200, 280\n"));
  // The ray is one that the stress cases take.
  const std::size_t at = outcome.out.find("\nray ");
  REQUIRE(at != std::string::npos);
  const std::string ray = outcome.out.substr(at + 5, outcome.out.find('\n', at + 1) - at - 5);
  CHECK_MESSAGE(stress::ParseRay(ray), ray);
}

TEST_CASE("a window spins, says how many pictures came, and closes") {
  if (!CanTest()) return;
  const VirtualScreen screen;
  const Workspace work;
  const Outcome outcome = work.Run({"view", kScene, "--size", "160x120", "--spin", "1"});
  CHECK_MESSAGE(outcome.code == 0, outcome.err);
  CHECK(outcome.out.starts_with("in motion: "));
  CHECK(Contains(outcome.out, " a second, median "));
}

TEST_CASE("a signal closes the window") {
  if (!CanTest()) return;
  const VirtualScreen screen;
  const Workspace work;
  const Process view = work.Start({"view", kScene, "--size", "160x120", "--spp", "1"});
  REQUIRE(Window(screen).Shows("160x120, 1 sample"));
  view.Signal(SIGINT);
  CHECK(view.Wait().code == 130);
}

TEST_CASE("without a display or without the part one line says so") {
  const Workspace work;
  unsetenv("DISPLAY");
  const Outcome outcome = work.Run({"view", kScene});
  CHECK(outcome.out.empty());
  CHECK(LineCount(outcome.err) == 1);
  if (HasWindow()) {
    CHECK(outcome.code == 4);
    CHECK(outcome.err.starts_with("sheaf: view: no window: "));
  } else {
    CHECK(outcome.code == 2);
    CHECK(outcome.err.starts_with("sheaf: view: Sheaf was built without "));
  }
  // What can be said before a window is.
  CHECK(work.Run({"view", "absent.json"}).code == (HasWindow() ? 4 : 2));
  CHECK(work.Run({"view", kScene, "--target", "none"}).code == 2);
  CHECK(Contains(work.Run({"view", "--help"}).out, "left drag"));
}

}  // namespace
}  // namespace sheaf
