// A user's model as a scene that rays are timed on.
#ifndef SHEAF_BENCH_READ_MESH_H_
#define SHEAF_BENCH_READ_MESH_H_

#include <string>

#include "bench/make_scenes.h"
#include "sheaf/error.h"

namespace sheaf::bench {

enum class MeshView {
  kFramed,  // from the front, the right and above, so that all is in the picture
  kCamera,  // of the file's first camera where that is a perspective one; else the same
};

// The triangles and spheres of any file that ReadScene reads; the light stands above the framed
// view's eye, to its left. Fails as ReadScene does, and where there is nothing to hit or only
// disks. Named after the file.
Result<BenchScene> ReadMesh(const std::string& path, MeshView view = MeshView::kFramed);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_READ_MESH_H_
