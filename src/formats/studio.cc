#include "src/formats/studio.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <variant>

#include "src/scene/bounds.h"
#include "src/scene/placed_groups.h"

namespace sheaf {
namespace {

// A light of a studio, and where it stands beside the camera: right, up and behind it.
struct StudioLight {
  const char* name;
  double intensity;
  Vec3d place;
  bool casts_shadows;
};
// The first falls over the left shoulder; the second lifts its shadows; the third draws the upper
// edge from behind.
constexpr StudioLight kStudio[] = {{"key", 0.75, {-0.6, 0.9, 1.0}, true},
                                   {"fill", 0.15, {1.0, 0.2, 0.8}, false},
                                   {"rim", 0.3, {0.4, 0.8, -1.0}, true}};

// ---- Framing ----

// Calls include(point) for points around which a convex outline holds the scene.
void ForEachOutlinePoint(const Scene& scene, const std::function<void(const Vec3d&)>& include) {
  const auto include_corners = [&](const Bounds& box) {
    for (int corner = 0; corner < 8; ++corner) {
      const auto side = [&](int axis) {
        return (corner >> axis & 1) != 0 ? box.max[axis] : box.min[axis];
      };
      include({side(0), side(1), side(2)});
    }
  };
  for (const Object& object : scene.objects) {
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
      for (const auto& corners : mesh->triangles) {
        for (const std::uint32_t vertex : corners) include(Vec3d(mesh->positions[vertex]));
      }
      continue;
    }
    if (const std::optional<Bounds> box = BoundsOf(object.shape)) include_corners(*box);
  }
  ForEachPlacedBox(scene, include_corners);
}

// The axes of a camera that looks along `ahead`.
struct ViewAxes {
  Vec3d right, up, ahead;

  ViewAxes(const Vec3d& direction, const Vec3d& upward)
      : right(glm::normalize(glm::cross(direction, upward))),
        up(glm::cross(right, direction)),
        ahead(direction) {}
};

// Along one axis of the picture: with the eye at e, `back` behind the origin, a point is in view
// where |x - e| <= tangent * (back + z). How far each side asks back + e and back - e to be.
struct Extent {
  double high = -std::numeric_limits<double>::infinity(), low = high;

  void Include(double x, double z, double tangent) {
    high = std::max(high, x - tangent * z);
    low = std::max(low, -x - tangent * z);
  }
  double Middle() const { return (high - low) / 2; }
  double Back(double tangent) const { return (high + low) / 2 / tangent; }
};

constexpr double kFov = 40, kTangent = 0.36397023426620234;  // of half of it
constexpr double kMargin = 1.08;                             // of air around the outline

// ---- The ground ----

// White, its alpha 1 up to a third of the way out and 0 at the rim.
std::shared_ptr<const Image> SoftCircle() {
  constexpr int kSide = 128;
  auto image = std::make_shared<Image>(Image{"ground.png", kSide, kSide, {}});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double u = (x + 0.5) / kSide * 2 - 1, v = (y + 0.5) / kSide * 2 - 1;
      const double share = std::clamp((1 - std::sqrt(u * u + v * v)) * 1.5, 0.0, 1.0);
      const double alpha = share * share * (3 - 2 * share);
      image->texels.push_back(0x00ffffff | static_cast<std::uint32_t>(std::lround(alpha * 255))
                                               << 24);
    }
  }
  return image;
}

}  // namespace

Camera CameraThatFrames(const Scene& scene, const Vec3d& up, double aspect) {
  Camera camera;
  camera.name = "default";
  camera.up = up;
  camera.projection = Perspective{kFov};
  const Bounds bounds = BoundsOf(scene).value_or(Bounds{Vec3d(-1), Vec3d(1)});
  const Vec3d middle = bounds.min * 0.5 + bounds.max * 0.5;
  const double size = std::max(glm::length(bounds.max - bounds.min), 2e-6);
  const ViewAxes axes(-glm::normalize(Vec3d(0.45, 0.35, 1)), up);
  const double across_tangent = kTangent * aspect / kMargin, up_tangent = kTangent / kMargin;
  Extent across, upward;
  ForEachOutlinePoint(scene, [&](const Vec3d& point) {
    const Vec3d p = (point - middle) / size;
    const double z = glm::dot(p, axes.ahead);
    across.Include(glm::dot(p, axes.right), z, across_tangent);
    upward.Include(glm::dot(p, axes.up), z, up_tangent);
  });
  double back = std::max(across.Back(across_tangent), upward.Back(up_tangent));
  Vec3d target(0.0);
  if (std::isfinite(back)) {
    target = axes.right * across.Middle() + axes.up * upward.Middle();
  } else {
    back = 1;
  }
  // A point, or what is seen from its edge, has some air before it.
  back = std::max(back, 0.1);
  // Of a model at the very limit neither point lies where no scene may have one.
  const auto place = [&](const Vec3d& p) {
    return glm::clamp(middle + p * size, -kMaxCoordinate, kMaxCoordinate);
  };
  camera.look_at = place(target);
  camera.eye = place(target - axes.ahead * back);
  return camera;
}

void AddStudio(Scene* scene) {
  for (const StudioLight& studio : kStudio) {
    Light light;
    light.name = studio.name;
    light.intensity = studio.intensity;
    light.casts_shadows = studio.casts_shadows;
    scene->lights.push_back(light);
  }
  AimStudio(scene);
  scene->settings.ambient = Colour(1.0);
  scene->settings.background = Colour(0.8, 0.84, 0.9);
  scene->settings.environment =
      Gradient{{0.42, 0.5, 0.62}, scene->settings.background, {0.5, 0.48, 0.46}};
}

void AimStudio(Scene* scene) {
  const Camera& camera = scene->cameras.front();
  const Vec3d ahead = glm::normalize(camera.look_at - camera.eye);
  const Vec3d right = glm::normalize(glm::cross(ahead, camera.up));
  const Vec3d up = glm::cross(right, ahead);
  for (std::size_t i = 0; i < std::size(kStudio); ++i) {
    const Vec3d& place = kStudio[i].place;
    scene->lights[i].source = DirectionalLight{place.z * ahead - place.x * right - place.y * up};
  }
}

void AddGround(Scene* scene) {
  const std::optional<Bounds> bounds = BoundsOf(*scene);
  if (!bounds) return;
  const Vec3d size = bounds->max - bounds->min;
  const double radius = 2.5 * glm::length(size);
  // Below, so that a flat bottom does not lie in it.
  const Vec3d middle((bounds->min.x + bounds->max.x) / 2, bounds->min.y - 1e-4 * radius,
                     (bounds->min.z + bounds->max.z) / 2);
  const double far = std::max({std::abs(middle.x), std::abs(middle.y), std::abs(middle.z)});
  if (!(radius > 0 && far + radius <= kMaxCoordinate)) return;
  Material ground;
  ground.name = "ground";
  ground.base_colour = Texture{SoftCircle(), Transfer::kLinear, Wrap::kClamp,
                               Wrap::kClamp, Filter::kLinear,   Colour(0.93, 0.96, 1.0)};
  ground.ambient = 0.35;
  ground.kd = 0.65;
  ground.alpha.mode = AlphaMode::kBlend;
  scene->objects.push_back({"ground", Disk{middle, radius, {0, 1, 0}},
                            static_cast<std::uint32_t>(scene->materials.size())});
  scene->materials.push_back(std::move(ground));
}

}  // namespace sheaf
