// `sheaf render`: a scene becomes pictures.
#ifndef SHEAF_APP_RENDER_COMMAND_H_
#define SHEAF_APP_RENDER_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command RenderCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_RENDER_COMMAND_H_
