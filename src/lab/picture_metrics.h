// How far apart two pictures are.
#ifndef SHEAF_LAB_PICTURE_METRICS_H_
#define SHEAF_LAB_PICTURE_METRICS_H_

#include <cstdint>

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// Over all channels of all pixels. Two NaNs are equal; a NaN and a number are infinitely far apart.
struct PictureMetrics {
  double rmse = 0;         // root of the mean squared difference
  double psnr = 0;         // 20 log10(1 / rmse) in decibels, infinite for equal pictures
  double largest = 0;      // largest difference of a channel
  std::uint64_t over = 0;  // pixels with a channel more than 1/255 apart
  double mean_flip = 0;    // see MeanFlip
};

// The pictures have the same size, at least 1 x 1. They hold display values, where 1 is white.
// `transfer` says how those encode light, because FLIP works on linear light.
PictureMetrics MeasurePictures(const Film& reference, const Film& test, Transfer transfer);

// PictureMetrics::rmse alone. It takes far less time than all of them.
double RootMeanSquare(const Film& reference, const Film& test);

// How many floats lie between a and b, one of them included: the distance in units in the last
// place. +0 and -0 are 1 apart, two NaNs 0. A NaN and a number are 2^32 - 1 apart.
std::uint32_t UlpDistance(float a, float b);

struct FilmDifference {
  std::uint64_t pixels = 0;     // pixels that have a channel more than the allowed ULPs apart
  std::uint32_t most_ulps = 0;  // the largest distance of a channel
  int x = 0, y = 0;             // the first of those pixels, row by row from the top
};

// Of films of the same size.
FilmDifference CompareFilms(const Film& reference, const Film& test, std::uint32_t allowed_ulps);

}  // namespace sheaf

#endif  // SHEAF_LAB_PICTURE_METRICS_H_
