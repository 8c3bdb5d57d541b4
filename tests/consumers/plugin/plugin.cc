// Sheaf inside a shared object that a program loads.
#include "../render_ball.h"

extern "C" int RunPlugin() { return RenderBall(); }
