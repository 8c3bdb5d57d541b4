// A user's model as a scene that rays are timed on.
#ifndef SHEAF_BENCH_READ_MESH_H_
#define SHEAF_BENCH_READ_MESH_H_

#include <string>

#include "bench/make_scenes.h"
#include "sheaf/error.h"

namespace sheaf::bench {

// The triangles and spheres of any file that ReadScene reads, seen from the front, the right and
// above, so that all of them are in the picture; the light stands above the eye, to its left.
// Fails as ReadScene does, and where there is nothing to hit or only disks. Named after the file.
Result<BenchScene> ReadMesh(const std::string& path);

}  // namespace sheaf::bench

#endif  // SHEAF_BENCH_READ_MESH_H_
