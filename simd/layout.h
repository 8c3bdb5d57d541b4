// Plain views of everything a kernel reads or writes: streams, geometry, materials, lights, camera.
//
// Layout: structure of arrays, one pointer a field. Owning arrays are aligned to kAlignment; a view
//   may start anywhere in them, so kernels assume no alignment.
// Padding: a stream of `n` elements owns StreamCapacity(n) of each field. Kernels load and store
//   whole vectors: lanes past the count may hold anything on entry and anything on return.
// Aliasing: the fields of a view never overlap, and no output overlaps an input.
// NaN: allowed everywhere in rays; such a ray misses (src/scalar/ray.h).
// Colours are never -0: a sum of them is then the same whether it starts at 0 or at the first.
// `Real` is float or double; identifiers are 32 bit in both.
#ifndef SHEAF_SIMD_LAYOUT_H_
#define SHEAF_SIMD_LAYOUT_H_

#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <utility>

namespace sheaf {

inline constexpr std::size_t kAlignment = 64;
// Kernels use at most this many lanes, whatever the target offers.
inline constexpr std::uint32_t kMaxLanes = 16;

constexpr std::uint32_t PaddedCount(std::uint32_t n) {
  return (n + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
}
// One vector more than padded, because compaction stores a whole vector at any offset below n.
constexpr std::uint32_t StreamCapacity(std::uint32_t n) { return PaddedCount(n) + kMaxLanes; }

// Primitive ids are positions in the input order, below kNoPrimitive.
inline constexpr std::uint32_t kNoPrimitive = 0x7fffffffu;
// A ray's `source` is the primitive it starts on. A triangle or a sphere that is the source is
// never hit, unless this bit says that the ray runs inside the sphere: then its far root alone
// counts.
inline constexpr std::uint32_t kInsideBit = 0x80000000u;

// A hit at t counts where t_min <= t <= t_max and t is finite. By default t_min is the smallest
// positive number, so that a hit at exactly 0 does not count, and t_max the largest finite one.
template <typename Real>
inline constexpr Real kDefaultTMin = std::numeric_limits<Real>::denorm_min();
template <typename Real>
inline constexpr Real kDefaultTMax = std::numeric_limits<Real>::max();

// The intervals of a batch of rays: an array where each ray has its own, else one value for all.
template <typename Real>
struct RayIntervals {
  const Real* t_min = nullptr;
  const Real* t_max = nullptr;
  Real all_t_min = kDefaultTMin<Real>;
  Real all_t_max = kDefaultTMax<Real>;
};

// ---- Streams ----
// A stream is declared once, over what a field is: an owning array, a pointer or a const pointer.

template <typename T>
using MutableField = T*;
template <typename T>
using ConstField = const T*;

// What TraceClosest and TraceOccluded read of a ray.
template <typename Real, template <typename> class Field>
struct RayFields {
  Field<Real> origin_x, origin_y, origin_z;
  Field<Real> direction_x, direction_y, direction_z;  // any length
  Field<std::uint32_t> source;  // kNoPrimitive: none; a null pointer: none for all

  static constexpr auto kFields = std::make_tuple(
      &RayFields::origin_x, &RayFields::origin_y, &RayFields::origin_z, &RayFields::direction_x,
      &RayFields::direction_y, &RayFields::direction_z, &RayFields::source);
};

// What the schedule keeps of a ray besides: where its light goes, and how much of it.
template <typename Real, template <typename> class Field>
struct PathFields {
  Field<std::uint32_t> pixel;                // index into the tile
  Field<std::uint32_t> parent;               // position in the stream that spawned it
  Field<Real> weight_r, weight_g, weight_b;  // throughput since the eye

  static constexpr auto kFields =
      std::make_tuple(&PathFields::pixel, &PathFields::parent, &PathFields::weight_r,
                      &PathFields::weight_g, &PathFields::weight_b);
};

// What TraceClosest writes: t, the primitive's id (kNoPrimitive: a miss, then t is t_max and u, v
// are 0) and parameters of the hit. Triangle: barycentric weights of the second and third vertex.
// Sphere: u is 0 where the ray enters and 1 where it leaves; v is what rounding took from t, so
// that t + v is the root to twice the bits of float (0 in double and in fast arithmetic).
template <typename Real, template <typename> class Field>
struct HitFields {
  Field<Real> t, u, v;
  Field<std::uint32_t> primitive;

  static constexpr auto kFields =
      std::make_tuple(&HitFields::t, &HitFields::u, &HitFields::v, &HitFields::primitive);
};

// A point to be shaded.
template <typename Real, template <typename> class Field>
struct SurfaceFields {
  Field<Real> position_x, position_y, position_z;
  Field<Real> normal_x, normal_y, normal_z;  // shading normal: unit, on the face's side
  Field<Real> face_x, face_y, face_z;  // the face's own normal: unit, facing the ray; these fields
                                       // may be the normal's where the two are one
  Field<Real> direction_x, direction_y, direction_z;  // of the ray, unit
  Field<Real> u, v;                                   // surface coordinates, 0 on spheres
  Field<Real> tint_r, tint_g, tint_b;  // what the base colour is multiplied with, point by point
  Field<Real> offset;           // along the normal; takes a secondary ray past every rounding error
  Field<std::uint32_t> source;  // primitive id, with kInsideBit where the ray hit the back side
  Field<std::uint32_t> ray;     // position in the ray stream

  // What few scenes have comes last, so that arrays that are used together lie together.
  static constexpr auto kFields = std::make_tuple(
      &SurfaceFields::position_x, &SurfaceFields::position_y, &SurfaceFields::position_z,
      &SurfaceFields::normal_x, &SurfaceFields::normal_y, &SurfaceFields::normal_z,
      &SurfaceFields::direction_x, &SurfaceFields::direction_y, &SurfaceFields::direction_z,
      &SurfaceFields::u, &SurfaceFields::v, &SurfaceFields::offset, &SurfaceFields::source,
      &SurfaceFields::ray, &SurfaceFields::face_x, &SurfaceFields::face_y, &SurfaceFields::face_z,
      &SurfaceFields::tint_r, &SurfaceFields::tint_g, &SurfaceFields::tint_b);
};

// Linear RGB, one an element.
template <typename Real, template <typename> class Field>
struct ColourFields {
  Field<Real> r, g, b;

  static constexpr auto kFields =
      std::make_tuple(&ColourFields::r, &ColourFields::g, &ColourFields::b);
};

template <typename Real>
using RayView = RayFields<Real, ConstField>;
template <typename Real>
using RayOutput = RayFields<Real, MutableField>;
template <typename Real>
using PathView = PathFields<Real, ConstField>;
template <typename Real>
using PathOutput = PathFields<Real, MutableField>;
template <typename Real>
using HitView = HitFields<Real, ConstField>;
template <typename Real>
using HitOutput = HitFields<Real, MutableField>;
template <typename Real>
using SurfaceView = SurfaceFields<Real, ConstField>;
template <typename Real>
using SurfaceOutput = SurfaceFields<Real, MutableField>;
template <typename Real>
using ColourView = ColourFields<Real, ConstField>;
template <typename Real>
using ColourOutput = ColourFields<Real, MutableField>;

// Calls f(field of a, field of b) for the fields of two instances of one stream, in order.
template <typename A, typename B, typename F>
constexpr void ForEachField(A& a, B& b, F f) {
  constexpr std::size_t kCount = std::tuple_size_v<decltype(A::kFields)>;
  [&]<std::size_t... kIndex>(std::index_sequence<kIndex...>) {
    (f(a.*std::get<kIndex>(A::kFields), b.*std::get<kIndex>(B::kFields)), ...);
  }
  (std::make_index_sequence<kCount>());
}
template <typename A, typename F>
constexpr void ForEachField(A& a, F f) {
  std::apply([&](auto... member) { (f(a.*member), ...); }, A::kFields);
}

// A list of hits that are treated alike: positions in the ray stream, and what each ray hit there.
struct HitBatch {
  const std::uint32_t* ray;
  const std::uint32_t* local;      // index into the spheres, or into the triangles
  const std::uint32_t* primitive;  // id
  std::uint32_t count;
};

// ---- Geometry ----

template <typename Real>
struct SphereArrays {
  std::uint32_t count;
  const Real *center_x, *center_y, *center_z;
  const Real* radius;  // NaN: never hit (stands for radius 0)
  const std::uint32_t* id;
};

template <typename Real>
struct TriangleArrays {
  std::uint32_t count;
  const Real* vertex[3][3];  // [vertex][axis]; NaN: never hit (stands for zero area)
  const Real* uv[3][2];      // [vertex][u or v]; null where no material asks for coordinates
  // Null where no mesh has them. A normal of 0, or a mean of 0, stands for the face's own; a colour
  // of 1 for none. Normals have any length and either side.
  const Real* normal[3][3];  // [vertex][axis]
  const Real* colour[3][3];  // [vertex][channel]
  const std::uint32_t* id;
};

// Spheres and triangles share one range of ids.
template <typename Real>
struct GeometryView {
  SphereArrays<Real> spheres;
  TriangleArrays<Real> triangles;
};

// ---- The tree ----
// A bounding volume hierarchy of eight children a node over spheres and triangles together. A child
// is an inner node or a leaf of one kind of primitive, so that the kind is asked once a leaf.

inline constexpr std::uint32_t kTreeWidth = 8;
inline constexpr std::uint32_t kMaxLeafSize = 8;
inline constexpr std::uint32_t kMaxTreePrimitives = 1u << 26;  // of each kind
// Levels of nodes at most, the root's included, whatever the scene: a traversal's stack is an
// array. A depth-first walk leaves at most seven children a level behind.
inline constexpr std::uint32_t kMaxTreeDepth = 48;
inline constexpr std::uint32_t kTreeStackSize = kMaxTreeDepth * (kTreeWidth - 1) + 1;

// A child: the index of a node, or a leaf as its kind, size and first position in the kind's
// blocks. kNoChild is a leaf to no one: its box is empty.
inline constexpr std::uint32_t kLeafBit = 0x80000000u;
inline constexpr std::uint32_t kTriangleLeafBit = 0x40000000u;
inline constexpr std::uint32_t kNoChild = 0xffffffffu;
constexpr std::uint32_t MakeLeaf(std::uint32_t kind_bit, std::uint32_t first, std::uint32_t count) {
  return kLeafBit | kind_bit | (count - 1) << 26 | first;
}
constexpr bool IsLeaf(std::uint32_t child) { return (child & kLeafBit) != 0; }
constexpr bool IsTriangleLeaf(std::uint32_t child) { return (child & kTriangleLeafBit) != 0; }
constexpr std::uint32_t LeafFirst(std::uint32_t child) { return child & (kMaxTreePrimitives - 1); }
constexpr std::uint32_t LeafCount(std::uint32_t child) { return (child >> 26 & 7u) + 1; }

// Four cache lines. An absent child has lower = +max and upper = -max: no ray meets it.
struct alignas(kAlignment) TreeNode {
  float bounds[6][kTreeWidth];  // lower x, y, z, upper x, y, z of each child
  std::uint32_t child[kTreeWidth];
  // By the signs of a direction (bit k: axis k is negative): the children from front to back, four
  // bits each, the first in the lowest.
  std::uint32_t order[8];
};
static_assert(sizeof(TreeNode) == 256);

// Boxes of primitives are grown by this part of their extent on each side before they enter the
// tree, and box tests by as much relatively (docs/numerics.md): the box of a primitive then
// contains every hit of it as computed, not only as real.
inline constexpr float kBoxGrowth = 0x1p-20f;

// Box tests hold for rays and trees within these limits; other rays are tested against every
// primitive. No product of a box test then overflows, nor does one lose its bits.
inline constexpr float kMaxBoxCoordinate = 0x1p39f;  // of origins and of the tree's bounds
inline constexpr float kMinBoxDirection = 0x1p-67f;  // of a direction's largest component
inline constexpr float kMaxBoxDirection = 0x1p67f;
// A direction's components are taken for at least this part of the largest, so that none is zero;
// the box then gives way by twice as much of the ray's reach.
inline constexpr float kMinBoxSlope = 0x1p-20f;
// A box gives way by this part of the origin's coordinates, and a little for origins near zero.
inline constexpr float kBoxOriginSlack = 0x1p-22f;
inline constexpr float kBoxAbsoluteSlack = 0x1p-70f;
// The far side of an interval moves out by this factor. Twice kBoxGrowth, for both sides.
inline constexpr float kBoxFarFactor = 1 + 2 * kBoxGrowth;

// A leaf block of n primitives that begins at position `first` holds n numbers of each field in
// turn: triangles from 9 * first (vertex 0 x, y, z, vertex 1 x, ...), spheres from 4 * first
// (center x, y, z, radius). Blocks lie without gaps; a whole vector may be read at the last field.
template <typename Real>
struct TreeView {
  const TreeNode* nodes;     // the root first
  std::uint32_t node_count;  // 0: no primitives
  std::uint32_t triangle_count, sphere_count;
  const Real* triangles;
  const Real* spheres;
  const std::uint32_t* triangle_id;  // primitive id by position
  const std::uint32_t* sphere_id;
  float lower[3], upper[3];  // of all boxes; lower > upper without primitives
  bool skips_boxes;  // so few primitives that boxes pay for tiles alone; set where there is no node
};

// Whether box tests hold for the tree.
template <typename Real>
constexpr bool IsWithinBoxLimits(const TreeView<Real>& tree) {
  bool is_within = true;
  for (int axis = 0; axis < 3; ++axis) {
    is_within &= -tree.lower[axis] <= kMaxBoxCoordinate && tree.upper[axis] <= kMaxBoxCoordinate;
  }
  return is_within;
}

// The same surfaces where no normal but the face's own is used.
template <typename Real>
SurfaceView<Real> WithoutFaces(SurfaceView<Real> surfaces) {
  surfaces.face_x = surfaces.normal_x;
  surfaces.face_y = surfaces.normal_y;
  surfaces.face_z = surfaces.normal_z;
  return surfaces;
}

// What is asked of a ray: its nearest hit, or whether there is any.
enum class Query { kClosest, kOccluded };

// What a caller knows of a batch of rays. It may steer the choice of a kernel, never a result.
enum class Coherence {
  kUnknown,       // measured, packet by packet
  kCommonOrigin,  // the same, but no common direction is looked for
  kCoherent,      // neighbours go similar ways from different origins: packets as they come
  kIncoherent,    // neighbours go different ways: sorted by direction before anything else
};

// ---- What a frame is shaded with ----

enum class BaseColour : std::uint32_t { kConstant, kChecker, kTexture };

// What a material asks for; what it does not ask for is skipped. Asking for more changes no bit.
inline constexpr std::uint32_t kNeedsCoordinates = 1;    // u and v, for its base colour
inline constexpr std::uint32_t kNeedsLights = 2;         // diffuse or highlight
inline constexpr std::uint32_t kNeedsHighlight = 4;      // a power for each light
inline constexpr std::uint32_t kNeedsChildren = 8;       // reflected or refracted rays
inline constexpr std::uint32_t kNeedsTransmission = 16;  // Fresnel's split
inline constexpr std::uint32_t kNeedsNormals = 32;       // shading normals besides the faces'
inline constexpr std::uint32_t kNeedsTint = 64;          // a texture, or colours of vertices
inline constexpr std::uint32_t kNeedsAll = 127;

template <typename Real>
struct MaterialData {
  std::uint32_t needs;  // NeedsOf(*this), or more
  BaseColour kind;
  std::uint32_t texture;  // index into the frame's textures; of kTexture alone
  Real even[3], odd[3];   // linear RGB; the same where there is no checker
  Real cells[2];          // checker cells across the unit interval of u and of v
  Real ambient[3];        // ka times the ambient light
  Real emission[3];       // added as it is
  Real kd, ks, shininess;
  Real reflect[3], transmit[3];
  Real ior;
};

template <typename Real>
constexpr bool AnyPositive(const Real (&c)[3]) {
  return c[0] > 0 || c[1] > 0 || c[2] > 0;
}

template <typename Real>
constexpr std::uint32_t NeedsOf(const MaterialData<Real>& material) {
  const bool transmits = AnyPositive(material.transmit);
  return (material.kind != BaseColour::kConstant ? kNeedsCoordinates : 0) |
         (material.kd > 0 || material.ks > 0 ? kNeedsLights : 0) |
         (material.ks > 0 ? kNeedsHighlight : 0) |
         (material.kind == BaseColour::kTexture ? kNeedsTint : 0) |
         (transmits || AnyPositive(material.reflect) ? kNeedsChildren : 0) |
         (transmits ? kNeedsTransmission : 0);
}

// How a texture goes on beyond the unit interval of a surface coordinate.
enum class Wrap : std::uint32_t { kRepeat, kMirror, kClamp };
enum class Filter : std::uint32_t { kNearest, kLinear };

// Rows from the top, where v is 0; a texel's channels are the bytes of its number from the lowest:
// r, g, b, a.
template <typename Real>
struct TextureData {
  const std::uint32_t* texels;
  int width, height;   // in [1, kMaxTextureSide]
  const Real* decode;  // linear light by byte, 256 of them
  Wrap wrap_u, wrap_v;
  Filter filter;
};
inline constexpr int kMaxTextureSide = 16384;

enum class LightKind : std::uint32_t {
  kPointFromLight,    // shadow rays run from the light, so that a batch shares its origin
  kPointFromSurface,  // a light so far away that rounding there would reach the surface
  kDirectional,
};

template <typename Real>
struct LightData {
  LightKind kind;
  Real vector[3];   // position, or the unit vector toward a directional light
  Real rgb[3];      // colour * intensity * exposure
  Real falloff[3];  // kc, kl, kq; 1, 0, 0 for directional lights
  std::uint32_t casts_shadows;
  // A spot light's cone: light is scaled by the square of cone_scale * cos + cone_offset, clamped
  // to [0, 1], with cos of the angle between `axis`, the unit vector it shines along, and the ray
  // to the surface.
  std::uint32_t is_spot = 0;
  Real axis[3] = {};
  Real cone_scale = 0, cone_offset = 0;
};

// Pixel (x, y) sampled at (sx, sy) in [0, 1)^2 lies at a = (x + sx) - half_width steps to the right
// and b = half_height - (y + sy) steps up.
template <typename Real>
struct CameraData {
  std::uint32_t orthographic;
  Real eye[3], forward[3];       // forward is a unit vector
  Real right[3], up[3];          // a pixel's step on the plane one unit ahead, or in scene units
  Real half_width, half_height;  // pixels
};

// How many children surfaces have.
struct SpawnCounts {
  std::uint32_t reflected, refracted;
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_LAYOUT_H_
