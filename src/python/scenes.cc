// Scenes, frames and pictures, by the C interface.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include "sheaf/capi.h"
#include "sheaf/film.h"
#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/python/bindings.h"
#include "src/python/errors.h"

namespace sheaf::python {
namespace {

namespace py = pybind11;

struct Destroy {
  void operator()(sheaf_scene* scene) const { sheaf_scene_destroy(scene); }
  void operator()(sheaf_film* film) const { sheaf_film_destroy(film); }
  void operator()(sheaf_progress* progress) const { sheaf_progress_destroy(progress); }
};
template <typename Handle>
using Owned = std::unique_ptr<Handle, Destroy>;

// Takes an option out of a dictionary, where it is there and not None.
template <typename T>
void TakeOption(const py::dict& options, const char* name, T* value) {
  if (!options.contains(name)) return;
  const py::object given = options[name];
  if (given.is_none()) return;
  try {
    *value = given.cast<T>();
  } catch (const py::cast_error&) {
    Raise(SHEAF_USAGE, std::string(name) + ": " + py::repr(given).cast<std::string>() +
                           " is of the wrong type or out of range");
  }
}

// Raises what a call on another thread or without the lock has failed with.
struct Outcome {
  sheaf_status status = SHEAF_OK;
  std::string message;
  static Outcome Of(sheaf_status status) {
    return {status, status == SHEAF_OK ? "" : sheaf_error_message()};
  }
  void Check() const {
    if (status != SHEAF_OK) Raise(status, message);
  }
};

template <typename Call>
void RunUnlocked(Call&& call) {
  const Outcome outcome = [&] {
    const py::gil_scoped_release release;
    return Outcome::Of(call());
  }();
  outcome.Check();
}

// ---- Scenes ----

struct Scene {
  Owned<sheaf_scene> handle;
};

Scene ReadFile(const std::string& path, const py::dict& given) {
  sheaf_read_options options = SHEAF_READ_OPTIONS_INIT;
  bool outside = false;
  TakeOption(given, "allow_outside", &outside);
  TakeOption(given, "aspect", &options.aspect);
  TakeOption(given, "time", &options.time);
  options.allow_outside = outside ? 1 : 0;
  sheaf_scene* scene = nullptr;
  RunUnlocked([&] { return sheaf_scene_read(path.c_str(), &options, &scene); });
  return {Owned<sheaf_scene>(scene)};
}

Scene ParseText(const std::string& text, const std::string& name) {
  sheaf_scene* scene = nullptr;
  RunUnlocked([&] { return sheaf_scene_parse(text.data(), text.size(), name.c_str(), &scene); });
  return {Owned<sheaf_scene>(scene)};
}

py::list WarningsOf(const Scene& scene) {
  py::list lines;
  for (std::size_t i = 0; i < sheaf_scene_warning_count(scene.handle.get()); ++i) {
    lines.append(sheaf_scene_warning(scene.handle.get(), i));
  }
  return lines;
}

py::dict SettingsOf(const Scene& scene) {
  sheaf_settings settings = SHEAF_SETTINGS_INIT;
  Check(sheaf_scene_get_settings(scene.handle.get(), &settings));
  py::dict made;
  made["width"] = settings.width;
  made["height"] = settings.height;
  made["samples"] = settings.samples;
  made["max_depth"] = settings.max_depth;
  return made;
}

// name, eye, look_at, up, projection, lens
py::tuple CameraOf(const Scene& scene, std::size_t index) {
  sheaf_camera camera = SHEAF_CAMERA_INIT;
  Check(sheaf_scene_get_camera(scene.handle.get(), index, &camera));
  const auto point = [](const double(&from)[3]) {
    return py::make_tuple(from[0], from[1], from[2]);
  };
  return py::make_tuple(sheaf_scene_camera_name(scene.handle.get(), index), point(camera.eye),
                        point(camera.look_at), point(camera.up),
                        kProjectionKinds[camera.projection].name, camera.lens);
}

sheaf_camera ViewOf(const py::tuple& given) {
  sheaf_camera camera = SHEAF_CAMERA_INIT;
  const auto take = [&](std::size_t i, double(&to)[3]) {
    const auto numbers = given[i].cast<std::array<double, 3>>();
    std::copy(numbers.begin(), numbers.end(), to);
  };
  take(1, camera.eye);
  take(2, camera.look_at);
  take(3, camera.up);
  const auto name = given[4].cast<std::string>();
  for (std::size_t i = 0; i < std::size(kProjectionKinds); ++i) {
    if (name != kProjectionKinds[i].name) continue;
    camera.projection = static_cast<sheaf_projection>(i);
    camera.lens = given[5].is_none() ? kProjectionKinds[i].usual : given[5].cast<double>();
    return camera;
  }
  std::string known;
  for (const ProjectionKind& kind : kProjectionKinds) known += std::string(" ") + kind.name;
  Raise(SHEAF_USAGE, "projection: \"" + name + "\" is none of" + known);
}

// ---- Pictures ----

// Numbers of a film, which live as long as somebody looks at one of them.
py::array ShowFilm(const std::shared_ptr<sheaf_film>& film, const float* numbers, int channels) {
  if (numbers == nullptr) throw py::key_error("a layer that the film does not have");
  auto* const held = new std::shared_ptr<sheaf_film>(film);
  const py::capsule owner(held,
                          [](void* p) { delete static_cast<std::shared_ptr<sheaf_film>*>(p); });
  std::vector<py::ssize_t> shape = {sheaf_film_height(film.get()), sheaf_film_width(film.get())};
  if (channels > 1) shape.push_back(channels);
  return py::array_t<float>(shape, numbers, owner);
}

// "rgb" and each layer that is there.
py::dict ShowLayers(Owned<sheaf_film> given) {
  const std::shared_ptr<sheaf_film> film(std::move(given));
  py::dict arrays;
  arrays["rgb"] = ShowFilm(film, sheaf_film_rgb(film.get()), 3);
  for (int i = 0; i < kLayerCount; ++i) {
    const float* const numbers = sheaf_film_layer(film.get(), static_cast<sheaf_layer>(1 << i));
    if (numbers == nullptr) continue;
    arrays[LayerName(static_cast<Layer>(i))] = ShowFilm(film, numbers, kLayerChannels[i]);
  }
  return arrays;
}

std::uint32_t LayerBits(const std::vector<std::string>& names) {
  std::uint32_t bits = 0;
  for (const std::string& name : names) {
    int i = 0;
    while (i < kLayerCount && name != LayerName(static_cast<Layer>(i))) ++i;
    if (i == kLayerCount) Raise(SHEAF_USAGE, "layers: \"" + name + "\" is no layer");
    bits |= 1u << i;
  }
  return bits;
}

py::dict ReadPictureFile(const std::string& path) {
  sheaf_film* film = nullptr;
  RunUnlocked([&] { return sheaf_film_read(path.c_str(), &film); });
  return ShowLayers(Owned<sheaf_film>(film));
}

void WritePictureFile(const std::string& path, const py::array_t<float>& rgb,
                      const py::dict& given) {
  if (rgb.ndim() != 3 || rgb.shape(2) != 3 || rgb.strides(2) != sizeof(float) ||
      rgb.strides(1) != 3 * sizeof(float) || rgb.strides(0) < 0) {
    throw py::value_error("rgb: an array of another shape");
  }
  sheaf_picture_options options = SHEAF_PICTURE_OPTIONS_INIT;
  bool linear = false, filmic = false;
  TakeOption(given, "bits", &options.bits);
  TakeOption(given, "ev", &options.ev);
  TakeOption(given, "linear", &linear);
  TakeOption(given, "filmic", &filmic);
  options.linear = linear ? 1 : 0;
  options.filmic = filmic ? 1 : 0;
  const auto height = static_cast<std::int32_t>(std::min<py::ssize_t>(rgb.shape(0), INT32_MAX));
  const auto width = static_cast<std::int32_t>(std::min<py::ssize_t>(rgb.shape(1), INT32_MAX));
  const float* const pixels = rgb.data();
  const auto stride = static_cast<std::size_t>(rgb.strides(0));
  RunUnlocked([&] {
    sheaf_film* film = nullptr;
    sheaf_status status = sheaf_film_create(width, height, pixels, stride, &film);
    const Owned<sheaf_film> owner(film);
    return status == SHEAF_OK ? sheaf_film_write(film, path.c_str(), &options) : status;
  });
}

// ---- Frames ----

sheaf_render_options FrameOptions(const py::dict& given) {
  sheaf_render_options options = SHEAF_RENDER_OPTIONS_INIT;
  TakeOption(given, "width", &options.width);
  TakeOption(given, "height", &options.height);
  TakeOption(given, "samples", &options.samples);
  TakeOption(given, "max_depth", &options.max_depth);
  TakeOption(given, "threads", &options.threads);
  std::array<std::int32_t, 4> crop = {0, 0, 0, 0};
  TakeOption(given, "crop", &crop);
  std::copy(crop.begin(), crop.end(), options.crop);
  std::string precision = PrecisionName(Precision::kStrict);
  TakeOption(given, "precision", &precision);
  for (const Precision known : kPrecisions) {
    if (precision == PrecisionName(known)) {
      options.precision = static_cast<sheaf_precision>(known);
      precision.clear();
    }
  }
  if (!precision.empty()) Raise(SHEAF_USAGE, "precision: \"" + precision + "\" is unknown");
  std::vector<std::string> layers;
  TakeOption(given, "layers", &layers);
  options.layers = LayerBits(layers);
  return options;
}

py::dict StatisticsOf(const sheaf_render_statistics& from) {
  py::dict to;
  to["primary_rays"] = from.primary_rays;
  to["shadow_rays"] = from.shadow_rays;
  to["reflected_rays"] = from.reflected_rays;
  to["refracted_rays"] = from.refracted_rays;
  to["traced_rays"] = from.traced_rays;
  to["build_seconds"] = from.build_seconds;
  to["render_seconds"] = from.render_seconds;
  to["buffer_bytes"] = from.buffer_bytes;
  to["threads"] = from.threads;
  return to;
}

// Waits for a frame on another thread, so that this one goes on to see signals, like that of
// Ctrl-C, and to call `report` with the pixels that are done. What either raises stops the frame.
void WaitForFrame(std::future<Outcome>& frame, sheaf_progress* progress, const py::object& report) {
  const auto is_done = [&] {
    const py::gil_scoped_release release;
    return frame.wait_for(std::chrono::milliseconds(30)) == std::future_status::ready;
  };
  try {
    while (!is_done()) {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!report.is_none()) report(sheaf_progress_pixels_done(progress));
    }
  } catch (...) {
    sheaf_progress_stop(progress);
    const py::gil_scoped_release release;
    frame.wait();
    throw;
  }
}

// The film's arrays and the statistics. `camera`: an index, or what CameraOf returns.
py::tuple RenderFrame(const Scene& scene, const py::object& camera, const py::dict& given) {
  sheaf_render_options options = FrameOptions(given);
  std::string target = "auto";
  TakeOption(given, "target", &target);
  options.target = target.c_str();
  sheaf_camera view = SHEAF_CAMERA_INIT;
  if (py::isinstance<py::tuple>(camera)) {
    view = ViewOf(camera.cast<py::tuple>());
    options.view = &view;
  } else {
    options.camera = camera.cast<std::size_t>();
  }
  sheaf_progress* made = nullptr;
  Check(sheaf_progress_create(&made));
  const Owned<sheaf_progress> progress(made);
  options.progress = progress.get();
  sheaf_render_statistics statistics = SHEAF_RENDER_STATISTICS_INIT;
  sheaf_film* film = nullptr;
  std::future<Outcome> frame = std::async(std::launch::async, [&] {
    return Outcome::Of(sheaf_render(scene.handle.get(), &options, &statistics, &film));
  });
  const py::object report = given.contains("progress") ? py::object(given["progress"]) : py::none();
  WaitForFrame(frame, progress.get(), report);
  frame.get().Check();
  return py::make_tuple(ShowLayers(Owned<sheaf_film>(film)), StatisticsOf(statistics));
}

}  // namespace

void AddScenes(py::module_& module) {
  py::class_<Scene>(module, "Scene")
      .def_static("read", &ReadFile)
      .def_static("parse", &ParseText)
      .def("warnings", &WarningsOf)
      .def("settings", &SettingsOf)
      .def("camera_count",
           [](const Scene& scene) { return sheaf_scene_camera_count(scene.handle.get()); })
      .def("camera", &CameraOf)
      .def("render", &RenderFrame);
  module.def("read_picture", &ReadPictureFile);
  module.def("write_picture", &WritePictureFile);
}

}  // namespace sheaf::python
