// Where in a pixel its samples lie.
#ifndef SHEAF_RENDER_SAMPLE_PATTERN_H_
#define SHEAF_RENDER_SAMPLE_PATTERN_H_

#include <glm/vec2.hpp>
#include <vector>

#include "sheaf/scene.h"

namespace sheaf {

// `count` points in [0, 1)^2, the same for every pixel: Hammersley's set, point i at
// ((i + 1/2) / count, radical inverse of i in base 2, moved to the middle of its 1/2^k cell); one
// sample lies at the centre. With a filter other than the box they are spread by its weight, also
// beyond the pixel's edges. Correctly rounded operations alone, so the same bits everywhere.
std::vector<glm::dvec2> SamplePattern(int count, PixelFilter filter = PixelFilter::kBox);

// The same of Sobol's sequence, whose first points are spread evenly however many there will be;
// the first lies at the centre.
std::vector<glm::dvec2> SobolPattern(int count, PixelFilter filter = PixelFilter::kBox);

}  // namespace sheaf

#endif  // SHEAF_RENDER_SAMPLE_PATTERN_H_
