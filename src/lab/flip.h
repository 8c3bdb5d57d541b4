// FLIP: the error that a person sees when flipping between two pictures.
#ifndef SHEAF_LAB_FLIP_H_
#define SHEAF_LAB_FLIP_H_

#include <vector>

#include "sheaf/film.h"

namespace sheaf {

// Pixels per degree of visual angle. The paper's viewer sits 0.7 m from a monitor that is 0.7 m and
// 3840 pixels wide.
inline constexpr double kFlipPixelsPerDegree = 67.0206;

// The FLIP error of each pixel, row by row from the top, in [0, 1]: 0 for equal pictures. This is
// the LDR variant of Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild, "FLIP: A
// Difference Evaluator for Alternating Images" (HPG 2020). Films hold linear light; values are
// clamped to [0, 1], and NaN counts as 0. Both films have the same size and at least one pixel.
std::vector<double> FlipErrors(const Film& reference, const Film& test,
                               double pixels_per_degree = kFlipPixelsPerDegree);

// Their mean.
double MeanFlip(const Film& reference, const Film& test,
                double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace sheaf

#endif  // SHEAF_LAB_FLIP_H_
