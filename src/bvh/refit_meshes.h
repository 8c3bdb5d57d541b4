// The short way for meshes of floats: from their vertices into the leaves, without arrays between.
#ifndef SHEAF_BVH_REFIT_MESHES_H_
#define SHEAF_BVH_REFIT_MESHES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "src/bvh/tree.h"

namespace sheaf::bvh {

struct FloatMesh {
  std::span<const float> vertices;
  std::span<const std::uint32_t> indices;
  std::uint32_t first = 0;  // its first primitive
};

// Whether numbers are finite, and so moderate that nothing has to be scaled and nothing is a giant,
// and indices are in range. Runs on the threads of the caller's arena.
bool AreModerate(const std::vector<FloatMesh>& meshes);

// Writes the triangles of such meshes, which are all that the tree holds, into its leaves, and
// boxes around them, as RefitTree does; the boxes of leaves may be larger by a rounding. False
// where a triangle has so little area that it takes a closer look: the tree then has to be refitted
// or built in another way. Runs on the threads of the caller's arena.
bool RefitMeshes(const std::vector<FloatMesh>& meshes, Tree<float>& tree);

}  // namespace sheaf::bvh

#endif  // SHEAF_BVH_REFIT_MESHES_H_
