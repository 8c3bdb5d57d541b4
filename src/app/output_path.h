// The path of an output, with fields for what a picture shows.
#ifndef SHEAF_APP_OUTPUT_PATH_H_
#define SHEAF_APP_OUTPUT_PATH_H_

#include <optional>
#include <string>
#include <string_view>

#include "sheaf/error.h"

namespace sheaf {

// The path that `-o -` stands for.
inline constexpr std::string_view kStandardOutputPath = "/dev/stdout";

// Whether the picture's format is known, by the path's ending or by the name of --format, and
// standard output, where that is the path, no terminal. kUsage otherwise.
Status CheckPictureOutput(const std::string& output, const std::string& format);

// The fields: {camera} becomes the camera's name, {frame} the number of the frame, {frame:4} the
// number with zeros before it, at least four characters in all.
inline constexpr std::string_view kCameraField = "{camera}";
inline constexpr std::string_view kFrameField = "{frame}";

bool HasCameraField(std::string_view path);
bool HasFrameField(std::string_view path);

// The part of the path before its first field, up to a slash: all of the path's folder where that
// has none. Empty or ending in '/'.
std::string FixedFolder(const std::string& path);

// The path of the journal of a sequence with this output, hidden in the fixed folder.
std::string SequenceJournalPath(const std::string& output);

// Fills the fields. kUsage where the camera's name would lead into another folder, or a field has a
// width that is none; `frame` is there where the path has a field for it.
Result<std::string> ExpandPath(const std::string& output, const std::string& camera,
                               std::optional<int> frame = std::nullopt);

}  // namespace sheaf

#endif  // SHEAF_APP_OUTPUT_PATH_H_
