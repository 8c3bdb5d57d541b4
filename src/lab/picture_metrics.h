// How far apart two pictures are.
#ifndef SHEAF_LAB_PICTURE_METRICS_H_
#define SHEAF_LAB_PICTURE_METRICS_H_

#include <cstdint>

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// Over all channels of all pixels; two NaNs are equal, a NaN and a number infinitely far apart.
struct PictureMetrics {
  double rmse = 0;         // root of the mean squared difference
  double psnr = 0;         // 20 log10(1 / rmse) in decibels, infinite for equal pictures
  double largest = 0;      // largest difference of a channel
  std::uint64_t over = 0;  // pixels with a channel more than 1/255 apart
  double mean_flip = 0;    // see FlipError
};

// The pictures have the same size, at least 1 x 1, and hold display values: 1 is white. `transfer`
// says how those encode light, which FLIP asks for.
PictureMetrics MeasurePictures(const Film& reference, const Film& test, Transfer transfer);

// PictureMetrics::rmse alone, which takes far less time.
double RootMeanSquare(const Film& reference, const Film& test);

// Units in the last place between two floats, counted over all floats in order; +0 and -0 are one
// apart, two NaNs 0, a NaN and a number the most there is.
std::uint32_t UlpDistance(float a, float b);

struct FilmDifference {
  std::uint64_t pixels = 0;     // with a channel more than the allowed ULPs apart
  std::uint32_t most_ulps = 0;  // of any channel
  int x = 0, y = 0;             // of the first of those pixels, row by row from the top
};

// Of films of the same size.
FilmDifference CompareFilms(const Film& reference, const Film& test, std::uint32_t allowed_ulps);

}  // namespace sheaf

#endif  // SHEAF_LAB_PICTURE_METRICS_H_
