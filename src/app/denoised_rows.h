// Rows on their way to a picture. Where they are to be denoised they wait until all are there.
#ifndef SHEAF_APP_DENOISED_ROWS_H_
#define SHEAF_APP_DENOISED_ROWS_H_

#include <optional>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"

namespace sheaf {

class DenoisedRows {
 public:
  // `options` are the frame's that is asked for, whose rows `sink` gets. No filter: as they come.
  DenoisedRows(const RenderOptions& options, std::optional<DenoiseFilter> filter, RowSink sink);

  // What has to be rendered for it: with the layers that guide the filter, and with the pixels
  // around a crop, so that it has the bits of the whole picture.
  const RenderOptions& work() const { return work_; }

  // The next rows of that from the top.
  Status Write(const Film& rows);

  // After all rows.
  Status Finish();

 private:
  const RenderOptions options_;
  const std::optional<DenoiseFilter> filter_;
  const RowSink sink_;
  RenderOptions work_;
  Film film_;
  int rows_ = 0;
};

}  // namespace sheaf

#endif  // SHEAF_APP_DENOISED_ROWS_H_
