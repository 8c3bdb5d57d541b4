// Images for textures: PNG by libpng, JPEG by libjpeg-turbo, others by OpenImageIO where it is
// built in.
#ifndef SHEAF_FORMATS_IMAGE_H_
#define SHEAF_FORMATS_IMAGE_H_

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "sheaf/error.h"
#include "sheaf/scene.h"
#include "src/formats/scene_files.h"

namespace sheaf {

// What the bytes of a picture show, in 8 bits. The error's message names no file; it refuses
// sides above kMaxTextureSide and pictures with more pixels than their bytes can hold.
Result<Image> DecodeImage(std::string_view bytes);

// Images by path, each read once.
class ImageCache {
 public:
  // The image that the file `from` names; an error without a place.
  Result<std::shared_ptr<const Image>> Load(const std::string& from, const std::string& reference,
                                            SceneFiles& files);

 private:
  std::map<std::string, std::shared_ptr<const Image>> images_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_IMAGE_H_
