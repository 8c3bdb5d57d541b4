// The rules of sheaf/scene.h, asked of a scene that a program made.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "sheaf/render.h"
#include "sheaf/scene.h"
#include "src/core/match.h"
#include "src/scene/affine_map.h"
#include "src/scene/direction.h"
#include "src/scene/placed_groups.h"
#include "src/scene/projection.h"
#include "src/scene/textures.h"

namespace sheaf {
namespace {

// What a number has to be. Comparisons are false for NaN, which is in no range.
struct Range {
  double low, high;
  const char* text;

  bool Has(double x) const { return low <= x && x <= high; }
};

constexpr double kLargest = std::numeric_limits<float>::max();
constexpr double kSmallest = std::numeric_limits<double>::denorm_min();
constexpr Range kPlace{-kMaxCoordinate, kMaxCoordinate, "a number in [-1e30, 1e30]"};
// Where a mesh has floats, which round the limit up.
constexpr double kMostAsFloat = static_cast<double>(static_cast<float>(kMaxCoordinate));
constexpr Range kVertexPlace{-kMostAsFloat, kMostAsFloat, "a number in [-1e30, 1e30]"};
constexpr Range kLength{0, kMaxCoordinate, "a number in [0, 1e30]"};
// By the unit of length: in a scene of tiny numbers light falls off by huge ones.
constexpr Range kFalloff{0, 1e38, "a number in [0, 1e38]"};
constexpr Range kAny{-kLargest, kLargest, "a finite float"};
constexpr Range kAtLeastZero{0, kLargest, "a finite float of at least 0"};
constexpr Range kPositive{kSmallest, kLargest, "a finite float above 0"};
constexpr Range kShare{0, 1, "a number in [0, 1]"};
constexpr Range kTurn{-1e6, 1e6, "a number in [-1e6, 1e6]"};
constexpr Range kAngle{0, 90, "a number in [0, 90]"};
constexpr Range kHalfTurn{0, 180, "a number in [0, 180]"};
constexpr Range kPositiveLength{1e-30, kMaxCoordinate, "a number in [1e-30, 1e30]"};

// The first thing that is wrong with a part of a scene, if any.
class FirstFault {
 public:
  bool found() const { return !text_.empty(); }
  const std::string& text() const { return text_; }

  void Fail(std::string what) {
    if (!found()) text_ = std::move(what);
  }
  void Number(std::string_view name, double value, const Range& range) {
    if (!range.Has(value)) Fail(fmt::format("{} is {}, not {}", name, value, range.text));
  }
  template <typename Vector>
  void Components(std::string_view name, const Vector& vector, const Range& range) {
    for (int i = 0; i < Vector::length(); ++i) {
      Number(name, static_cast<double>(vector[i]), range);
    }
  }
  void Direction(std::string_view name, const Vec3d& vector) {
    Components(name, vector, kPlace);
    if (!GivesDirection(vector)) Fail(fmt::format("{} is 0 and gives no direction", name));
  }
  void Index(std::string_view kind, std::uint32_t index, std::size_t count) {
    if (index >= count) Fail(fmt::format("{} {} of {}", kind, index, count));
  }
  // One value a vertex, or none.
  template <typename Value>
  void PerVertex(std::string_view name, const std::vector<Value>& values, const Range& range,
                 std::size_t vertices) {
    if (!values.empty() && values.size() != vertices) {
      Fail(fmt::format("{} {} for {} vertices", values.size(), name, vertices));
    }
    for (std::size_t i = 0; i < values.size() && !found(); ++i) {
      const auto check = [&](double number) {
        if (range.Has(number)) return;
        Number(fmt::format("vertex {}: one of the {}", i, name), number, range);
      };
      if constexpr (std::is_arithmetic_v<Value>) {
        check(static_cast<double>(values[i]));
      } else {
        for (int k = 0; k < Value::length(); ++k) check(static_cast<double>(values[i][k]));
      }
    }
  }

 private:
  std::string text_;
};

// The sides of an image that has so many pixels.
template <typename Picture>
void CheckSides(const std::string& name, const Picture& image, std::size_t pixels,
                FirstFault& fault) {
  constexpr Range kSide{1, kMaxTextureSide, "a number in [1, 16384]"};
  fault.Number(name + ".width", image.width, kSide);
  fault.Number(name + ".height", image.height, kSide);
  const auto wanted =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (!fault.found() && pixels != wanted) {
    fault.Fail(
        fmt::format("{} has {} texels, not {} x {}", name, pixels, image.width, image.height));
  }
}

void CheckTexture(const std::string& name, const Texture& texture, FirstFault& fault) {
  fault.Components(name + ".factor", texture.factor, kAtLeastZero);
  fault.Components(name + ".transform.offset", texture.transform.offset, kAny);
  fault.Components(name + ".transform.scale", texture.transform.scale, kAny);
  fault.Number(name + ".transform.rotation", texture.transform.rotation, kTurn);
  fault.Number(name + ".set", texture.set, {0, 1, "0 or 1"});
  if (!texture.image) return fault.Fail(name + ".image is null");
  CheckSides(name + ".image", *texture.image, texture.image->texels.size(), fault);
}

void Check(const Material& material, FirstFault& fault) {
  if (const auto* colour = std::get_if<Colour>(&material.base_colour)) {
    fault.Components("base_colour", *colour, kAtLeastZero);
  } else if (const auto* checker = std::get_if<Checker>(&material.base_colour)) {
    fault.Components("base_colour.even", checker->even, kAtLeastZero);
    fault.Components("base_colour.odd", checker->odd, kAtLeastZero);
    fault.Components("base_colour.cells", checker->cells, kPositive);
  }
  ForEachTexture(material, [&](const char* name, const Texture& texture) {
    CheckTexture(name, texture, fault);
  });
  fault.Components("emission", material.emission, kAtLeastZero);
  fault.Number("ambient", material.ambient, kAtLeastZero);
  fault.Number("kd", material.kd, kAtLeastZero);
  fault.Number("ks", material.ks, kAtLeastZero);
  fault.Number("shininess", material.shininess, kAtLeastZero);
  fault.Components("reflect", material.reflect, kShare);
  fault.Components("transmit", material.transmit, kShare);
  fault.Number("ior", material.ior, kPositive);
  fault.Number("roughness", material.roughness, kShare);
  fault.Components("attenuation", material.attenuation, kShare);
  fault.Number("attenuation_distance", material.attenuation_distance, kPositive);
  if (const auto& gloss = material.metallic_roughness) {
    fault.Number("metallic_roughness.metallic", gloss->metallic, kShare);
    fault.Number("metallic_roughness.roughness", gloss->roughness, kShare);
    fault.Number("metallic_roughness.specular", gloss->specular, kAtLeastZero);
  }
  if (const auto& map = material.transmission)
    fault.Number("transmission.share", map->share, kShare);
  if (material.occlusion) fault.Number("occlusion.strength", material.occlusion->strength, kShare);
  if (material.normal_map) fault.Number("normal_map.scale", material.normal_map->scale, kAny);
  fault.Number("alpha.factor", material.alpha.factor, kShare);
  fault.Number("alpha.cutoff", material.alpha.cutoff, kShare);
}

void CheckMesh(const Mesh& mesh, FirstFault& fault) {
  const std::size_t vertices = mesh.positions.size();
  fault.PerVertex("positions", mesh.positions, kVertexPlace, vertices);
  fault.PerVertex("normals", mesh.normals, kAny, vertices);
  fault.PerVertex("uv", mesh.uv, kAny, vertices);
  fault.PerVertex("uv2", mesh.uv2, kAny, vertices);
  fault.PerVertex("colours", mesh.colours, kAtLeastZero, vertices);
  fault.PerVertex("alphas", mesh.alphas, kShare, vertices);
  for (std::size_t i = 0; i < mesh.triangles.size() && !fault.found(); ++i) {
    for (const std::uint32_t corner : mesh.triangles[i]) {
      if (corner >= vertices) fault.Index(fmt::format("triangle {}: vertex", i), corner, vertices);
    }
  }
}

void Check(const Object& object, FirstFault& fault) {
  Match(
      object.shape,
      [&](const Sphere& sphere) {
        fault.Components("center", sphere.center, kPlace);
        fault.Number("radius", sphere.radius, kLength);
      },
      [&](const Quad& quad) {
        for (const Vec3d& corner : quad.corners) fault.Components("a corner", corner, kPlace);
      },
      [&](const Triangle& triangle) {
        for (const Vec3d& vertex : triangle.vertices) fault.Components("a vertex", vertex, kPlace);
        for (const glm::dvec2& uv : triangle.uv) fault.Components("uv", uv, kAny);
      },
      [&](const Mesh& mesh) { CheckMesh(mesh, fault); },
      [&](const Disk& disk) {
        fault.Components("center", disk.center, kPlace);
        fault.Number("radius", disk.radius, kLength);
        fault.Components("normal", disk.normal, kPlace);
      });
}

void CheckSource(const PointLight& point, FirstFault& fault) {
  fault.Components("position", point.position, kPlace);
  fault.Number("falloff.constant", point.falloff.constant, kFalloff);
  fault.Number("falloff.linear", point.falloff.linear, kFalloff);
  fault.Number("falloff.quadratic", point.falloff.quadratic, kFalloff);
  if (!HasTerm(point.falloff, 1e-38)) {
    fault.Fail("falloff: one of the terms must be at least 1e-38");
  }
  if (!point.cone) return;
  fault.Direction("cone.direction", point.cone->direction);
  fault.Number("cone.inner", point.cone->inner, kAngle);
  fault.Number("cone.outer", point.cone->outer, kAngle);
  if (!(point.cone->inner < point.cone->outer)) fault.Fail("cone.inner must be below cone.outer");
}

void Check(const Light& light, FirstFault& fault) {
  Match(
      light.source, [&](const PointLight& point) { CheckSource(point, fault); },
      [&](const DirectionalLight& sun) {
        fault.Direction("direction", sun.direction);
        fault.Number("angle", sun.angle, kHalfTurn);
      },
      [&](const RectangleLight& rectangle) {
        fault.Components("center", rectangle.center, kPlace);
        fault.Components("u", rectangle.u, kPlace);
        fault.Components("v", rectangle.v, kPlace);
        if (!fault.found() && !SpansPlane(rectangle.u, rectangle.v)) {
          fault.Fail("u and v span no rectangle");
        }
      },
      [&](const DiskLight& disk) {
        fault.Components("center", disk.center, kPlace);
        fault.Number("radius", disk.radius, kPositiveLength);
        fault.Direction("direction", disk.direction);
      },
      [&](const SphereLight& sphere) {
        fault.Components("center", sphere.center, kPlace);
        fault.Number("radius", sphere.radius, kPositiveLength);
      });
  fault.Components("colour", light.colour, kAtLeastZero);
  fault.Number("intensity", light.intensity, kAtLeastZero);
  fault.Number("samples", light.samples, {1, kMaxLightSamples, "a number in [1, 1024]"});
}

void CheckPath(const Camera& camera, FirstFault& fault) {
  const ProjectionKind& kind = KindOf(camera.projection);
  for (std::size_t i = 0; i < camera.path.size(); ++i) {
    const CameraKey& key = camera.path[i];
    fault.Number("path.frame", key.frame, {-kMaxFrame, kMaxFrame, "a number in [-1e6, 1e6]"});
    fault.Components("path.eye", key.eye, kPlace);
    fault.Components("path.look_at", key.look_at, kPlace);
    if (kind.unit != ProjectionUnit::kNone) {
      fault.Number("path.lens", key.lens, {kSmallest, kind.largest, kind.range});
    }
    if (i > 0 && !(camera.path[i - 1].frame < key.frame)) fault.Fail("path is not in order");
  }
}

void Check(const Lens& lens, const ProjectionKind& kind, FirstFault& fault) {
  if (kind.surface != ProjectionSurface::kPlane) {
    fault.Fail(fmt::format("lens: {} cameras have none", kind.name));
  }
  fault.Number("lens.aperture", lens.aperture, kPositiveLength);
  if (lens.focus) fault.Number("lens.focus", *lens.focus, kPositiveLength);
  if (lens.blades != 0) fault.Number("lens.blades", lens.blades, {3, 64, "0 or in [3, 64]"});
  fault.Number("lens.rotation", lens.rotation, kTurn);
}

void Check(const Camera& camera, FirstFault& fault) {
  fault.Components("eye", camera.eye, kPlace);
  fault.Components("look_at", camera.look_at, kPlace);
  fault.Direction("up", camera.up);
  if (!fault.found()) fault.Fail(TextOf(FindViewFault(camera)));
  CheckPath(camera, fault);
  const ProjectionKind& kind = KindOf(camera.projection);
  if (camera.lens) Check(*camera.lens, kind, fault);
  if (kind.unit == ProjectionUnit::kNone) return;
  fault.Number(kind.parameter, ParameterOf(camera.projection),
               {kSmallest, kind.largest, kind.range});
}

void Check(const Environment& environment, FirstFault& fault) {
  Match(
      environment,
      [&](const Gradient& gradient) {
        fault.Components("environment.zenith", gradient.zenith, kAtLeastZero);
        fault.Components("environment.horizon", gradient.horizon, kAtLeastZero);
        fault.Components("environment.nadir", gradient.nadir, kAtLeastZero);
      },
      [&](const EnvironmentMap& map) {
        fault.Number("environment.strength", map.strength, kAtLeastZero);
        fault.Number("environment.rotation", map.rotation, kTurn);
        if (!map.image) return fault.Fail("environment.image is null");
        CheckSides("environment.image", *map.image, map.image->rgb.size() / 3, fault);
        const bool is_light = std::all_of(map.image->rgb.begin(), map.image->rgb.end(),
                                          [](float x) { return kAtLeastZero.Has(x); });
        if (!is_light) fault.Fail("environment.image has a number that is negative or not finite");
      });
}

void Check(const Settings& settings, FirstFault& fault) {
  fault.Number("width", settings.width, {1, kMaxImageSide, "a number in [1, 65536]"});
  fault.Number("height", settings.height, {1, kMaxImageSide, "a number in [1, 65536]"});
  fault.Number("samples", settings.samples, {1, kMaxSamples, "a number in [1, 65536]"});
  if (settings.contrast) fault.Number("adaptive", *settings.contrast, kShare);
  if (settings.error) fault.Number("error", *settings.error, {kSmallest, 1, "a number in (0, 1]"});
  if (settings.error && settings.samples < kLeastErrorSamples) {
    fault.Fail(fmt::format("error needs samples of {} or more", kLeastErrorSamples));
  }
  if (settings.contrast && settings.error) fault.Fail("adaptive and error exclude each other");
  fault.Number("max_depth", settings.max_depth, {0, kMaxDepth, "a number in [0, 1000000]"});
  fault.Components("background", settings.background, kAtLeastZero);
  if (settings.environment) Check(*settings.environment, fault);
  if (settings.ambient) fault.Components("ambient", *settings.ambient, kAtLeastZero);
  fault.Number("exposure", settings.exposure, kPositive);
  if (settings.ev) fault.Number("ev", *settings.ev, {-kMaxEv, kMaxEv, "a number in [-64, 64]"});
}

Error At(const std::string& place, const FirstFault& fault) {
  return {ErrorKind::kScene, place + ": " + fault.text()};
}

// `material 3 "glass"`; a name's control characters stay out of messages.
std::string PlaceOf(const char* kind, std::size_t index, std::string name) {
  if (name.empty()) return fmt::format("{} {}", kind, index);
  std::replace_if(
      name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, '?');
  return fmt::format("{} {} \"{}\"", kind, index, name);
}

// Checks each of `parts` by `check`; the first fault, if any.
template <typename Part, typename F>
Status CheckAll(const char* kind, const std::vector<Part>& parts, F check) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    FirstFault fault;
    check(parts[i], fault);
    if (fault.found()) return At(PlaceOf(kind, i, parts[i].name), fault);
  }
  return Done{};
}

// `groups`: how many may be stood somewhere.
Status CheckInstances(const std::vector<Instance>& instances, std::size_t groups) {
  return CheckAll("instance", instances, [&](const Instance& instance, FirstFault& fault) {
    fault.Index("group", instance.group, groups);
    if (const std::string flat = FaultOf(MapOf(TransformOf(instance))); !flat.empty())
      fault.Fail(flat);
  });
}

Status CheckGroups(const Scene& scene) {
  for (std::size_t i = 0; i < scene.groups.size(); ++i) {
    const Group& group = scene.groups[i];
    Status status = CheckAll("object", group.objects, [&](const Object& object, FirstFault& fault) {
      fault.Index("material", object.material, scene.materials.size());
      Check(object, fault);
    });
    if (status.ok()) status = CheckInstances(group.instances, i);
    if (status.ok()) continue;
    return Error{ErrorKind::kScene,
                 PlaceOf("group", i, group.name) + ": " + status.error().message};
  }
  if (Status status = CheckInstances(scene.instances, scene.groups.size()); !status) return status;
  if (CountPlacedGroups(scene) <= kMaxInstances) return Done{};
  return Error{ErrorKind::kScene,
               fmt::format("instances: more than {} through all levels", kMaxInstances)};
}

}  // namespace

Status Validate(const Scene& scene) {
  FirstFault settings;
  Check(scene.settings, settings);
  if (settings.found()) return At("settings", settings);
  const auto check = [](const auto& part, FirstFault& fault) { Check(part, fault); };
  if (Status status = CheckAll("material", scene.materials, check); !status) return status;
  Status status = CheckAll("object", scene.objects, [&](const Object& object, FirstFault& fault) {
    fault.Index("material", object.material, scene.materials.size());
    Check(object, fault);
  });
  if (!status) return status;
  if (status = CheckGroups(scene); !status) return status;
  if (status = CheckAll("light", scene.lights, check); !status) return status;
  if (status = CheckAll("camera", scene.cameras, check); !status) return status;
  return CheckAll("view", scene.views, [&](const View& view, FirstFault& fault) {
    for (const std::uint32_t camera : view.cameras) {
      fault.Index("camera", camera, scene.cameras.size());
    }
  });
}

Status Validate(const Camera& camera) {
  FirstFault fault;
  Check(camera, fault);
  if (fault.found()) return At(PlaceOf("camera", 0, camera.name), fault);
  return Done{};
}

}  // namespace sheaf
