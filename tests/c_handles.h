// Handles of the C API that go away with the test.
#ifndef SHEAF_TESTS_C_HANDLES_H_
#define SHEAF_TESTS_C_HANDLES_H_

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

inline bool Says(const std::string& part) { return Contains(sheaf_error_message(), part); }

}  // namespace sheaf

#endif  // SHEAF_TESTS_C_HANDLES_H_
