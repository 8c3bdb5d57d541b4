// `sheaf denoise`: a picture with less noise, guided by its layers.
#ifndef SHEAF_APP_DENOISE_COMMAND_H_
#define SHEAF_APP_DENOISE_COMMAND_H_

#include "src/app/command.h"

namespace sheaf {

Command DenoiseCommand();

}  // namespace sheaf

#endif  // SHEAF_APP_DENOISE_COMMAND_H_
