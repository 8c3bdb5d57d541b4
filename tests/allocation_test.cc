// Where memory ends: std::bad_alloc or a result, never half a state and never a leak.
#include <doctest/doctest.h>
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include "same_bits.h"
#include "sheaf/geometry.h"
#include "sheaf/render.h"
#include "test_frames.h"

namespace {

// Allocations that still succeed; below 0 all do.
std::atomic<long> left = -1;
std::atomic<long> live = 0;

void* Allocate(std::size_t size, std::size_t alignment) {
  if (left >= 0 && left-- <= 0) {
    left = 0;
    throw std::bad_alloc();
  }
  const std::size_t whole = (size + alignment - 1) / alignment * alignment;
  void* const memory = std::aligned_alloc(alignment, whole ? whole : alignment);
  if (!memory) throw std::bad_alloc();
  ++live;
  return memory;
}

void Free(void* memory) noexcept {
  if (memory) --live;
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return Allocate(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return Allocate(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { Free(memory); }
void operator delete(void* memory, std::size_t) noexcept { Free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { Free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { Free(memory); }

namespace sheaf {
namespace {

// Calls `body` with ever more allocations until it ends well; returns how often it threw. `step`
// more of them each time, in percent.
template <typename Body>
int FailEverywhere(int step, Body body) {
  for (long allowed = 0, failures = 0;; ++failures, allowed += 1 + allowed * step / 100) {
    const long before = live;
    left = allowed;
    bool is_done = false;
    try {
      body();
      is_done = true;
    } catch (const std::bad_alloc&) {
    }
    left = -1;
    if (is_done) return static_cast<int>(failures);
    if (live != before) FAIL("after ", allowed, " allocations ", live - before, " are left");
  }
}

TEST_CASE("a build that finds no memory throws and leaves everything as it was") {
  std::vector<float> vertices, spheres;
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 3 * 3000; ++i) {
    const auto x = static_cast<float>(i * 7919 % 1000);
    vertices.insert(vertices.end(),
                    {x, static_cast<float>(i * i % 97), static_cast<float>(i % 31)});
    indices.push_back(i);
    spheres.insert(spheres.end(), {x, 0, 1, 1});
  }
  for (const int threads : {1, 2}) {
    CAPTURE(threads);
    Geometry geometry;
    const auto build = [&] {
      GeometryInput input;
      input.AddTriangles(vertices, indices);
      input.AddSpheres(spheres);
      geometry = std::move(Geometry::Build(input, threads)).value();
    };
    left = -1;
    // What the threads, and an empty geometry, keep for good.
    build();
    geometry = Geometry();
    CHECK(geometry.object_count() == 0);
    bool was_half_built = false;
    const int failures = FailEverywhere(1, [&] {
      was_half_built |= geometry.object_count() != 0;
      build();
    });
    CHECK_FALSE(was_half_built);
    CHECK(failures > 50);
    CHECK(geometry.statistics().triangles == 3000);
    // What was there stays where a second build fails.
    left = 40;
    bool has_thrown = false;
    try {
      build();
    } catch (const std::bad_alloc&) {
      has_thrown = true;
    }
    left = -1;
    CHECK(has_thrown);
    CHECK(geometry.statistics().triangles == 3000);
  }
}

TEST_CASE("a frame that finds no memory throws, and the next one is whole") {
  const Scene scene = EverythingScene(3);
  RenderOptions options;
  options.width = 24;
  options.height = 16;
  options.tile_size = 8;
  for (const int threads : {1, 2}) {
    options.threads = threads;
    const Film want = RenderOrFail(scene, scene.cameras[0], options);
    Film film;
    const int failures = FailEverywhere(
        4, [&] { film = std::move(Render(scene, scene.cameras[0], options)).value(); });
    CHECK(failures > 20);
    CHECK(film.rgb == want.rgb);
  }
}

}  // namespace
}  // namespace sheaf
