// Images that were decoded before.
#ifndef SHEAF_FORMATS_DECODED_IMAGES_H_
#define SHEAF_FORMATS_DECODED_IMAGES_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>

#include "sheaf/error.h"
#include "sheaf/scene.h"

namespace sheaf {

// Images by their bytes and names, so that who reads a scene again, at another moment, decodes none
// of them twice. One thread at a time uses it.
class DecodedImages {
 public:
  // As DecodeImage. What fails is not kept.
  Result<std::shared_ptr<const Image>> Decode(std::string_view bytes, const std::string& name);

 private:
  using Key = std::tuple<std::uint64_t, std::size_t, std::string>;  // checksum, size, name
  std::map<Key, std::shared_ptr<const Image>> images_;
};

}  // namespace sheaf

#endif  // SHEAF_FORMATS_DECODED_IMAGES_H_
