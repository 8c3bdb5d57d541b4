// How light becomes what a display shows, before the transfer: exposure and tone curve. The same
// bits on every machine: + - * / and sqrt alone.
#ifndef SHEAF_SCENE_DEVELOP_H_
#define SHEAF_SCENE_DEVELOP_H_

#include "sheaf/film.h"
#include "sheaf/scene.h"

namespace sheaf {

// 2^ev, within some ULP; exact where ev is whole.
double ExposureFactor(double ev);

// Multiplies the film's colours by 2^ev, then bends them.
void Develop(double ev, Tone tone, Film& film);

}  // namespace sheaf

#endif  // SHEAF_SCENE_DEVELOP_H_
