// The film in the window and its bytes, which change band by band.
#ifndef SHEAF_VIEW_SHOWN_FILM_H_
#define SHEAF_VIEW_SHOWN_FILM_H_

#include <cstdint>
#include <string>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/formats.h"
#include "src/view/view_frame.h"

namespace sheaf {

class ShownFilm {
 public:
  // Before the first rows of a frame. A film of another size is scaled to this one, so that what
  // the frame has not reached yet still shows something.
  void Begin(const ViewRequest& request, int width, int height);

  // Rows of the frame, whose top left pixel is (x, y) of the picture.
  void AddRows(const Film& rows, int x, int y);
  // After the last rows: of heat and lanes, which are scaled by the whole frame.
  void Finish();

  // Other bytes of the same film.
  void Develop(const Development& development);

  // The stops that turn the median of the film into grey (MeterExposure).
  double Meter() const { return MeterExposure(film_); }

  // The picture as `sheaf render` writes it, with what is said of its origin.
  Status Write(const std::string& path, const PictureMetadata& metadata) const;

  int width() const { return film_.width; }
  int height() const { return film_.height; }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void Quantize(const PixelRect& rect);

  Film film_;  // colours as they are shown, but for the development
  std::vector<std::uint8_t> bytes_;
  Shown shown_ = Shown::kColour;
  Development development_;
  Transfer transfer_ = Transfer::kSrgb;  // of the scene
  double far_ = 1;                       // of the depth
  Film heat_;                            // until the frame is finished
  int threads_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_VIEW_SHOWN_FILM_H_
