// What a page reads: scene JSON, without images. The libraries that read more are not there.
#include "src/formats/format_table.h"
#include "src/formats/image.h"
#include "src/formats/scene_json.h"

namespace sheaf {

const std::vector<FormatRow>& FormatTable() {
  static const std::vector<FormatRow> kTable = {
      {.format = {.name = "scene JSON", .endings = {".json"}, .content = FileContent::kScene},
       .parse = &ParseSceneJson,
       .max_bytes = kMaxTextBytes}};
  return kTable;
}

Result<Image> DecodeImage(std::string_view) {
  return Error{ErrorKind::kInputOutput, "this build reads no images"};
}

Result<std::shared_ptr<const Image>> ImageCache::Load(const std::string&, const std::string&,
                                                      SceneFiles&) {
  return Error{ErrorKind::kInputOutput, "this build reads no images"};
}

}  // namespace sheaf
