// src/view/draw_panel.h; compiled into the module of the window.
#include <imgui.h>

#include <algorithm>

#include "src/view/draw_panel.h"

namespace sheaf {
namespace {

const ImVec4 kRed(1.0f, 0.45f, 0.4f, 1.0f);
constexpr float kPanelWidth = 330;

void List(const char* label, const std::vector<std::string>& names, int* chosen) {
  const auto size = static_cast<int>(names.size());
  const char* const shown = *chosen >= 0 && *chosen < size ? names[*chosen].c_str() : "";
  if (!ImGui::BeginCombo(label, shown)) return;
  for (int i = 0; i < size; ++i) {
    if (ImGui::Selectable(names[i].c_str(), i == *chosen)) *chosen = i;
  }
  ImGui::EndCombo();
}

void Slider(const char* label, double* value, double least, double most, const char* format) {
  ImGui::SliderScalar(label, ImGuiDataType_Double, value, &least, &most, format);
}

void DrawControls(ViewControls& controls, const ViewLists& lists) {
  List("camera", lists.cameras, &controls.camera);
  List("view", lists.views, &controls.view);
  List("show", lists.shown, &controls.shown);
  List("target", lists.targets, &controls.target);
  List("beside", lists.besides, &controls.beside);
  List("integrator", lists.integrators, &controls.integrator);
  List("precision", lists.precisions, &controls.precision);
  ImGui::SliderInt("samples", &controls.samples, 1, 1024, "%d", ImGuiSliderFlags_Logarithmic);
  Slider("adaptive", &controls.contrast, 0, 0.25, controls.contrast > 0 ? "%.3f" : "off");
  ImGui::SliderInt("max depth", &controls.max_depth, 0, 30);
  Slider("exposure", &controls.ev, -8, 8, "%.2f stops");
  List("tone", lists.tones, &controls.tone);
}

void DrawButtons(PanelKeys& keys) {
  const auto button = [&keys](const char* label, int key) {
    if (ImGui::Button(label)) keys.push_back(key);
  };
  button("save picture", 'P');
  ImGui::SameLine();
  button("save camera", 'K');
  ImGui::SameLine();
  button("reset", 'R');
  ImGui::SameLine();
  button("meter", 'M');
}

void DrawLines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) ImGui::TextUnformatted(line.c_str());
}

void DrawWrapped(const std::string& line) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(line.c_str());
  ImGui::PopTextWrapPos();
}

void DrawPick(const std::vector<std::string>& pick) {
  ImGui::Separator();
  for (const std::string& line : pick) DrawWrapped(line);
  if (!ImGui::Button("copy")) return;
  std::string text;
  for (const std::string& line : pick) text += line + '\n';
  ImGui::SetClipboardText(text.c_str());
}

}  // namespace

void DrawPanel(WindowFrame& frame, PanelKeys& keys) {
  // An error is seen without the panel too.
  if (!frame.is_panel_shown && frame.error.empty()) return;
  ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(kPanelWidth, 0), ImGuiCond_Always);
  ImGui::SetNextWindowBgAlpha(0.75f);
  const auto flags = ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav;
  ImGui::Begin(frame.is_panel_shown ? "sheaf view" : "error", nullptr, flags);
  if (!frame.error.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, kRed);
    DrawWrapped(frame.error);
    ImGui::PopStyleColor();
  }
  if (frame.is_panel_shown) {
    DrawLines(frame.status);
    ImGui::Separator();
    ImGui::PushItemWidth(-80);
    DrawControls(*frame.controls, *frame.lists);
    ImGui::PopItemWidth();
    DrawButtons(keys);
    if (!frame.message.empty()) DrawWrapped(frame.message);
    if (!frame.pick.empty()) DrawPick(frame.pick);
    if (ImGui::CollapsingHeader("keys")) DrawLines(frame.help);
  }
  ImGui::End();
}

}  // namespace sheaf
