// A frame whose rows are denoised when all of them are there.
#ifndef SHEAF_APP_DENOISED_ROWS_H_
#define SHEAF_APP_DENOISED_ROWS_H_

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"

namespace sheaf {

class DenoisedRows {
 public:
  // What has to be rendered for the frame that `options` ask for: with the layers that guide the
  // filter, and with the pixels around a crop, so that it has the bits of the whole picture.
  static RenderOptions Widen(RenderOptions options);

  // `options` are the frame's own.
  DenoisedRows(const RenderOptions& options, DenoiseFilter filter);

  // The next rows from the top, of the frame that is rendered.
  void AddRows(const Film& rows);

  // After all rows: those of the frame that was asked for, and the layers that guided too.
  Result<Film> Finish();

 private:
  RenderOptions options_;
  DenoiseFilter filter_;
  PixelRect asked_, rendered_;
  Film film_;
  int rows_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_APP_DENOISED_ROWS_H_
