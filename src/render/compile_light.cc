#include "src/render/compile_light.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "simd/roundoffs.h"
#include "src/core/match.h"
#include "src/core/strict_tan.h"
#include "src/render/compile_values.h"
#include "src/scalar/frame.h"

namespace sheaf {
namespace {

// The cosines of a spot light's two angles differ by at least this, as in KHR_lights_punctual.
constexpr double kLeastConeRim = 0.001;

// The largest distance from `p` to a point of the box.
double Reach(const PointBounds& bounds, const glm::dvec3& p) {
  return LengthOf(glm::max(glm::abs(bounds.low - p), glm::abs(bounds.high - p)));
}

// A light's falloff where lengths are placed ones. Both it and the light's colour are scaled by a
// power of two that keeps the largest of the three near 1.
void PlaceFalloff(const ScenePlacement& placement, Falloff& falloff, Colour& colour) {
  if (placement.scale == 1) return;
  falloff.linear /= placement.scale;
  falloff.quadratic = falloff.quadratic / placement.scale / placement.scale;
  const double largest = std::max({falloff.constant, falloff.linear, falloff.quadratic});
  const double unit = std::ldexp(1.0, -std::ilogb(largest));
  falloff = {falloff.constant * unit, falloff.linear * unit, falloff.quadratic * unit};
  colour = colour * unit;
}

// Where all of a light is known but its place.
struct LightSetting {
  const ScenePlacement& placement;
  const PointBounds& bounds;  // placed
  Colour colour;
  int samples;
};

// What is drawn from: an intensity along the axis, of which each sample gives its part.
template <typename Real>
void StoreShape(LightShape shape, const LightSetting& setting, LightData<Real>& data) {
  data.shape = shape;
  data.samples = static_cast<std::uint32_t>(setting.samples);
  Store(setting.colour / static_cast<double>(setting.samples), data.rgb);
}

// Two unit vectors across a unit vector.
template <typename Real>
void StoreAcross(const glm::dvec3& axis, double length, LightData<Real>& data) {
  const scalar::Frame<double> frame(ToVec3(axis));
  Store(ToGlm(frame.x) * length, data.across_u);
  Store(ToGlm(frame.y) * length, data.across_v);
}

template <typename Real>
void StoreSource(const DirectionalLight& sun, const LightSetting& setting, LightData<Real>& data) {
  const glm::dvec3 toward = -Unit(sun.direction);
  data.kind = LightKind::kDirectional;
  Store(setting.colour, data.rgb);
  Store(toward, data.vector);
  data.falloff[0] = 1;
  if (!(sun.angle > 0)) return;
  StoreShape(LightShape::kSun, setting, data);
  StoreAcross(toward, 1, data);
  // 1 - cos a is 2 sin^2 (a / 2); sin a is cos (90 - a).
  const double sine = StrictCosDegrees(90 - sun.angle / 4);
  data.extent = static_cast<Real>(2 * sine * sine);
}

// The colour in placed lengths: from afar it gives intensity over the square of the distance.
LightSetting PlacedSetting(const LightSetting& setting) {
  LightSetting placed = setting;
  placed.colour *= setting.placement.scale * setting.placement.scale;
  return placed;
}

template <typename Real>
void StoreSource(const RectangleLight& rectangle, const LightSetting& setting,
                 LightData<Real>& data) {
  const ScenePlacement& placement = setting.placement;
  data.kind = LightKind::kPointFromSurface;
  StoreShape(LightShape::kRectangle, PlacedSetting(setting), data);
  Store(placement.Point(rectangle.center), data.vector);
  Store(rectangle.u * placement.scale, data.across_u);
  Store(rectangle.v * placement.scale, data.across_v);
  Store(Unit(CrossOf(Unit(rectangle.u), Unit(rectangle.v))), data.axis);
}

template <typename Real>
void StoreSource(const DiskLight& disk, const LightSetting& setting, LightData<Real>& data) {
  const ScenePlacement& placement = setting.placement;
  const glm::dvec3 axis = Unit(disk.direction);
  data.kind = LightKind::kPointFromSurface;
  StoreShape(LightShape::kDisk, PlacedSetting(setting), data);
  Store(placement.Point(disk.center), data.vector);
  StoreAcross(axis, placement.Length(disk.radius), data);
  Store(axis, data.axis);
}

template <typename Real>
void StoreSource(const SphereLight& sphere, const LightSetting& setting, LightData<Real>& data) {
  const ScenePlacement& placement = setting.placement;
  data.kind = LightKind::kPointFromSurface;
  StoreShape(LightShape::kSphere, PlacedSetting(setting), data);
  Store(placement.Point(sphere.center), data.vector);
  data.extent = static_cast<Real>(placement.Length(sphere.radius));
}

template <typename Real>
void StoreSource(const PointLight& point, const LightSetting& setting, LightData<Real>& data) {
  const PointBounds& bounds = setting.bounds;
  const Vec3d position = setting.placement.Point(point.position);
  const double diameter = LengthOf(bounds.high - bounds.low);
  const bool is_near =
      Reach(bounds, position) <= kMaxLightDiameters * diameter;  // false without objects
  Falloff falloff = point.falloff;
  Colour colour = setting.colour;
  PlaceFalloff(setting.placement, falloff, colour);
  Store(colour, data.rgb);
  data.kind = is_near ? LightKind::kPointFromLight : LightKind::kPointFromSurface;
  Store(position, data.vector);
  data.falloff[0] = static_cast<Real>(falloff.constant);
  data.falloff[1] = static_cast<Real>(falloff.linear);
  data.falloff[2] = static_cast<Real>(falloff.quadratic);
  if (!point.cone) return;
  data.is_spot = 1;
  Store(Unit(point.cone->direction), data.axis);
  // cos * scale + offset is 1 at the inner angle and 0 at the outer.
  const double inner = StrictCosDegrees(point.cone->inner);
  const double outer = StrictCosDegrees(point.cone->outer);
  const double scale = 1 / std::max(inner - outer, kLeastConeRim);
  data.cone_scale = static_cast<Real>(scale);
  data.cone_offset = static_cast<Real>(-outer * scale);
}

}  // namespace

template <typename Real>
LightData<Real> CompileLight(const Light& light, const Settings& settings,
                             const ScenePlacement& placement, const PointBounds& bounds) {
  LightData<Real> data{};
  data.casts_shadows = light.casts_shadows;
  const LightSetting setting{placement, bounds,
                             light.colour * (light.intensity * settings.exposure), light.samples};
  const auto store = [&](const auto& source) { StoreSource(source, setting, data); };
  Match(
      light.source, [&](const PointLight& point) { store(point); },
      [&](const DirectionalLight& sun) { store(sun); },
      [&](const RectangleLight& rectangle) { store(rectangle); },
      [&](const DiskLight& disk) { store(disk); },
      [&](const SphereLight& sphere) { store(sphere); });
  return data;
}

template <typename Real>
void ShrinkToMiddle(LightData<Real>& light) {
  if (light.shape == LightShape::kPoint) return;
  for (int i = 0; i < 3; ++i) {
    light.rgb[i] *= static_cast<Real>(light.samples);
    if (light.shape != LightShape::kSun) light.across_u[i] = light.across_v[i] = 0;
  }
  light.samples = 1;
  light.extent = 0;
}

template LightData<float> CompileLight(const Light&, const Settings&, const ScenePlacement&,
                                       const PointBounds&);
template LightData<double> CompileLight(const Light&, const Settings&, const ScenePlacement&,
                                        const PointBounds&);
template void ShrinkToMiddle(LightData<float>&);
template void ShrinkToMiddle(LightData<double>&);

}  // namespace sheaf
