#include "src/formats/decoded_images.h"

#include <utility>

#include "src/core/checksum.h"
#include "src/formats/image.h"

namespace sheaf {

Result<std::shared_ptr<const Image>> DecodedImages::Decode(std::string_view bytes,
                                                           const std::string& name) {
  Checksum checksum;
  checksum.Add(bytes.data(), bytes.size());
  const Key key = {checksum.value(), bytes.size(), name};
  if (const auto known = images_.find(key); known != images_.end()) return known->second;
  Result<Image> decoded = DecodeImage(bytes);
  if (!decoded) return decoded.error();
  decoded.value().name = name;
  return images_[key] = std::make_shared<const Image>(std::move(decoded).value());
}

}  // namespace sheaf
