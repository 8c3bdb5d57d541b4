// Traces 64 x 64 rays at a square and a sphere in front of it, then, from what they hit, shadows
// towards a lamp and what the sphere mirrors.
#include <sheaf/geometry.h>

#include <array>
#include <cstdio>
#include <vector>

constexpr std::size_t kCount = 64 * 64;

// x, y and z of a point or a direction for each ray.
struct Vectors : std::array<std::vector<float>, 3> {
  Vectors() { fill(std::vector<float>(kCount)); }
  std::array<float*, 3> data() { return {at(0).data(), at(1).data(), at(2).data()}; }
};

sheaf::RayArrays RaysFrom(const Vectors& origin, const Vectors& direction,
                          const std::vector<std::uint32_t>& source) {
  return {origin[0].data(),    origin[1].data(),    origin[2].data(), direction[0].data(),
          direction[1].data(), direction[2].data(), source.data()};
}

int main() {
  const std::vector<float> corners = {-2, -2, -6, 2, -2, -6, 2, 2, -6, -2, 2, -6};  // x, y, z
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 0, 2, 3};
  const std::vector<float> sphere = {0, 0, -4, 0.5f};  // center, radius
  sheaf::GeometryInput input;
  input.AddTriangles(corners, triangles);
  input.AddSpheres(sphere);
  const auto built = sheaf::Geometry::Build(input);
  if (!built) return std::fprintf(stderr, "%s\n", built.error().message.c_str()), 1;
  const sheaf::Geometry& geometry = built.value();

  Vectors eye, direction;
  std::vector<std::uint32_t> source(kCount, sheaf::Geometry::kNoPrimitive);
  for (std::size_t i = 0; i < kCount; ++i) {
    const std::size_t column = i % 64, row = i / 64;
    direction[0][i] = (static_cast<float>(column) - 31.5f) / 64;
    direction[1][i] = (static_cast<float>(row) - 31.5f) / 64;
    direction[2][i] = -1;
  }
  std::vector<float> t(kCount), u(kCount), v(kCount);
  std::vector<std::uint32_t> primitive(kCount), object(kCount);
  const sheaf::RayArrays rays = RaysFrom(eye, direction, source);
  const sheaf::HitArrays hits = {t.data(), primitive.data(), object.data(), u.data(), v.data()};
  sheaf::TraceClosest(geometry, rays, kCount, hits).value();

  // Both go on in front of what was hit. What missed has no direction, and misses again.
  Vectors front, normal, to_lamp, mirrored;
  sheaf::FindHitPoints(
      geometry, rays, hits, kCount,
      {.normal = normal.data(), .front = front.data(), .front_source = source.data()})
      .value();
  constexpr float kLamp[3] = {1, 2, 0};
  for (std::size_t i = 0; i < kCount; ++i) {
    if (primitive[i] == sheaf::Geometry::kNoPrimitive) continue;
    float along = 0;
    for (std::size_t k = 0; k < 3; ++k) along += direction[k][i] * normal[k][i];
    for (std::size_t k = 0; k < 3; ++k) {
      to_lamp[k][i] = kLamp[k] - front[k][i];
      if (object[i] == 1) mirrored[k][i] = direction[k][i] - 2 * along * normal[k][i];
    }
  }
  std::vector<std::uint32_t> shadow(kCount), seen(kCount);
  sheaf::TraceOccluded(geometry, RaysFrom(front, to_lamp, source), kCount, shadow.data(),
                       {.interval = {.all_t_max = 1}})
      .value();
  sheaf::TraceClosest(geometry, RaysFrom(front, mirrored, source), kCount, {.object = seen.data()})
      .value();

  int square = 0, ball = 0, dark = 0, mirrors = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    square += object[i] == 0;
    ball += object[i] == 1;
    dark += object[i] == 0 && shadow[i];
    mirrors += seen[i] == 0;
  }
  std::printf("square %d, sphere %d, nearest at t = %g\n", square, ball, t[32 * 64 + 32]);
  std::printf("%d of the square in shadow, %d of the sphere mirror the square\n", dark, mirrors);
}
