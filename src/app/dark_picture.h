// Finds out why a picture shows nothing.
#ifndef SHEAF_APP_DARK_PICTURE_H_
#define SHEAF_APP_DARK_PICTURE_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace sheaf {

// Looks at the rows of a picture as they are written. It stops at the first two pixels that differ
// and the first that shows, so that a picture which shows something costs nothing.
class DarkPicture {
 public:
  // `transfer` and `ev`, in stops, decide what is still shown.
  DarkPicture(Transfer transfer, double ev);

  void AddRows(const Film& rows);

  // Once the picture is whole: why it is black, or of one colour; empty where it is neither, or for
  // a good reason. It renders a small picture to see what is in view.
  Result<std::string> Explain(const Renderer& renderer, const Camera& camera,
                              const RenderOptions& options) const;

 private:
  const float least_shown_;
  bool is_dark_ = true, is_uniform_ = true, has_first_ = false;
  float largest_ = 0;
  float first_[3] = {};
};

}  // namespace sheaf

#endif  // SHEAF_APP_DARK_PICTURE_H_
