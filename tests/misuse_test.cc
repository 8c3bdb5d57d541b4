// The library as it is misused: null arrays, huge counts, the host's own threads and modes.
#define NDEBUG  // as a user's release build has it
#include <doctest/doctest.h>
#include <oneapi/tbb/global_control.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "bits.h"
#include "random_scene.h"
#include "sheaf/film.h"
#include "sheaf/formats.h"
#include "sheaf/geometry.h"
#include "src/bvh/ray_batches.h"
#include "targets.h"
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace sheaf {
namespace {

using Parallelism = oneapi::tbb::global_control;

const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
const std::vector<std::uint32_t> kTwoTriangles = {0, 1, 2, 0, 2, 3};

// A grid of side x side cells, two triangles each.
struct Grid {
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;

  explicit Grid(std::uint32_t side) {
    for (std::uint32_t j = 0; j <= side; ++j) {
      for (std::uint32_t i = 0; i <= side; ++i) {
        const float height = static_cast<float>(i * j % 7) * 0.3f;
        vertices.insert(vertices.end(), {static_cast<float>(i), height, static_cast<float>(j)});
      }
    }
    for (std::uint32_t j = 0; j < side; ++j) {
      for (std::uint32_t i = 0; i < side; ++i) {
        const std::uint32_t a = j * (side + 1) + i, b = a + side + 1;
        indices.insert(indices.end(), {a, a + 1, b + 1, a, b + 1, b});
      }
    }
  }

  Geometry Build(int threads) const {
    GeometryInput input;
    input.AddTriangles(vertices, indices);
    return std::move(Geometry::Build(input, threads)).value();
  }
};

// ---- Threads ----

TEST_CASE("a build leaves the host's own threads alone") {
  const Parallelism host(Parallelism::max_allowed_parallelism, 8);
  const auto active = [] {
    return Parallelism::active_value(Parallelism::max_allowed_parallelism);
  };
  REQUIRE(active() == 8);
  const Grid grid(300);
  std::atomic<bool> is_done = false;
  std::thread builder([&] {
    grid.Build(1);
    is_done = true;
  });
  std::size_t least = 8, most = 8;
  long polls = 0;
  for (; !is_done; ++polls) {
    least = std::min(least, active());
    most = std::max(most, active());
    std::this_thread::yield();
  }
  builder.join();
  CHECK(polls > 10);
  CHECK(least == 8);
  CHECK(most == 8);
}

double SecondsToBuild(const Grid& grid, int threads) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    grid.Build(threads);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

TEST_CASE("more threads than there are cores neither fail nor take longer") {
  const Grid one(1), many(200);
  for (const int threads : {1000, 100'000, std::numeric_limits<int>::max()}) {
    CAPTURE(threads);
    CHECK(one.Build(threads).statistics().triangles == 2);
    CHECK(many.Build(threads).statistics().triangles == 80'000);
  }
  CHECK(SecondsToBuild(many, 1000) < 4 * SecondsToBuild(many, 1));
}

// ---- Arrays and counts ----

std::string BuildError(const GeometryInput& input) {
  const Result<Geometry> built = Geometry::Build(input);
  return built.ok() ? "" : built.error().message;
}

TEST_CASE("null arrays and meshes without indices are named") {
  const float* const no_numbers = nullptr;
  const std::uint32_t* const no_indices = nullptr;
  const std::span<const float> numbers(no_numbers, 12);
  GeometryInput vertices, indices, bare, spheres, disks;
  vertices.AddTriangles(numbers, kTwoTriangles);
  CHECK(BuildError(vertices) == "object 0: the vertices are null");
  indices.AddTriangles(kSquare, {no_indices, 6});
  CHECK(BuildError(indices) == "object 0: the indices are null");
  bare.AddTriangles(kSquare, {});
  CHECK(BuildError(bare) == "object 0: vertices without indices");
  spheres.AddTriangles(kSquare, kTwoTriangles);
  spheres.AddSpheres(numbers);
  CHECK(BuildError(spheres) == "object 1: the numbers are null");
  disks.AddDisks({no_numbers, 7});
  CHECK(BuildError(disks) == "object 0: the numbers are null");
}

TEST_CASE("null rays are named, and nothing is written") {
  const Geometry geometry = Grid(1).Build(1);
  const float one[1] = {1};
  const RayArrays sound = {one, one, one, one, one, one};
  const std::pair<const char*, const float * RayArrays::*> arrays[] = {
      {"origin_x", &RayArrays::origin_x},       {"origin_y", &RayArrays::origin_y},
      {"origin_z", &RayArrays::origin_z},       {"direction_x", &RayArrays::direction_x},
      {"direction_y", &RayArrays::direction_y}, {"direction_z", &RayArrays::direction_z}};
  for (const auto& [name, array] : arrays) {
    RayArrays rays = sound;
    rays.*array = nullptr;
    float t[1] = {-7};
    std::uint32_t occluded[1] = {7};
    const Status closest = TraceClosest(geometry, rays, 1, {.t = t});
    REQUIRE_FALSE(closest.ok());
    CHECK(closest.error().message == std::string(name) + " is null");
    CHECK(closest.error().kind == ErrorKind::kUsage);
    const Status any = TraceOccluded(geometry, rays, 1, occluded);
    REQUIRE_FALSE(any.ok());
    CHECK(any.error().message == std::string(name) + " is null");
    CHECK(t[0] == -7);
    CHECK(occluded[0] == 7);
    CHECK(TraceClosest(geometry, rays, 0, {}).ok());
  }
  const Status nowhere = TraceOccluded(geometry, sound, 1, nullptr);
  REQUIRE_FALSE(nowhere.ok());
  CHECK(nowhere.error().message == "occluded is null");
  CHECK(TraceOccluded(geometry, sound, 0, nullptr).ok());
  CHECK(TraceClosest(geometry, sound, 1, {}).ok());
}

// The spans are longer than the arrays: whoever read them would crash.
TEST_CASE("more primitives than ids tell apart are refused before one is read") {
  constexpr std::size_t kMost = std::size_t{1} << 26;
  const float one[1] = {1};
  const std::uint32_t zero[1] = {0};
  for (const std::size_t count : {kMost + 1, (std::size_t{1} << 32) + 1, std::size_t{1} << 40}) {
    CAPTURE(count);
    const std::string most = ", at most 67108864 are possible";
    GeometryInput spheres, disks, triangles;
    spheres.AddSpheres(std::span<const float>(one, 4 * count));
    CHECK(BuildError(spheres) == std::to_string(count) + " spheres" + most);
    disks.AddDisks(std::span<const float>(one, 7 * count));
    CHECK(BuildError(disks) == std::to_string(count) + " disks" + most);
    triangles.AddTriangles(std::span<const float>(one, 3 * count), {zero, 3 * count});
    CHECK(BuildError(triangles) == std::to_string(count) + " triangles" + most);
  }
  // Of many objects none of which is too large.
  GeometryInput halves;
  for (int i = 0; i < 3; ++i) halves.AddSpheres(std::span<const float>(one, 2 * kMost));
  CHECK(BuildError(halves) == "100663296 spheres, at most 67108864 are possible");
}

// Kernels count in 32 bits.
TEST_CASE("more rays than 32 bits count are traced in parts, each ray once") {
  for (const std::size_t count : {std::size_t{0}, std::size_t{1}, kMaxBatch, kMaxBatch + 1,
                                  (std::size_t{1} << 32) - 1, (std::size_t{1} << 34) + 12345}) {
    std::size_t next = 0;
    ForEachBatch(count, kMaxBatch, [&](std::size_t first, std::uint32_t n) {
      CHECK(first == next);
      CHECK(n > 0);
      CHECK(n <= kMaxBatch);
      next += n;
    });
    CHECK(next == count);
  }
}

// ---- Results and owners ----

// What a child process that runs `body` says before it dies of SIGABRT, or "lives".
template <typename Body>
std::string LastWords(Body body) {
  int ends[2];
  REQUIRE(pipe(ends) == 0);
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    dup2(ends[1], 2);
    std::signal(SIGABRT, SIG_DFL);
    body();
    _exit(0);
  }
  close(ends[1]);
  std::string words;
  char buffer[256];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof(buffer))) > 0;) {
    words.append(buffer, static_cast<std::size_t>(n));
  }
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT ? words : "lives";
}

TEST_CASE("a value that is not there ends the program with the error's message") {
  GeometryInput input;
  const std::vector<float> inside_out = {0, 0, 0, -1};
  input.AddSpheres(inside_out);
  const Result<Geometry> failed = Geometry::Build(input);
  REQUIRE_FALSE(failed.ok());
  const std::string words =
      "sheaf: Result::value() of an error: object 0, sphere 0: the radius is negative\n";
  CHECK(LastWords([&] { (void)failed.value().object_count(); }) == words);
  CHECK(LastWords([&] { (void)Geometry::Build(input).value(); }) == words);
  CHECK(LastWords([] { (void)Status(Done{}).error(); }) ==
        "sheaf: Result::error(): there is none\n");
}

TEST_CASE("owners that were moved from are empty") {
  Film film(4, 3);
  const Film taken = std::move(film);
  CHECK(taken.pixel_count() == 12);
  CHECK(film.pixel_count() == 0);  // NOLINT: that is the question
  CHECK(film.rgb.empty());
  Film assigned(2, 2);
  assigned = Film(taken);
  CHECK(assigned.rgb.size() == 36);

  Result<PictureWriter> made = PictureWriter::Create("moved.png", 4, 3, Transfer::kSrgb);
  REQUIRE(made.ok());
  const PictureWriter writer = std::move(made).value();
  const Status rows = made.value().WriteRows(taken);
  REQUIRE_FALSE(rows.ok());
  CHECK(rows.error().message == "a picture writer that was moved from");
  CHECK_FALSE(made.value().Finish().ok());
}

// ---- Denormals ----

TEST_CASE("a ray that starts on a triangle does not hit it at 0") {
  GeometryInput input;
  const std::vector<float> corners = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
  const std::vector<std::uint32_t> triangle = {0, 1, 2};
  input.AddTriangles(corners, triangle);
  const Geometry geometry = std::move(Geometry::Build(input)).value();
  const float zero[1] = {0}, slope[1] = {0.1f}, one[1] = {1};
  ForEachTarget([&](Target target) {
    std::uint32_t primitive[1];
    TraceClosest(geometry, {zero, zero, zero, zero, slope, one}, 1, {.primitive = primitive},
                 {.target = target})
        .value();
    CHECK(primitive[0] == Geometry::kNoPrimitive);
  });
  CHECK(TraceInterval{}.all_t_min == std::numeric_limits<float>::min());
}

#if defined(__SSE2__)
// Flushes denormals to 0 and takes those that come for 0, as hosts do that use Embree.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kModes); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;
  static bool is_on() { return (_mm_getcsr() & kModes) == kModes; }

 private:
  static constexpr unsigned kModes = 0x8040;
  unsigned saved_;
};

struct Traced {
  std::vector<float> t, u, v;
  std::vector<std::uint32_t> primitive, occluded;

  Traced(const Geometry& geometry, const std::array<std::vector<float>, 6>& rays, Target target)
      : t(rays[0].size()), u(t.size()), v(t.size()), primitive(t.size()), occluded(t.size()) {
    const RayArrays arrays = {rays[0].data(), rays[1].data(), rays[2].data(),
                              rays[3].data(), rays[4].data(), rays[5].data()};
    const TraceOptions options = {.target = target};
    TraceClosest(geometry, arrays, t.size(),
                 {.t = t.data(), .primitive = primitive.data(), .u = u.data(), .v = v.data()},
                 options)
        .value();
    TraceOccluded(geometry, arrays, t.size(), occluded.data(), options).value();
  }
};

TEST_CASE("hits do not depend on whether the host flushes denormals, nor change that") {
  Random random(9);
  const Grid grid(40);
  std::vector<float> balls;
  for (int i = 0; i < 400; ++i) {
    const Vec3d c = UniformPoint(random, 0, 40);
    balls.insert(balls.end(), {static_cast<float>(c.x), static_cast<float>(c.y),
                               static_cast<float>(c.z), static_cast<float>(0.1 + 0.002 * i)});
  }
  std::array<std::vector<float>, 6> rays;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d from = UniformPoint(random, -5, 45), to = UniformPoint(random, 0, 40);
    for (int k = 0; k < 3; ++k) {
      // Many start on vertices, and many run along axes.
      const double start = i % 3 == 0 ? std::floor(from[k]) : from[k];
      rays[k].push_back(static_cast<float>(k == 1 && i % 6 == 0 ? 0 : start));
      rays[3 + k].push_back(static_cast<float>(i % 5 == k ? 0 : to[k] - start));
    }
  }
  GeometryInput input;
  input.AddTriangles(grid.vertices, grid.indices);
  input.AddSpheres(balls);
  const Geometry kept = std::move(Geometry::Build(input)).value();
  const auto check = [&](Target target) {
    const Traced want(kept, rays, target);
    CHECK_FALSE(FlushDenormals::is_on());
    const FlushDenormals flush;
    const Geometry flushed = std::move(Geometry::Build(input)).value();
    const Traced got(flushed, rays, target);
    CHECK(FlushDenormals::is_on());
    int differing = 0, hits = 0;
    for (std::size_t i = 0; i < want.t.size(); ++i) {
      hits += want.primitive[i] != Geometry::kNoPrimitive;
      differing += !SameBits(want.t[i], got.t[i]) || !SameBits(want.u[i], got.u[i]) ||
                   !SameBits(want.v[i], got.v[i]) || want.primitive[i] != got.primitive[i] ||
                   want.occluded[i] != got.occluded[i];
    }
    CHECK(hits > 1000);
    CHECK(differing == 0);
  };
  ForEachTarget(check);
  check(Target::Scalar());
}
#endif

}  // namespace
}  // namespace sheaf
