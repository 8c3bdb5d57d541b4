// Projections by name and by their one number, for readers, writers and options.
//
// They go by the table kProjectionKinds, so that a new kind of projection concerns none of them.
#ifndef SHEAF_SCENE_PROJECTION_H_
#define SHEAF_SCENE_PROJECTION_H_

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/scene.h"

namespace sheaf {

const ProjectionKind& KindOf(const Projection& projection);

// All names, in the order of the table.
std::vector<std::string_view> ProjectionNames();

// Of this name, with its usual number; nothing where no kind has it.
std::optional<Projection> ProjectionNamed(std::string_view name);

// The projection's number; 0 where it has none.
double ParameterOf(const Projection& projection);

// Leaves a projection without a number as it is. The caller has checked the range.
void SetParameter(Projection& projection, double value);

}  // namespace sheaf

#endif  // SHEAF_SCENE_PROJECTION_H_
