// Intel's Open Image Denoise, where Sheaf was built with it.
#ifndef SHEAF_RENDER_OIDN_FILTER_H_
#define SHEAF_RENDER_OIDN_FILTER_H_

#include "sheaf/error.h"
#include "sheaf/film.h"

namespace sheaf {

// The film by its filter "RT" on the processor, with albedo and normals where the film has them; 0
// threads: as many as it likes. Pixels that are not finite keep their numbers. kUsage without the
// library, and with its message where it fails.
Result<Film> DenoiseByOidn(const Film& film, int threads);

}  // namespace sheaf

#endif  // SHEAF_RENDER_OIDN_FILTER_H_
