// The calls of src/web/page.html: one scene, its cameras, and pictures of them.
#include <emscripten.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "sheaf/formats.h"
#include "sheaf/render.h"
#include "src/core/checksum.h"
#include "src/formats/quantize.h"

namespace {

struct Page {
  sheaf::Scene scene;
  sheaf::Film film;
  std::vector<std::uint8_t> shown;  // red, green, blue, opaque
  std::string text;                 // the last that was returned
};

Page& ThePage() {
  static Page page;
  return page;
}

const char* Keep(std::string text) {
  ThePage().text = std::move(text);
  return ThePage().text.c_str();
}

// The camera, turned about the point that it looks at by `degrees`, around y.
sheaf::Camera Turned(sheaf::Camera camera, double degrees) {
  if (degrees == 0) return camera;
  const double angle = degrees * 3.14159265358979323846 / 180;
  const auto from = camera.eye - camera.look_at;
  camera.eye.x = camera.look_at.x + std::cos(angle) * from.x + std::sin(angle) * from.z;
  camera.eye.z = camera.look_at.z - std::sin(angle) * from.x + std::cos(angle) * from.z;
  return camera;
}

void Show(Page& page) {
  const auto levels = sheaf::QuantizeTo8Bit(page.film, page.scene.settings.transfer);
  page.shown.assign(4 * page.film.pixel_count(), 255);
  for (std::size_t i = 0; i < page.film.pixel_count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) page.shown[4 * i + k] = levels[3 * i + k];
  }
}

}  // namespace

extern "C" {

// Reads the scene. Returns an error's message, or an empty text.
EMSCRIPTEN_KEEPALIVE const char* ReadPageScene(const char* json) {
  auto read = sheaf::ParseSceneJson(json, "scene.json");
  if (!read) return Keep(read.error().message);
  ThePage().scene = std::move(read.value());
  return Keep("");
}

EMSCRIPTEN_KEEPALIVE int CountCameras() { return static_cast<int>(ThePage().scene.cameras.size()); }

EMSCRIPTEN_KEEPALIVE const char* CameraName(int camera) {
  return ThePage().scene.cameras[static_cast<std::size_t>(camera)].name.c_str();
}

// "emu128" or the like: what the kernels were compiled for.
EMSCRIPTEN_KEEPALIVE const char* BestTarget() { return Keep(sheaf::Target().name()); }

// The pixels of a picture by the target of this name, 4 bytes each; null where it failed. They last
// until the next call.
EMSCRIPTEN_KEEPALIVE const std::uint8_t* RenderPage(int camera, double degrees, int width,
                                                    int height, const char* target) {
  Page& page = ThePage();
  sheaf::RenderOptions options;
  options.width = width;
  options.height = height;
  options.target = sheaf::Target::Named(target).value_or(sheaf::Target());
  options.band_rows = height;  // one band: nobody takes it while another renders
  const auto& chosen = page.scene.cameras[static_cast<std::size_t>(camera)];
  auto film = sheaf::Render(page.scene, Turned(chosen, degrees), options);
  if (!film) {
    std::fprintf(stderr, "%s\n", film.error().message.c_str());
    return nullptr;
  }
  page.film = std::move(film.value());
  Show(page);
  return page.shown.data();
}

// Over the bits of the last picture's light: 16 hexadecimal digits.
EMSCRIPTEN_KEEPALIVE const char* PictureChecksum() {
  sheaf::Checksum checksum;
  const auto& rgb = ThePage().film.rgb;
  checksum.Add(rgb.data(), rgb.size() * sizeof(rgb[0]));
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(checksum.value()));
  return Keep(text);
}

}  // extern "C"
