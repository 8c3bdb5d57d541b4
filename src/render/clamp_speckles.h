// Single pixels that chance made far too bright.
#ifndef SHEAF_RENDER_CLAMP_SPECKLES_H_
#define SHEAF_RENDER_CLAMP_SPECKLES_H_

#include "sheaf/film.h"
#include "src/render/noisy_picture.h"

namespace sheaf {

// Where the picture is noisy no channel of a pixel stays a deviation above the brightest of the
// eight pixels around, in light and in colour: one that does is a rare path's light, which no mean
// of its neighbours would spread. Where it is not, such a pixel is a highlight. Writes the colours
// into `clamped`, but for the margin.
void ClampSpeckles(const Film& film, const NoisyPicture& picture, int threads,
                   NoisyPlane (&clamped)[3]);

}  // namespace sheaf

#endif  // SHEAF_RENDER_CLAMP_SPECKLES_H_
