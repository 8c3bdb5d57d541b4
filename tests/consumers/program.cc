#include "render_ball.h"

int main() { return RenderBall(); }
