// What every consumer does with Sheaf: renders a ball that shines, by the public headers alone.
#ifndef SHEAF_TESTS_CONSUMERS_RENDER_BALL_H_
#define SHEAF_TESTS_CONSUMERS_RENDER_BALL_H_

#include <sheaf/sheaf.h>

#include <cstdio>
#include <cstring>

#include "core/error.h"
#include "src/core/error.h"

// 0 where the picture is as expected and the library is that of the headers.
inline int RenderBall() {
  if (std::strcmp(sheaf::LibraryVersion(), sheaf::kVersion) != 0) return kOwnError;
  sheaf::Scene scene;
  scene.materials.push_back({.name = "shining", .emission = sheaf::Colour(0.5)});
  scene.objects.push_back({.name = "ball", .shape = sheaf::Sphere{{0, 0, -5}, 1}});
  sheaf::RenderOptions options;
  options.width = options.height = 33;
  const auto film = sheaf::Render(scene, sheaf::Camera(), options);
  if (!film) {
    std::fprintf(stderr, "%s\n", film.error().message.c_str());
    return kOwnSourceError;
  }
  const bool is_right = film.value().pixel(16, 16)[0] == 0.5f && film.value().pixel(0, 0)[0] == 0;
  std::printf("Sheaf %s on %s: %s\n", sheaf::LibraryVersion(), options.target.name().c_str(),
              is_right ? "a ball" : "no ball");
  return is_right ? 0 : 1;
}

#endif  // SHEAF_TESTS_CONSUMERS_RENDER_BALL_H_
