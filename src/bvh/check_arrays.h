// Which of the arrays of rays is missing.
#ifndef SHEAF_BVH_CHECK_ARRAYS_H_
#define SHEAF_BVH_CHECK_ARRAYS_H_

#include <cstddef>
#include <string>
#include <utility>

#include "sheaf/error.h"
#include "sheaf/geometry.h"

namespace sheaf {

inline Error NullArray(const char* name) {
  return {ErrorKind::kUsage, std::string(name) + " is null"};
}

template <typename Real>
Status CheckRays(const RayArraysOf<Real>& rays, std::size_t count) {
  if (count == 0) return Done{};
  const std::pair<const char*, const Real*> arrays[] = {
      {"origin_x", rays.origin_x},       {"origin_y", rays.origin_y},
      {"origin_z", rays.origin_z},       {"direction_x", rays.direction_x},
      {"direction_y", rays.direction_y}, {"direction_z", rays.direction_z}};
  for (const auto& [name, array] : arrays) {
    if (!array) return NullArray(name);
  }
  return Done{};
}

}  // namespace sheaf

#endif  // SHEAF_BVH_CHECK_ARRAYS_H_
