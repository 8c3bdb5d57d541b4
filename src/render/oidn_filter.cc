#include "src/render/oidn_filter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#ifdef SHEAF_HAS_OIDN
#include <OpenImageDenoise/oidn.hpp>
#endif

namespace sheaf {

#ifdef SHEAF_HAS_OIDN

Result<Film> DenoiseByOidn(const Film& film, int threads) {
  oidn::DeviceRef device = oidn::newDevice(oidn::DeviceType::CPU);
  if (threads > 0) device.set("numThreads", threads);
  device.commit();
  Film denoised = film;
  oidn::FilterRef filter = device.newFilter("RT");
  const auto set = [&](const char* name, const Film::Floats& image) {
    filter.setImage(name, const_cast<float*>(image.data()), oidn::Format::Float3,
                    static_cast<std::size_t>(film.width), static_cast<std::size_t>(film.height));
  };
  set("color", film.rgb);
  set("output", denoised.rgb);
  if (film.has(Layer::kAlbedo)) {
    set("albedo", film.layers[static_cast<int>(Layer::kAlbedo)]);
    if (film.has(Layer::kNormal)) set("normal", film.layers[static_cast<int>(Layer::kNormal)]);
  }
  filter.set("hdr", true);
  filter.commit();
  filter.execute();
  const char* message = nullptr;
  if (device.getError(message) != oidn::Error::None) {
    return Error{ErrorKind::kUsage, std::string("Open Image Denoise: ") + message};
  }
  for (std::size_t i = 0; i < film.rgb.size(); i += 3) {
    const float* const from = &film.rgb[i];
    const auto is_finite = [](float number) { return std::isfinite(number); };
    if (!std::all_of(from, from + 3, is_finite)) std::copy_n(from, 3, &denoised.rgb[i]);
  }
  return denoised;
}

#else

Result<Film> DenoiseByOidn(const Film& /*film*/, int /*threads*/) {
  return Error{ErrorKind::kUsage, "this build has no Open Image Denoise"};
}

#endif

}  // namespace sheaf
