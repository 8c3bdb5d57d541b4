// Everything that the rays of one frame read, as plain views: what scene compilation leaves.
#ifndef SHEAF_STREAM_FRAME_VIEW_H_
#define SHEAF_STREAM_FRAME_VIEW_H_

#include <span>

#include "simd/instances.h"
#include "simd/shading.h"
#include "simd/tree.h"

namespace sheaf {

struct PrimitiveInfo {
  std::uint32_t place;     // its kind and its index among the kind's arrays: MakePlace
  std::uint32_t material;  // index into the materials

  PrimitiveKind kind() const { return KindOf(place); }
  std::uint32_t index() const { return IndexIn(place); }
};

enum class EnvironmentKind { kColour, kGradient, kMap };

// What rays see that leave the scene: src/scalar/environment.h.
template <typename Real>
struct EnvironmentData {
  EnvironmentKind kind = EnvironmentKind::kColour;
  Real zenith[3] = {}, horizon[3] = {}, nadir[3] = {};
  const float* rgb = nullptr;  // of a map, 3 * width * height
  int width = 0, height = 0;
  Real strength = 0;
  Real turns = 0;  // of the map, counter-clockwise seen from +y
};

template <typename Real>
struct FrameView {
  GeometryView<Real> geometry;                // what surfaces are read from
  TreeView<Real> tree;                        // over it: what rays are traced against
  std::span<const PrimitiveInfo> primitives;  // by primitive id
  std::span<const std::uint32_t> object_of_primitive;
  std::span<const MaterialData<Real>> materials;
  std::span<const TextureData<Real>> textures;
  std::span<const LightData<Real>> lights;
  std::span<const Real> sample_x, sample_y;  // in [0, 1), one an element of the sample pattern
  CameraData<Real> camera;
  Real background[3];  // where the environment is one colour
  EnvironmentData<Real> environment;
  int max_depth;
  int width, height;  // of the whole picture
  // Adaptive sampling: the contrast that is an edge (src/scalar/first_hit.h); NaN: all samples
  // everywhere.
  Real contrast;
  Real min_throughput;        // secondary rays of no more are not traced; 0: of none
  bool passes_light;          // whether any material lets light pass
  bool attenuates;            // whether any takes light inside
  Real length_unit;           // the user's lengths in one of the geometry's; a power of two
  PixelCone<Real> cone = {};  // of primary rays
  // Whether a light, a lens or a rough surface is drawn from, or paths are followed.
  bool is_distributed = false;
  bool follows_paths = false;  // one ray of each surface alone

  // What stands in many places besides the geometry's own primitives, whose triangles, spheres and
  // disks the geometry has too; and the way back of each instance's map.
  InstanceTree<Real> instances = {};
  const AffineMap* to_world = nullptr;

  Real error = 0;  // that a pixel's mean may have, above 0; 0: all samples are taken

  bool has_instances() const { return instances.node_count > 0; }
  bool converges() const { return error > 0 && sample_x.size() > 1; }
  bool is_adaptive() const { return contrast >= 0 && sample_x.size() > 1; }
};

}  // namespace sheaf

#endif  // SHEAF_STREAM_FRAME_VIEW_H_
