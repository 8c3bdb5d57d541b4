// Areas of a picture that come in any order, as rows from the top.
#ifndef SHEAF_CLUSTER_STRIPS_H_
#define SHEAF_CLUSTER_STRIPS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "sheaf/film.h"

namespace sheaf {

class Strips {
 public:
  // Of areas within `pixels`, as AreaPlan makes them.
  explicit Strips(const PixelRect& pixels) : pixels_(pixels), top_(pixels.y0) {}

  // A finished area.
  void Add(const PixelRect& area, Film film);

  // The next rows, as wide as the picture, where all of their pixels are there.
  std::optional<Film> Take();

  // Whether all rows have been taken.
  bool is_done() const { return top_ == pixels_.y1; }

  // The first row that has not been taken.
  int top() const { return top_; }

  // What is held of pixels.
  std::int64_t held_pixels() const { return held_pixels_; }

 private:
  // Rows from the map's key on, with the pixels that are there so far.
  struct Strip {
    Film film;
    std::int64_t missing = 0;
  };
  const PixelRect pixels_;
  int top_;
  std::map<int, Strip> strips_;
  std::int64_t held_pixels_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_STRIPS_H_
