// Ray trees that outgrow their memory go on in parts, and keep their bits.
#include "src/render/held_rays.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "same_bits.h"
#include "scene_text.h"
#include "sheaf/render.h"
#include "targets.h"

namespace sheaf {
namespace {

// Rays of one kind whose origin_x tells which they are.
void Fill(const std::vector<std::uint32_t>& pixels, float first, RayQueue<float>& queue) {
  const auto count = static_cast<std::uint32_t>(pixels.size());
  queue.Reset(count);
  queue.MakeRoom(PathFieldsFor<float>(0));
  queue.StartParents();
  const RayOutput<float> rays = queue.next_rays();
  for (std::uint32_t i = 0; i < count; ++i) rays.origin_x[i] = first + static_cast<float>(i);
  const PathOutput<float> paths = queue.next_paths();
  for (std::uint32_t i = 0; i < count; ++i) paths.pixel[i] = pixels[i];
  queue.Append(count);
}

std::vector<float> Names(const RayQueue<float>& queue) {
  const RayBatch<float> batch = queue.batch(0, queue.count());
  return {batch.rays.origin_x, batch.rays.origin_x + batch.count};
}

TEST_CASE("rays are divided by pixel, in their order, and come back") {
  RayQueue<float> queues[kChildKinds];
  Fill({7, 0, 3, 3, 0, 6, 1}, 10, queues[0]);
  Fill({2, 2, 0}, 20, queues[1]);
  HeldRays<float> held;
  held.Start(8);
  // Of pixels 0 to 3 there are eight, of 0 and 1 four.
  CHECK(held.Divide(5, 4, queues) == 4);
  CHECK(Names(queues[0]) == std::vector<float>{11, 14, 16});
  CHECK(Names(queues[1]) == std::vector<float>{22});
  int depth = 9;
  REQUIRE(held.TakeLast(&depth, queues));
  CHECK(depth == 5);
  CHECK(Names(queues[0]) == std::vector<float>{12, 13});
  CHECK(Names(queues[1]) == std::vector<float>{20, 21});
  REQUIRE(held.TakeLast(&depth, queues));
  CHECK(Names(queues[0]) == std::vector<float>{10, 15});
  CHECK(Names(queues[1]).empty());
  CHECK_FALSE(held.TakeLast(&depth, queues));
  // One pixel's rays stay together, however many there are.
  Fill({3, 3, 3, 3, 3}, 0, queues[0]);
  held.Start(8);
  std::uint32_t found = held.Divide(1, 2, queues);
  while (held.TakeLast(&depth, queues)) found += queues[0].count();
  CHECK(found == 5);
}

constexpr char kHall[] = R"({"settings": {"size": [32, 24], "max_depth": 40},
  "materials": [{"name": "m", "kd": 0.01, "reflect": 1},
                {"name": "a", "kd": 0.8, "transmit": 0.9, "ior": 1.5}],
  "objects": [
    {"quad": {"corners": [[-3,-3,-3], [3,-3,-3], [3,3,-3], [-3,3,-3]]}, "material": "m"},
    {"quad": {"corners": [[3,-3,3], [-3,-3,3], [-3,3,3], [3,3,3]]}, "material": "m"},
    {"quad": {"corners": [[-3,-3,3], [-3,-3,-3], [-3,3,-3], [-3,3,3]]}, "material": "m"},
    {"quad": {"corners": [[3,-3,-3], [3,-3,3], [3,3,3], [3,3,-3]]}, "material": "m"},
    {"quad": {"corners": [[-3,-3,3], [3,-3,3], [3,-3,-3], [-3,-3,-3]]}, "material": "m"},
    {"quad": {"corners": [[-3,3,-3], [3,3,-3], [3,3,3], [-3,3,3]]}, "material": "m"},
    {"sphere": {"center": [1, 0, -1], "radius": 0.7}, "material": "a"}],
  "lights": [{"point": {"position": [0, 2, 0]}, "intensity": 2}],
  "cameras": [{"name": "c", "eye": [-1, 0, 2], "look_at": [0, 0, -2]}]})";

TEST_CASE("a hall of mirrors with a ball of glass: the baseline's bits, in bounded memory") {
  const Scene scene = scene_text::Parse(kHall);
  RenderOptions options;
  options.threads = 1;
  options.target = Target::Scalar();
  RenderStats baseline;
  const Film expected = RenderOrFail(scene, scene.cameras[0], options, &baseline);
  ForEachTarget([&](Target target) {
    options.target = target;
    RenderStats stats;
    const Film found = RenderOrFail(scene, scene.cameras[0], options, &stats);
    CHECK(PixelsThatDiffer(found, expected) == 0);
    CHECK(stats.rays.refracted == baseline.rays.refracted);
    CHECK(stats.rays.beyond_depth == baseline.rays.beyond_depth);
    CHECK(stats.buffer_bytes < std::size_t{24} << 20);
  });
}

}  // namespace
}  // namespace sheaf
