// Whole files as text, and films to write into some.
#ifndef SHEAF_TESTS_PICTURE_FILES_H_
#define SHEAF_TESTS_PICTURE_FILES_H_

#include <fstream>
#include <iterator>
#include <random>
#include <string>

#include "sheaf/film.h"

namespace sheaf {

inline std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

inline Film RandomFilm(int width, int height) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> channel(-0.2f, 1.2f);
  Film film(width, height);
  for (float& value : film.rgb) value = channel(random);
  return film;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_PICTURE_FILES_H_
