// A mesh as the numbers of its vertices, compiled as the triangles of a scene.
#ifndef SHEAF_TESTS_TRIANGLE_MESH_H_
#define SHEAF_TESTS_TRIANGLE_MESH_H_

#include <array>
#include <cstdint>
#include <vector>

#include "random_scene.h"
#include "src/render/compile_scene.h"

namespace sheaf {

// Triangles that share vertices, as scenes do: by the same numbers.
struct TriangleMesh {
  std::vector<Vec3<float>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  CompiledScene<float> Compile() const {
    Scene scene;
    scene.materials.push_back({});
    for (const auto& t : triangles) {
      Triangle triangle;
      for (int k = 0; k < 3; ++k) triangle.vertices[k] = ToGlm(vertices[t[k]].To<double>());
      scene.objects.push_back({"", triangle, 0});
    }
    return CompileScene<float>(scene);
  }
};

}  // namespace sheaf

#endif  // SHEAF_TESTS_TRIANGLE_MESH_H_
