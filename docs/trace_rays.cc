// Traces 64 x 64 rays at a square and a sphere in front of it, and prints what they hit.
#include <sheaf/geometry.h>

#include <cstdio>
#include <vector>

int main() {
  const std::vector<float> corners = {-2, -2, -6, 2, -2, -6, 2, 2, -6, -2, 2, -6};  // x, y, z
  const std::vector<std::uint32_t> triangles = {0, 1, 2, 0, 2, 3};
  const std::vector<float> sphere = {0, 0, -4, 0.5f};  // center, radius
  sheaf::GeometryInput input;
  input.AddTriangles(corners, triangles);
  input.AddSpheres(sphere);
  const auto geometry = sheaf::Geometry::Build(input);
  if (!geometry) return std::fprintf(stderr, "%s\n", geometry.error().message.c_str()), 1;

  constexpr std::uint32_t kCount = 64 * 64;
  std::vector<float> zero(kCount, 0.0f), x(kCount), y(kCount), z(kCount, -1.0f), t(kCount);
  std::vector<std::uint32_t> object(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const std::uint32_t column = i % 64, row = i / 64;
    x[i] = (static_cast<float>(column) - 31.5f) / 64;
    y[i] = (static_cast<float>(row) - 31.5f) / 64;
  }
  const sheaf::RayArrays rays = {zero.data(), zero.data(), zero.data(),
                                 x.data(),    y.data(),    z.data()};
  sheaf::TraceClosest(geometry.value(), rays, kCount, {.t = t.data(), .object = object.data()})
      .value();

  std::uint32_t hits[2] = {0, 0};
  for (const std::uint32_t id : object) hits[id < 2 ? id : 0] += id < 2 ? 1 : 0;
  std::printf("square %u, sphere %u, nearest at t = %g\n", hits[0], hits[1], t[32 * 64 + 32]);
}
