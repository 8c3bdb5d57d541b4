// How noisy a picture is where, by the picture alone.
#ifndef SHEAF_RENDER_ESTIMATE_NOISE_H_
#define SHEAF_RENDER_ESTIMATE_NOISE_H_

#include "sheaf/film.h"
#include "simd/find_medians.h"
#include "src/render/noisy_picture.h"

namespace sheaf {

// How far from a pixel its estimate looks: at blocks, their mean, and a neighbour in place of a
// pixel that is not usable.
inline constexpr int kNoiseReach = 5;

// Fills picture->variance, margin included: of the noise of its colours, all channels together, 0
// where there is none. Uses `scratch`, three planes of the picture's size.
//
// Noise is what is left of a 2 x 2 block when its rows and columns are taken off, which takes off
// slopes and straight edges: (a - b - c + d) / 2. Of 6 x 6 blocks around a pixel the usual one
// counts, by medians along rows and then columns, so that the crooked edges of surfaces and
// shadows, which few blocks lie on, are no noise. Normal noise has a median of 0.6745 deviations
// (Donoho and Johnstone, "Ideal spatial adaptation by wavelet shrinkage", Biometrika 1994).
//
// Textures of the albedo are not in the light, and colours have no noise of the albedo's: of both
// estimates, of the light and of the colours over the albedo, the lower counts.
void EstimateNoise(const Film& film, FindMediansKernel<float>* find_medians, int threads,
                   NoisyPlane (&scratch)[3], NoisyPicture* picture);

// The mean over the 3 x 3 pixels around each, but for the margin. No plane is the other.
void MeanOfPatches(const NoisyPlane& from, int width, int height, int threads, NoisyPlane* to);

}  // namespace sheaf

#endif  // SHEAF_RENDER_ESTIMATE_NOISE_H_
