// What a frame's options ask for, with the scene's own settings where they ask for nothing.
#ifndef SHEAF_RENDER_CHECK_OPTIONS_H_
#define SHEAF_RENDER_CHECK_OPTIONS_H_

#include "sheaf/error.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"

namespace sheaf {

// Nothing is kFromScene in what it returns. Fails with kUsage where an option is out of range.
Result<RenderOptions> CheckOptions(const RenderOptions& options, const Settings& settings);

// The pixels of a frame whose options are checked: its crop, or all.
inline PixelRect AreaOf(const RenderOptions& options) {
  return options.crop.value_or(PixelRect{0, 0, options.width, options.height});
}

}  // namespace sheaf

#endif  // SHEAF_RENDER_CHECK_OPTIONS_H_
