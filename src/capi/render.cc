// Scenes, frames and pictures of <sheaf/capi.h>.
#include <string_view>

#include "src/capi/handles.h"
#include "src/formats/picture.h"
#include "src/scene/projection.h"

namespace sheaf::capi {
namespace {

// ---- Scenes ----

Result<ReadSceneResult> Read(const char* path, const sheaf_read_options* given) {
  if (path == nullptr) return UsageError("path is NULL");
  sheaf_read_options options = SHEAF_READ_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  ReadOptions read;
  if (options.allow_outside != 0) read.outside = Outside::kAllowed;
  if (!(options.aspect >= 0)) return UsageError("options: aspect is below 0");
  if (options.aspect > 0) read.aspect = options.aspect;
  if (options.time >= 0) read.time = options.time;
  return ReadScene(path, read);
}

Result<ReadSceneResult> Parse(const char* text, std::size_t length, const char* name) {
  if (text == nullptr && length > 0) return UsageError("text is NULL");
  if (name == nullptr) return UsageError("name is NULL");
  Result<Scene> scene = ParseSceneJson(std::string_view(text, length), name);
  if (!scene) return scene.error();
  ReadSceneResult read;
  read.scene = std::move(scene).value();
  return read;
}

Result<Camera> SceneCamera(const sheaf_scene* scene, std::size_t index) {
  if (scene == nullptr) return UsageError("scene is NULL");
  const std::vector<Camera>& cameras = scene->read.scene.cameras;
  if (index >= cameras.size()) {
    return UsageError("camera " + std::to_string(index) + " of " + std::to_string(cameras.size()));
  }
  return cameras[index];
}

Status GetCamera(const sheaf_scene* scene, std::size_t index, sheaf_camera* given) {
  const Result<Camera> camera = SceneCamera(scene, index);
  if (!camera) return camera.error();
  sheaf_camera own = SHEAF_CAMERA_INIT;
  for (int i = 0; i < 3; ++i) {
    own.eye[i] = camera.value().eye[i];
    own.look_at[i] = camera.value().look_at[i];
    own.up[i] = camera.value().up[i];
  }
  own.projection = static_cast<sheaf_projection>(camera.value().projection.index());
  own.lens = ParameterOf(camera.value().projection);
  if (const std::optional<Lens>& lens = camera.value().lens) {
    own.aperture = lens->aperture;
    own.focus = lens->focus.value_or(0);
    own.blades = lens->blades;
    own.rotation = lens->rotation;
  }
  return Put(own, "camera", given);
}

// What the numbers have to be is Render's to check.
Result<Camera> CameraOf(const sheaf_camera& given) {
  sheaf_camera view = SHEAF_CAMERA_INIT;
  if (const Status taken = Take(&given, "view", &view); !taken) return taken.error();
  const std::size_t kind = NumberIn(view.projection);
  if (kind >= std::size(kProjectionKinds)) return UsageError("view: projection is none of them");
  Camera camera;
  for (int i = 0; i < 3; ++i) {
    camera.eye[i] = view.eye[i];
    camera.look_at[i] = view.look_at[i];
    camera.up[i] = view.up[i];
  }
  camera.projection = *ProjectionNamed(kProjectionKinds[kind].name);
  SetParameter(camera.projection, view.lens);
  if (view.aperture != 0) {
    Lens lens{view.aperture, std::nullopt, view.blades, view.rotation};
    if (view.focus != 0) lens.focus = view.focus;
    camera.lens = lens;
  }
  return camera;
}

// ---- Frames ----

// 0 stands for the scene's.
sheaf_integrator IntegratorOf(Integrator integrator) {
  return static_cast<sheaf_integrator>(static_cast<int>(integrator) + 1);
}

Result<RenderOptions> OptionsOf(const sheaf_render_options& given) {
  RenderOptions options;
  // Nothing is 0 pixels wide: 0 is what a caller leaves alone.
  if (given.width != 0) options.width = given.width;
  if (given.height != 0) options.height = given.height;
  if (given.samples != 0) options.samples = given.samples;
  options.max_depth = given.max_depth;
  options.threads = given.threads;
  const auto& crop = given.crop;
  if (std::any_of(crop, crop + 4, [](std::int32_t side) { return side != 0; })) {
    options.crop = PixelRect{crop[0], crop[1], crop[2], crop[3]};
  }
  if (NumberIn(given.precision) >= std::size(kPrecisions)) {
    return UsageError("options: precision is none of sheaf_precision");
  }
  options.precision = kPrecisions[given.precision];
  if (NumberIn(given.integrator) > std::size(kIntegrators)) {
    return UsageError("options: integrator is none of sheaf_integrator");
  }
  if (given.integrator != SHEAF_SCENE_INTEGRATOR) {
    options.integrator = kIntegrators[given.integrator - 1];
  }
  if (given.error != 0) options.error = given.error;
  if (given.budget != 0) options.budget = given.budget;
  const Result<Layers> layers = LayersOf(given.layers);
  if (!layers) return layers.error();
  options.layers = layers.value();
  const Result<Target> target = TargetOf(given.target);
  if (!target) return target.error();
  options.target = target.value();
  return options;
}

Status PutStatistics(const RenderStats& stats, sheaf_render_statistics* given) {
  if (given == nullptr) return Done{};
  sheaf_render_statistics own = SHEAF_RENDER_STATISTICS_INIT;
  own.primary_rays = stats.rays.primary;
  own.shadow_rays = stats.rays.shadow;
  own.reflected_rays = stats.rays.reflected;
  own.refracted_rays = stats.rays.refracted;
  own.traced_rays = stats.rays.traced();
  own.build_seconds = stats.compile_seconds;
  own.render_seconds = stats.wall_seconds;
  own.buffer_bytes = stats.buffer_bytes;
  own.threads = stats.threads;
  own.rounds = stats.reached.rounds;
  own.error = stats.reached.error;
  own.samples = stats.reached.samples;
  return Put(own, "statistics", given);
}

Result<Film> RenderFrame(const sheaf_scene* scene, const sheaf_render_options* given,
                         sheaf_render_statistics* statistics) {
  if (scene == nullptr) return UsageError("scene is NULL");
  sheaf_render_options own = SHEAF_RENDER_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &own); !taken) return taken.error();
  const Result<RenderOptions> options = OptionsOf(own);
  if (!options) return options.error();
  const Result<Camera> camera =
      own.view != nullptr ? CameraOf(*own.view) : SceneCamera(scene, own.camera);
  if (!camera) return camera.error();
  RenderStats stats;
  Result<Film> film =
      scene->renderer.Render(camera.value(), options.value(), &stats,
                             own.progress == nullptr ? nullptr : &own.progress->progress);
  if (!film) return film;
  if (const Status put = PutStatistics(stats, statistics); !put) return put.error();
  return film;
}

// ---- Pictures ----

Result<Film> CopyPixels(std::int32_t width, std::int32_t height, const float* rgb,
                        std::size_t row_stride) {
  if (width < 1 || width > kMaxImageSide || height < 1 || height > kMaxImageSide) {
    return UsageError("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                      " pixels");
  }
  if (rgb == nullptr) return UsageError("rgb is NULL");
  if (row_stride % sizeof(float) != 0) return UsageError("row_stride is no multiple of four");
  Film film(width, height);
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  const std::size_t step = row_stride == 0 ? row : row_stride / sizeof(float);
  for (int y = 0; y < height; ++y) {
    std::copy_n(rgb + static_cast<std::size_t>(y) * step, row, film.pixel(0, y));
  }
  return film;
}

Result<Film> ReadLinear(const char* path) {
  if (path == nullptr) return UsageError("path is NULL");
  Result<ReadPictureResult> read = ReadPicture(path);
  if (!read) return read.error();
  DecodeLight(read.value());
  return std::move(read.value().film);
}

Status Write(const sheaf_film* film, const char* path, const sheaf_picture_options* given) {
  if (film == nullptr) return UsageError("film is NULL");
  if (path == nullptr) return UsageError("path is NULL");
  sheaf_picture_options options = SHEAF_PICTURE_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  if (!(options.ev >= -kMaxEv && options.ev <= kMaxEv)) return UsageError("options: ev");
  const Result<Layers> layers = LayersOf(options.layers);
  if (!layers) return layers.error();
  for (int i = 0; i < kLayerCount; ++i) {
    const auto layer = static_cast<Layer>(i);
    if (layers.value().has(layer) && !film->film.has(layer)) {
      return UsageError(std::string("the film has no layer ") + LayerName(layer));
    }
  }
  PictureSpec spec = WholePicture(film->film.width, film->film.height,
                                  options.linear != 0 ? Transfer::kLinear : Transfer::kSrgb);
  spec.ev = options.ev;
  spec.tone = options.filmic != 0 ? Tone::kFilmic : Tone::kLinear;
  spec.bits = options.bits;
  spec.layers = layers.value();
  return WritePicture(film->film, spec, path);
}

static_assert(SHEAF_WHITTED == static_cast<int>(Integrator::kWhitted) + 1);
static_assert(SHEAF_PATH == static_cast<int>(Integrator::kPath) + 1);
static_assert(SHEAF_DOUBLE == static_cast<int>(Precision::kDouble));
static_assert(SHEAF_HEAT == 1 << static_cast<int>(Layer::kHeat));
static_assert(SHEAF_FISHEYE == std::variant_size_v<Projection> - 1);

}  // namespace
}  // namespace sheaf::capi

using namespace sheaf::capi;  // NOLINT: the C functions below stand outside of it
using sheaf::Done;
using sheaf::Status;

sheaf_status sheaf_scene_read(const char* path, const sheaf_read_options* options,
                              sheaf_scene** scene) {
  return Make(scene, "scene is NULL", [&] { return Read(path, options); });
}

sheaf_status sheaf_scene_parse(const char* text, size_t length, const char* name,
                               sheaf_scene** scene) {
  return Make(scene, "scene is NULL", [&] { return Parse(text, length, name); });
}

void sheaf_scene_destroy(sheaf_scene* scene) { delete scene; }

size_t sheaf_scene_warning_count(const sheaf_scene* scene) {
  return scene == nullptr ? 0 : scene->read.warnings.size();
}

const char* sheaf_scene_warning(const sheaf_scene* scene, size_t index) {
  return index < sheaf_scene_warning_count(scene) ? scene->read.warnings[index].c_str() : nullptr;
}

sheaf_status sheaf_scene_get_settings(const sheaf_scene* scene, sheaf_settings* settings) {
  return Guarded([&]() -> Status {
    if (scene == nullptr) return UsageError("scene is NULL");
    const sheaf::Settings& from = scene->read.scene.settings;
    sheaf_settings own = SHEAF_SETTINGS_INIT;
    own.width = from.width;
    own.height = from.height;
    own.samples = from.samples;
    own.max_depth = from.max_depth;
    own.integrator = IntegratorOf(from.integrator);
    return Put(own, "settings", settings);
  });
}

size_t sheaf_scene_camera_count(const sheaf_scene* scene) {
  return scene == nullptr ? 0 : scene->read.scene.cameras.size();
}

const char* sheaf_scene_camera_name(const sheaf_scene* scene, size_t index) {
  if (index >= sheaf_scene_camera_count(scene)) return nullptr;
  return scene->read.scene.cameras[index].name.c_str();
}

sheaf_status sheaf_scene_get_camera(const sheaf_scene* scene, size_t index, sheaf_camera* camera) {
  return Guarded([&] { return GetCamera(scene, index, camera); });
}

sheaf_status sheaf_progress_create(sheaf_progress** progress) {
  return Guarded([&]() -> Status {
    if (progress == nullptr) return UsageError("progress is NULL");
    *progress = nullptr;
    *progress = new sheaf_progress;
    return Done{};
  });
}

void sheaf_progress_destroy(sheaf_progress* progress) { delete progress; }

uint64_t sheaf_progress_pixels_done(const sheaf_progress* progress) {
  return progress == nullptr ? 0 : progress->progress.pixels_done.load();
}

void sheaf_progress_stop(sheaf_progress* progress) {
  if (progress != nullptr) progress->progress.stop = true;
}

sheaf_status sheaf_render(const sheaf_scene* scene, const sheaf_render_options* options,
                          sheaf_render_statistics* statistics, sheaf_film** film) {
  return Make(film, "film is NULL", [&] { return RenderFrame(scene, options, statistics); });
}

sheaf_status sheaf_film_create(int32_t width, int32_t height, const float* rgb, size_t row_stride,
                               sheaf_film** film) {
  return Make(film, "film is NULL", [&] { return CopyPixels(width, height, rgb, row_stride); });
}

sheaf_status sheaf_film_read(const char* path, sheaf_film** film) {
  return Make(film, "film is NULL", [&] { return ReadLinear(path); });
}

void sheaf_film_destroy(sheaf_film* film) { delete film; }

int32_t sheaf_film_width(const sheaf_film* film) { return film == nullptr ? 0 : film->film.width; }

int32_t sheaf_film_height(const sheaf_film* film) {
  return film == nullptr ? 0 : film->film.height;
}

const float* sheaf_film_rgb(const sheaf_film* film) {
  return film == nullptr ? nullptr : film->film.rgb.data();
}

const float* sheaf_film_layer(const sheaf_film* film, sheaf_layer layer) {
  if (film == nullptr) return nullptr;
  for (int i = 0; i < sheaf::kLayerCount; ++i) {
    if (sheaf::capi::NumberIn(layer) == 1u << i && film->film.has(static_cast<sheaf::Layer>(i))) {
      return film->film.layers[i].data();
    }
  }
  return nullptr;
}

sheaf_status sheaf_film_write(const sheaf_film* film, const char* path,
                              const sheaf_picture_options* options) {
  return Guarded([&] { return Write(film, path, options); });
}
