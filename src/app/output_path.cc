#include "src/app/output_path.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>

#include "sheaf/formats.h"
#include "src/app/area_journal.h"
#include "src/app/choose.h"
#include "src/app/parse_options.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

constexpr std::string_view kFrameStart = "{frame";  // "}" or ":4}" follows

// Where the next field for frames starts; npos where there is none.
std::size_t FindFrameField(std::string_view path, std::size_t from = 0) {
  for (std::size_t at = path.find(kFrameStart, from); at != std::string_view::npos;
       at = path.find(kFrameStart, at + 1)) {
    const std::string_view rest = path.substr(at + kFrameStart.size());
    if (rest.starts_with('}') || rest.starts_with(':')) return at;
  }
  return std::string_view::npos;
}

}  // namespace

Status CheckPictureOutput(const std::string& output, const std::string& format) {
  const bool is_stdout = output == kStandardOutputPath;
  if (const Status known = CheckPicturePath(FormatPath(output, format)); !known) {
    if (!is_stdout) return known;
    return Usage(
        fmt::format("-o {}: needs --format, because its name does not tell the format", output));
  }
  if (is_stdout && isatty(STDOUT_FILENO) != 0) {
    return Usage(fmt::format("-o {}: a terminal shows no pictures", output));
  }
  return Done{};
}

bool HasCameraField(std::string_view path) {
  return path.find(kCameraField) != std::string_view::npos;
}

bool HasFrameField(std::string_view path) { return FindFrameField(path) != std::string_view::npos; }

std::string FixedFolder(const std::string& path) {
  const std::size_t field = std::min(path.find(kCameraField), FindFrameField(path));
  return path.substr(0, path.substr(0, field).rfind('/') + 1);
}

std::string SequenceJournalPath(const std::string& output) {
  const std::string folder = FixedFolder(output);
  std::string name = output.substr(folder.size());
  std::replace(name.begin(), name.end(), '/', '_');
  return JournalPath(folder + name);
}

Result<std::string> ExpandPath(const std::string& output, const std::string& camera,
                               std::optional<int> frame) {
  std::string path;
  for (std::size_t at = 0; at < output.size();) {
    const std::size_t next_camera = output.find(kCameraField, at);
    const std::size_t next_frame = FindFrameField(output, at);
    const std::size_t field = std::min(next_camera, next_frame);
    path += output.substr(at, field - at);
    if (field == std::string::npos) break;
    if (field == next_camera) {
      const bool is_plain = std::none_of(camera.begin(), camera.end(), [](char c) {
        return c == '/' || (static_cast<unsigned char>(c) < 0x20);
      });
      if (!is_plain || camera.empty()) {
        return Usage(fmt::format("-o {}: the camera \"{}\" has no name for a file", output,
                                 Printable(camera)));
      }
      path += camera;
      at = field + kCameraField.size();
      continue;
    }
    assert(frame);
    const std::size_t end = output.find('}', field);
    const std::string_view text = std::string_view(output).substr(field, end - field + 1);
    int width = 1;
    if (text != kFrameField) {
      const std::size_t digits = kFrameStart.size() + 1;
      const auto given = end == std::string::npos
                             ? std::nullopt
                             : ParseInteger(text.substr(digits, text.size() - digits - 1), 1, 9);
      if (!given) {
        return Usage(fmt::format("-o {}: {} needs a width of 1 to 9, as {{frame:4}} has it",
                                 Printable(output), Printable(std::string(text))));
      }
      width = *given;
    }
    path += fmt::format("{:0{}}", *frame, width);
    at = end + 1;
  }
  return path;
}

}  // namespace sheaf
