// What a frame's options ask for, with the scene's own settings where they ask for nothing.
#ifndef SHEAF_RENDER_CHECK_OPTIONS_H_
#define SHEAF_RENDER_CHECK_OPTIONS_H_

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace sheaf {

// Nothing is kFromScene in what it returns. Fails with kUsage where an option is out of range.
Result<RenderOptions> CheckOptions(const RenderOptions& options, const Settings& settings);

}  // namespace sheaf

#endif  // SHEAF_RENDER_CHECK_OPTIONS_H_
