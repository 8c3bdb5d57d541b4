// Everything that the library offers.
#ifndef SHEAF_SHEAF_SHEAF_H_
#define SHEAF_SHEAF_SHEAF_H_

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/formats.h"
#include "sheaf/geometry.h"
#include "sheaf/instances.h"
#include "sheaf/queries.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "sheaf/stats.h"
#include "sheaf/target.h"
#include "sheaf/version.h"

#endif  // SHEAF_SHEAF_SHEAF_H_
