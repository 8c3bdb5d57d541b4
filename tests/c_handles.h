// Handles of the C API that go away with the test.
#ifndef SHEAF_TESTS_C_HANDLES_H_
#define SHEAF_TESTS_C_HANDLES_H_

#include <cstddef>
#include <string>

#include "sheaf/capi.h"
#include "tests/run_command.h"

namespace sheaf {

template <typename Handle, void (*destroy)(Handle*)>
struct Owner {
  Handle* handle = nullptr;
  Owner() = default;
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;
  ~Owner() { destroy(handle); }
};
using InputOwner = Owner<sheaf_geometry_input, sheaf_geometry_input_destroy>;
using GeometryOwner = Owner<sheaf_geometry, sheaf_geometry_destroy>;
using SceneOwner = Owner<sheaf_scene, sheaf_scene_destroy>;
using FilmOwner = Owner<sheaf_film, sheaf_film_destroy>;
using ProgressOwner = Owner<sheaf_progress, sheaf_progress_destroy>;

// Rays of C, a sheaf_rays or sheaf_rays_d, that lie where those of C++ do.
template <typename InC, typename Arrays>
void PointAt(const Arrays& from, std::size_t count, InC& rays) {
  rays.count = count;
  rays.origin_x = from.origin_x, rays.origin_y = from.origin_y, rays.origin_z = from.origin_z;
  rays.direction_x = from.direction_x, rays.direction_y = from.direction_y;
  rays.direction_z = from.direction_z;
  rays.source = from.source;
}

inline bool Says(const std::string& part) { return Contains(sheaf_error_message(), part); }

}  // namespace sheaf

#endif  // SHEAF_TESTS_C_HANDLES_H_
