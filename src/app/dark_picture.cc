#include "src/app/dark_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <optional>
#include <variant>

#include "src/app/choose.h"
#include "src/formats/printable.h"
#include "src/scene/bounds.h"
#include "src/scene/develop.h"
#include "src/scene/shapes.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

constexpr int kLookoutSide = 64;  // pixels

// A small picture of what is in view, by the numbers of objects.
Result<Film> LookOut(const Renderer& renderer, const Camera& camera, const RenderOptions& options) {
  RenderOptions small = SmallPicture(options, kLookoutSide);
  small.max_depth = 0;
  small.layers.Add(Layer::kId);
  return renderer.Render(camera, small);
}

bool IsInside(const Object& object, const Vec3d& point) {
  if (const auto* sphere = std::get_if<Sphere>(&object.shape)) {
    return glm::length(point - sphere->center) < sphere->radius;
  }
  const std::optional<Bounds> box = BoundsOf(object.shape);
  return box && glm::all(glm::greaterThan(point, box->min)) &&
         glm::all(glm::lessThan(point, box->max));
}

}  // namespace

DarkPicture::DarkPicture(Transfer transfer, double ev)
    : least_shown_(static_cast<float>(
          (transfer == Transfer::kSrgb ? SrgbDecode(0.5 / 255) : 0.5 / 255) / ExposureFactor(ev))) {
}

void DarkPicture::AddRows(const Film& rows) {
  if (!has_first_ && !rows.rgb.empty()) std::copy_n(rows.rgb.begin(), 3, first_);
  has_first_ = true;
  for (std::size_t i = 0; i < rows.rgb.size() && (is_dark_ || is_uniform_); ++i) {
    const float value = rows.rgb[i];
    is_dark_ = is_dark_ && value < least_shown_;  // false for NaN: it is no darkness
    is_uniform_ = is_uniform_ && value == first_[i % 3];
    largest_ = std::max(largest_, value);
  }
}

Result<std::string> DarkPicture::Explain(const Renderer& renderer, const Camera& camera,
                                         const RenderOptions& options) const {
  if (!is_dark_ && !is_uniform_) return std::string();
  const Scene& scene = renderer.scene();
  const Result<Film> seen = LookOut(renderer, camera, options);
  if (!seen) return seen.error();
  const Film& film = seen.value();
  const std::string name = Printable(camera.name);
  const float first = *film.at(Layer::kId, 0, 0);
  bool is_one = true, is_empty = true;
  for (int y = 0; y < film.height; ++y) {
    for (int x = 0; x < film.width; ++x) {
      const float id = *film.at(Layer::kId, x, y);
      is_one = is_one && id == first;
      is_empty = is_empty && id == 0;
    }
  }
  if (is_empty) return fmt::format("nothing is in view of the camera \"{}\"", name);
  if (is_one) {
    const std::size_t index = static_cast<std::size_t>(first) - 1;
    const Object& object = ObjectAt(scene, index);
    if (index < scene.objects.size() && IsInside(object, camera.eye)) {
      return fmt::format("the eye of the camera \"{}\" lies inside object {}{}", name, index,
                         object.name.empty() ? "" : fmt::format(" \"{}\"", Printable(object.name)));
    }
  }
  if (!is_dark_) return std::string();
  return fmt::format(
      "the picture is black: its largest value is {:.2g}, and less than {:.2g} does not show; the "
      "lights of what is in view are too weak, too far, or behind it",
      largest_, least_shown_);
}

}  // namespace sheaf
