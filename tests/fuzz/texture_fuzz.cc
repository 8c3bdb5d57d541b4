// An image as textures are: PNG, JPEG, and what else is told by its first bytes.
#include <cstdint>
#include <string_view>

#include "src/formats/image.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto image = sheaf::DecodeImage({reinterpret_cast<const char*>(data), size});
  if (!image) {
    if (image.error().message.empty()) sheaf::fuzz::Fail("an error without a message");
    return 0;
  }
  const auto pixels = static_cast<std::size_t>(image.value().width) *
                      static_cast<std::size_t>(image.value().height);
  if (pixels == 0 || image.value().texels.size() != pixels) sheaf::fuzz::Fail("sides and texels");
  return 0;
}
