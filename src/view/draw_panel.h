// The panel of the window, by Dear ImGui; of the module alone.
#ifndef SHEAF_VIEW_DRAW_PANEL_H_
#define SHEAF_VIEW_DRAW_PANEL_H_

#include <vector>

#include "src/view/window.h"

namespace sheaf {

// Keys that the panel's buttons stand for.
using PanelKeys = std::vector<int>;

// Draws it within a frame of ImGui, lets it change frame.controls, and adds to `keys`.
void DrawPanel(WindowFrame& frame, PanelKeys& keys);

}  // namespace sheaf

#endif  // SHEAF_VIEW_DRAW_PANEL_H_
