// The table of formats: the only place that lists them.
#ifndef SHEAF_FORMATS_FORMAT_TABLE_H_
#define SHEAF_FORMATS_FORMAT_TABLE_H_

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/formats.h"
#include "src/formats/picture_encoder.h"
#include "src/formats/read_file.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// `text` is all that the file `path` holds.
using SceneParser = Result<Scene>(std::string_view text, const std::string& path,
                                  SceneFiles& files);
using PictureReader = Result<ReadPictureResult>(const std::string& path);
using EncoderFactory = NewEncoder(const std::string& path, const PictureSpec& spec);

struct FormatRow {
  FileFormat format;
  SceneParser* parse = nullptr;  // of scenes and models
  std::size_t max_bytes = kMaxModelBytes;
  // How pictures of a model are encoded, since its file does not say.
  Transfer model_transfer = Transfer::kSrgb;
  PictureReader* read_picture = nullptr;  // of pictures, as is the next
  EncoderFactory* create_encoder = nullptr;
};

const std::vector<FormatRow>& FormatTable();

// The row of the path's ending; null for an unknown one.
const FormatRow* FindFormat(std::string_view path);

// The endings of these formats, for messages: ".png, .pfm or .exr".
std::string EndingsText(const std::function<bool(const FileFormat&)>& belongs);
std::string SceneEndings();  // of scenes and models
std::string PictureEndings();

// The bits a channel of pictures, for messages: ".png 8 or 16, .pfm 32, .exr 16 or 32".
std::string BitsText();

}  // namespace sheaf

#endif  // SHEAF_FORMATS_FORMAT_TABLE_H_
