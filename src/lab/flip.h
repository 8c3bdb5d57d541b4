// FLIP, the error that a person sees who flips between two pictures.
#ifndef SHEAF_LAB_FLIP_H_
#define SHEAF_LAB_FLIP_H_

#include "sheaf/film.h"

namespace sheaf {

// Pixels per degree of the paper's viewing conditions: 0.7 m from a monitor 0.7 m and 3840 pixels
// wide.
inline constexpr double kFlipPixelsPerDegree = 67.0206;

// The mean over all pixels of the LDR FLIP of Andersson, Nilsson, Akenine-Moeller, Oskarsson,
// Astrom, Fairchild, "FLIP: A Difference Evaluator for Alternating Images" (HPG 2020), in [0, 1].
// Films hold linear light, clamped to [0, 1] (NaN is 0), have the same size and at least one pixel.
double MeanFlip(const Film& reference, const Film& test,
                double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace sheaf

#endif  // SHEAF_LAB_FLIP_H_
