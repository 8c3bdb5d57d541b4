// src/formats/image_module.h by OpenImageIO; compiled into a library of its own.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <exception>
#include <string>

#include "src/formats/image_module.h"

namespace {

bool Decode(OIIO::ImageInput& input, int largest_side, sheaf::ModuleImage& image) {
  const OIIO::ImageSpec& spec = input.spec();
  const bool fits =
      std::min(spec.width, spec.height) >= 1 && std::max(spec.width, spec.height) <= largest_side;
  if (!fits || spec.depth > 1 || spec.nchannels < 1 || spec.nchannels > 64) {
    image.error = "an image of " + std::to_string(spec.width) + "x" + std::to_string(spec.height) +
                  " with " + std::to_string(spec.nchannels) + " channels; sides may be 1 to " +
                  std::to_string(largest_side);
    return false;
  }
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.nchannels;
  image.alpha = spec.alpha_channel;
  image.numbers.resize(static_cast<std::size_t>(spec.width) *
                       static_cast<std::size_t>(spec.height) *
                       static_cast<std::size_t>(spec.nchannels));
  if (input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.numbers.data())) {
    return true;
  }
  image.error = input.geterror();
  return false;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) bool SheafDecodeImage(const char* bytes,
                                                                        std::size_t size,
                                                                        const char* ending,
                                                                        int largest_side,
                                                                        sheaf::ModuleImage& image) {
  try {
    OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes), size);
    OIIO::ImageSpec config, spec;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::create(ending);
    if (input && input->set_ioproxy(&memory) &&
        input->open(std::string("image.") + ending, spec, config)) {
      return Decode(*input, largest_side, image);
    }
    image.error = input ? input->geterror() : OIIO::geterror();
  } catch (const std::exception& thrown) {
    image.error = thrown.what();
  }
  return false;
}
