// Pictures that were read, and are written again.
#ifndef SHEAF_APP_PICTURE_AS_READ_H_
#define SHEAF_APP_PICTURE_AS_READ_H_

#include <optional>
#include <string>

#include "sheaf/formats.h"
#include "src/app/choose_look.h"

namespace sheaf {

// Whether -o, --format, --exposure, --tone and --bits fit together; kUsage where they do not.
Status CheckWritten(const std::string& output, const std::string& format, const LookOptions& look,
                    std::optional<int> bits);

// The spec of the picture, not yet decoded, in a file of `named`: its place and metadata, and as
// many bits a channel as it had where both hold bytes or both floats. `bits` are those of --bits,
// `transfer` is the word of --transfer, if any.
PictureSpec SpecAsRead(const ReadPictureResult& picture, const std::string& named,
                       std::optional<int> bits, const std::string& transfer);

}  // namespace sheaf

#endif  // SHEAF_APP_PICTURE_AS_READ_H_
