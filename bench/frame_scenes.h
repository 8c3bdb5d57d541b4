// The scenes that whole frames are timed on, made by the project itself.
#ifndef SHEAF_BENCH_FRAME_SCENES_H_
#define SHEAF_BENCH_FRAME_SCENES_H_

#include <span>

#include "sheaf/scene.h"

namespace sheaf::bench {

struct FrameScene {
  const char* name;
  const char* what;
  Scene (*make)();  // its settings have the size, its first camera is the one
};

// balls, tetra and mount after Haines, "A Proposal for Standard Graphics Environments" (IEEE CG&A
// 1987): his views, lights and surfaces; the mountain is another one. Lights do not fall off and
// share one unit of intensity as he asks: 1 / sqrt(number of lights).
std::span<const FrameScene> FrameScenes();

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_FRAME_SCENES_H_
