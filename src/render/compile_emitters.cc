#include "src/render/compile_emitters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "src/core/vec3.h"

namespace sheaf {
namespace {

// One number chooses an emitter and a place on it: of the 24 bits of a float so many are left for
// the place. Where there are more emitters, rays find them alone.
constexpr std::size_t kMostEmitters = 1 << 16;

// The end of a shadow ray lies this many roundoffs of the corners above the lamp, and more by its
// length: more than rounding carries the point that was drawn.
constexpr double kEndRoundoffs = 64;

// Whether all that rays see of it, from both sides and at every point, is its emission.
template <typename Real>
bool Shines(const MaterialData<Real>& material) {
  const FinishData<Real>& finish = material.finish;
  return AnyPositive(material.emission) && finish.emission == kNoTexture &&
         finish.alpha == AlphaUse::kOpaque && !AnyPositive(material.transmit);
}

// The mean of the channels: what emitters are drawn by.
template <typename Real>
double PowerOf(const MaterialData<Real>& material) {
  const auto light = FromArray(material.emission).template To<double>();
  return (light.x + light.y + light.z) / 3;
}

// Walker's table by Vose's method: thresholds and aliases of even cells.
template <typename Real>
void FillAliases(const std::vector<double>& weights, double all, EmitterTable<Real>& table) {
  const std::size_t n = weights.size();
  std::vector<double> share(n);
  std::vector<std::size_t> small, large;
  for (std::size_t i = 0; i < n; ++i) {
    share[i] = weights[i] / all * static_cast<double>(n);
    (share[i] < 1 ? small : large).push_back(i);
  }
  table.threshold.assign(n, Real(1));
  table.alias.resize(n);
  for (std::size_t i = 0; i < n; ++i) table.alias[i] = static_cast<Real>(i);
  while (!small.empty() && !large.empty()) {
    const std::size_t low = small.back(), high = large.back();
    small.pop_back();
    table.threshold[low] = static_cast<Real>(share[low]);
    table.alias[low] = static_cast<Real>(high);
    share[high] -= 1 - share[low];
    if (share[high] < 1) {
      large.pop_back();
      small.push_back(high);
    }
  }
}

template <typename Real>
void Show(EmitterTable<Real>& table) {
  EmitterView<Real>& view = table.view;
  view.count = static_cast<std::uint32_t>(table.offset.size());
  for (int axis = 0; axis < 3; ++axis) {
    view.corner[axis] = table.corner[axis].data();
    view.edge1[axis] = table.edge1[axis].data();
    view.edge2[axis] = table.edge2[axis].data();
    view.normal[axis] = table.normal[axis].data();
    view.rgb[axis] = table.rgb[axis].data();
  }
  view.offset = table.offset.data();
  view.density = table.density.data();
  view.threshold = table.threshold.data();
  view.alias = table.alias.data();
}

}  // namespace

template <typename Real>
void CompileEmitters(const CompiledGeometry<Real>& geometry,
                     std::span<MaterialData<Real>> materials, EmitterTable<Real>& table) {
  const TriangleArrays<Real> triangles = geometry.data.arrays.view().triangles;
  std::vector<double> powers;
  std::vector<std::uint32_t> material_of;
  double all = 0;
  const auto push = [](std::vector<Real>(&to)[3], const Vec3<double>& v) {
    for (int axis = 0; axis < 3; ++axis) to[axis].push_back(static_cast<Real>(v[axis]));
  };
  for (const PrimitiveInfo& primitive : geometry.primitives) {
    // Those of groups stand elsewhere.
    if (primitive.kind() != PrimitiveKind::kTriangle ||
        primitive.index() >= geometry.data.own[PrimitiveKind::kTriangle]) {
      continue;
    }
    const MaterialData<Real>& material = materials[primitive.material];
    if (!Shines(material)) continue;
    const auto vertex = [&](int corner) {
      const auto at = [&](int axis) {
        return static_cast<double>(triangles.vertex[corner][axis][primitive.index()]);
      };
      return Vec3<double>{at(0), at(1), at(2)};
    };
    const Vec3<double> a = vertex(0), b = vertex(1), c = vertex(2);
    const Vec3<double> across = Cross(b - a, c - a);
    const double twice = std::sqrt(Dot(across, across));
    if (!(twice > 0)) continue;  // NaN: never hit
    push(table.corner, a);
    push(table.edge1, b - a);
    push(table.edge2, c - a);
    push(table.normal, across / twice);
    double size = 0;
    for (const Vec3<double>& p : {a, b, c}) {
      size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    constexpr double kRoundoffOf = static_cast<double>(std::numeric_limits<Real>::epsilon()) / 2;
    table.offset.push_back(static_cast<Real>(kEndRoundoffs * kRoundoffOf * size));
    powers.push_back(PowerOf(material) * twice / 2);
    material_of.push_back(primitive.material);
    all += powers.back();
  }
  if (powers.empty() || powers.size() > kMostEmitters) return;
  for (const std::uint32_t i : material_of) {
    MaterialData<Real>& material = materials[i];
    const double density = PowerOf(material) / all;
    material.emitter_density = static_cast<Real>(density);
    table.density.push_back(material.emitter_density);
    const auto light = FromArray(material.emission).template To<double>();
    push(table.rgb, light / (density * std::numbers::pi));
  }
  FillAliases(powers, all, table);
  Show(table);
}

template void CompileEmitters(const CompiledGeometry<float>&, std::span<MaterialData<float>>,
                              EmitterTable<float>&);
template void CompileEmitters(const CompiledGeometry<double>&, std::span<MaterialData<double>>,
                              EmitterTable<double>&);

}  // namespace sheaf
