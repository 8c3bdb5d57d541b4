// src/view/window.h by GLFW and OpenGL; compiled into a library of its own.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "src/view/draw_panel.h"
#include "src/view/window.h"

namespace sheaf {
namespace {

constexpr double kTurnSeconds = 1 / 60.0, kIdleSeconds = 0.25;
// A press that moves farther is a drag and picks nothing.
constexpr double kClickPixels = 3;

// What callbacks collect until the next turn.
struct Collected {
  WindowInput input;
  bool has_event = true;  // so that the window is drawn once at first
  bool is_pressed[kDragCount] = {};
  double press_x = 0, press_y = 0, last_x = 0, last_y = 0;
  bool is_dragging = false;
};

Collected& Of(GLFWwindow* window) {
  return *static_cast<Collected*>(glfwGetWindowUserPointer(window));
}

// Pixels of the picture a unit of the cursor.
double PixelsAUnit(GLFWwindow* window) {
  int width = 1, height = 1, pixels_x = 1, pixels_y = 1;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixels_x, &pixels_y);
  return width > 0 ? static_cast<double>(pixels_x) / width : 1;
}

void OnKey(GLFWwindow* window, int key, int, int action, int) {
  Collected& collected = Of(window);
  collected.has_event = true;
  if (action != GLFW_PRESS || ImGui::GetIO().WantTextInput) return;
  collected.input.pressed.push_back(key);
}

void OnButton(GLFWwindow* window, int button, int action, int) {
  Collected& collected = Of(window);
  collected.has_event = true;
  if (button < 0 || button >= kDragCount) return;
  if (action == GLFW_PRESS) {
    if (ImGui::GetIO().WantCaptureMouse) return;
    collected.is_pressed[button] = true;
    collected.is_dragging = false;
    glfwGetCursorPos(window, &collected.press_x, &collected.press_y);
    collected.last_x = collected.press_x;
    collected.last_y = collected.press_y;
    return;
  }
  if (!std::exchange(collected.is_pressed[button], false)) return;
  if (button != static_cast<int>(Drag::kOrbit) || collected.is_dragging) return;
  const double scale = PixelsAUnit(window);
  collected.input.is_clicked = true;
  collected.input.click_x = static_cast<int>(std::floor(collected.press_x * scale));
  collected.input.click_y = static_cast<int>(std::floor(collected.press_y * scale));
}

void OnCursor(GLFWwindow* window, double x, double y) {
  Collected& collected = Of(window);
  collected.has_event = true;
  if (std::hypot(x - collected.press_x, y - collected.press_y) > kClickPixels) {
    collected.is_dragging = true;
  }
  if (!collected.is_dragging) return;
  const double scale = PixelsAUnit(window);
  for (int button = 0; button < kDragCount; ++button) {
    if (!collected.is_pressed[button]) continue;
    collected.input.drag_x[button] += (x - collected.last_x) * scale;
    collected.input.drag_y[button] += (y - collected.last_y) * scale;
  }
  collected.last_x = x;
  collected.last_y = y;
}

void OnWheel(GLFWwindow* window, double, double notches) {
  Collected& collected = Of(window);
  collected.has_event = true;
  if (!ImGui::GetIO().WantCaptureMouse) collected.input.wheel += notches;
}

void OnChange(GLFWwindow* window) { Of(window).has_event = true; }
void OnSize(GLFWwindow* window, int, int) { OnChange(window); }

// The picture, drawn behind everything else over the whole window.
class PictureTexture {
 public:
  PictureTexture() {
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  PictureTexture(const PictureTexture&) = delete;
  PictureTexture& operator=(const PictureTexture&) = delete;
  ~PictureTexture() { glDeleteTextures(1, &texture_); }

  // Whether it is another picture than before.
  bool Update(const WindowFrame& frame) {
    if (frame.rgb == nullptr || frame.picture_number == number_) return false;
    number_ = frame.picture_number;
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (width_ == frame.picture_width && height_ == frame.picture_height) {
      glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, frame.rgb);
      return true;
    }
    width_ = frame.picture_width;
    height_ = frame.picture_height;
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width_, height_, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 frame.rgb);
    return true;
  }

  // Pixel for pixel where the sizes are one, so that no bit changes.
  void Draw(int pixels_x, int pixels_y) const {
    if (width_ == 0) return;
    const bool is_exact = width_ == pixels_x && height_ == pixels_y;
    glBindTexture(GL_TEXTURE_2D, texture_);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
      glTexParameteri(GL_TEXTURE_2D, filter, is_exact ? GL_NEAREST : GL_LINEAR);
    }
    ImGui::GetBackgroundDrawList()->AddImage(
        reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)), ImVec2(0, 0),
        ImGui::GetIO().DisplaySize);
  }

 private:
  GLuint texture_ = 0;
  int width_ = 0, height_ = 0;
  std::uint64_t number_ = 0;
};

// GLFW's last complaint.
std::string Complaint(const std::string& otherwise) {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : otherwise;
}

// At most nine tenths of the screen, in the picture's proportions.
void FitScreen(int& width, int& height) {
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  if (monitor == nullptr) return;
  int x = 0, y = 0, most_x = 0, most_y = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &most_x, &most_y);
  if (most_x <= 0 || most_y <= 0) return;
  const double scale = std::min({1.0, 1.0 * most_x / width, 1.0 * most_y / height});
  width = std::max(1, static_cast<int>(width * scale));
  height = std::max(1, static_cast<int>(height * scale));
}

void SetCallbacks(GLFWwindow* window, Collected& collected) {
  glfwSetWindowUserPointer(window, &collected);
  glfwSetKeyCallback(window, &OnKey);
  glfwSetMouseButtonCallback(window, &OnButton);
  glfwSetCursorPosCallback(window, &OnCursor);
  glfwSetScrollCallback(window, &OnWheel);
  glfwSetFramebufferSizeCallback(window, &OnSize);
  glfwSetWindowRefreshCallback(window, &OnChange);
}

// Takes what was collected, and leaves an empty input.
WindowInput TakeInput(GLFWwindow* window, Collected& collected, PanelKeys& keys) {
  WindowInput input = std::exchange(collected.input, {});
  input.seconds = glfwGetTime();
  glfwGetFramebufferSize(window, &input.width, &input.height);
  input.pressed.insert(input.pressed.end(), keys.begin(), keys.end());
  keys.clear();
  if (ImGui::GetIO().WantTextInput) return input;
  input.is_fast = glfwGetKey(window, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ||
                  glfwGetKey(window, GLFW_KEY_RIGHT_SHIFT) == GLFW_PRESS;
  for (char letter = 'A'; letter <= 'Z'; ++letter) {
    if (glfwGetKey(window, letter) == GLFW_PRESS) input.held += letter;
  }
  return input;
}

void Draw(GLFWwindow* window, const PictureTexture& texture, WindowFrame& frame, PanelKeys& keys) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  int width = 0, height = 0;
  glfwGetFramebufferSize(window, &width, &height);
  texture.Draw(width, height);
  DrawPanel(frame, keys);
  ImGui::Render();
  glViewport(0, 0, width, height);
  glClearColor(0, 0, 0, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  glfwSwapBuffers(window);
}

// Whether what is written in the window differs.
bool IsOtherText(const WindowFrame& a, const WindowFrame& b) {
  return a.status != b.status || a.pick != b.pick || a.message != b.message || a.error != b.error ||
         a.is_panel_shown != b.is_panel_shown;
}

void TakeTurns(GLFWwindow* window, WindowClient& client) {
  Collected collected;
  SetCallbacks(window, collected);
  ImGui_ImplGlfw_InitForOpenGL(window, true);  // chains to the callbacks above
  ImGui_ImplOpenGL3_Init();
  PictureTexture texture;
  PanelKeys keys;
  WindowFrame frame, drawn;
  std::string title;
  int settling = 0;  // a list or a slider needs a few frames after the last event
  while (!glfwWindowShouldClose(window) && !frame.closes) {
    const bool is_soon = frame.is_moving || settling > 0;
    glfwWaitEventsTimeout(is_soon ? kTurnSeconds : kIdleSeconds);
    client.Turn(TakeInput(window, collected, keys), &frame);
    if (frame.title != title) glfwSetWindowTitle(window, frame.title.c_str());
    title = frame.title;
    const bool is_new = texture.Update(frame);
    if (std::exchange(collected.has_event, false)) settling = 3;
    if (!is_new && settling == 0 && !IsOtherText(frame, drawn)) continue;
    settling = std::max(0, settling - 1);
    drawn = frame;
    Draw(window, texture, frame, keys);
  }
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
}

bool OpenAndTakeTurns(WindowClient& client, int width, int height, std::string& error) {
  FitScreen(width, height);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  GLFWwindow* const window = glfwCreateWindow(width, height, "sheaf view", nullptr, nullptr);
  if (window == nullptr) {
    error = Complaint("no window with OpenGL 3.2 can be opened");
    return false;
  }
  glfwMakeContextCurrent(window);
  glfwSwapInterval(1);
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;  // leaves no file behind
  client.Start([] { glfwPostEmptyEvent(); });
  TakeTurns(window, client);
  client.Stop();
  ImGui::DestroyContext();
  glfwDestroyWindow(window);
  return true;
}

}  // namespace
}  // namespace sheaf

extern "C" __attribute__((visibility("default"))) bool SheafRunWindow(sheaf::WindowClient& client,
                                                                      int width, int height,
                                                                      std::string& error) {
  if (glfwInit() == GLFW_FALSE) {
    error = sheaf::Complaint("no display");
    return false;
  }
  const bool opened = sheaf::OpenAndTakeTurns(client, width, height, error);
  glfwTerminate();
  return opened;
}
