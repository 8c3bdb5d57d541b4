// Between the view, which knows nothing of windows, and the module that has one.
//
// The module is a library of its own, libsheaf_window.so, which the command loads when a window is
// asked for: it brings GLFW, OpenGL and the X libraries, which no other command needs. The two are
// built together, so that they share types.
#ifndef SHEAF_VIEW_WINDOW_H_
#define SHEAF_VIEW_WINDOW_H_

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace sheaf {

// Mouse buttons with their meaning to a camera.
enum class Drag { kOrbit, kLook, kPan, kCount };  // the left, right and middle button
inline constexpr int kDragCount = static_cast<int>(Drag::kCount);

// What happened since the turn before. Lengths are pixels of the picture, from its top left.
struct WindowInput {
  double seconds = 0;         // of a clock that goes on
  int width = 0, height = 0;  // of the window's picture; 0 while it is minimised
  std::vector<int> pressed;   // keys of src/view/keys.h, in order
  std::string held;           // letters whose keys are down, upper case
  bool is_fast = false;       // shift is down
  double drag_x[kDragCount] = {}, drag_y[kDragCount] = {};
  double wheel = 0;         // notches away from the user
  bool is_clicked = false;  // the left button went down and up in one place
  int click_x = 0, click_y = 0;
};

// What the panel shows as sliders and lists, and changes.
struct ViewControls {
  int camera = 0, view = 0, shown = 0, precision = 0, target = 0;
  int integrator = 0;
  int beside = 0;  // 0: nothing, else one more than a target
  int samples = 1, max_depth = 5;
  double contrast = 0;  // 0: not adaptive
  double ev = 0;
  int tone = 0;
  bool operator==(const ViewControls&) const = default;
};

// What the lists hold.
struct ViewLists {
  std::vector<std::string> cameras, views, shown, integrators, precisions, targets, besides, tones;
};

// What a turn leaves for the window. Pointers stay good until the next turn.
struct WindowFrame {
  std::string title;
  const std::uint8_t* rgb = nullptr;  // null: no picture yet; rows from the top
  int picture_width = 0, picture_height = 0;
  std::uint64_t picture_number = 0;  // another one is another picture
  bool is_panel_shown = true;
  ViewControls* controls = nullptr;
  const ViewLists* lists = nullptr;
  std::vector<std::string> status, pick, help;
  std::string message, error;  // one line each; empty: none
  bool is_moving = false;      // the next turn shall come soon
  bool closes = false;
};

class WindowClient {
 public:
  virtual ~WindowClient() = default;
  // `wake`, from any thread, brings the next turn at once. Called once, before the first turn.
  virtual void Start(const std::function<void()>& wake) = 0;
  // `wake` is not called any more once it has returned. Called once, after the last turn.
  virtual void Stop() = 0;
  // One turn: some 60 a second while something moves, else 4. Does not block.
  virtual void Turn(const WindowInput& input, WindowFrame* frame) = 0;
};

// Opens a window with a picture of about so many pixels, and takes turns until it is closed. False,
// with one line in `error`, where there can be none.
using RunWindow = bool(WindowClient& client, int width, int height, std::string& error);
inline constexpr const char* kWindowModule = "libsheaf_window.so";
inline constexpr const char* kRunWindow = "SheafRunWindow";

}  // namespace sheaf

#endif  // SHEAF_VIEW_WINDOW_H_
