// Finished areas of a picture that outlive the run.
#ifndef SHEAF_CLUSTER_KEPT_AREAS_H_
#define SHEAF_CLUSTER_KEPT_AREAS_H_

#include <cstddef>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"

namespace sheaf {

class KeptAreas {
 public:
  virtual ~KeptAreas() = default;

  // Those of earlier runs: of whole tiles, without overlaps, from the top, and from the left where
  // they begin in one row.
  virtual const std::vector<PixelRect>& earlier() const = 0;

  // The pixels of earlier()[index].
  virtual Result<Film> Read(std::size_t index) = 0;

  // Keeps an area of this run.
  virtual Status Keep(const PixelRect& area, const Film& pixels) = 0;
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_KEPT_AREAS_H_
