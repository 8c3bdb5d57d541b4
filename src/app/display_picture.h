// Pictures as a display gets them, for those that compare them.
#ifndef SHEAF_APP_DISPLAY_PICTURE_H_
#define SHEAF_APP_DISPLAY_PICTURE_H_

#include <string>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// A float picture holds light, which is encoded first where `transfer` says so.
Result<Film> ReadDisplayValues(const std::string& path, Transfer transfer);

// A picture of bytes ends at 0 and 1. A float picture that is compared with it is clamped likewise.
void ClampToDisplay(Film& film);

// kUsage where the two have different sides; the paths are for the message.
Status CheckSameSize(const std::string& path, const Film& film, const std::string& reference_path,
                     const Film& reference);

}  // namespace sheaf

#endif  // SHEAF_APP_DISPLAY_PICTURE_H_
