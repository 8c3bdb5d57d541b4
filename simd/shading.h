// What a frame is shaded with: materials, textures, lights and the camera, as kernels read them.
#ifndef SHEAF_SIMD_SHADING_H_
#define SHEAF_SIMD_SHADING_H_

#include <cstddef>
#include <cstdint>

namespace sheaf {

enum class BaseColour : std::uint32_t { kConstant, kChecker, kFilteredChecker, kTexture };

// What a material asks for; what it does not ask for is skipped. Asking for more changes no bit.
inline constexpr std::uint32_t kNeedsCoordinates = 1;    // u and v, for its base colour
inline constexpr std::uint32_t kNeedsLights = 2;         // diffuse or highlight
inline constexpr std::uint32_t kNeedsHighlight = 4;      // a power for each light
inline constexpr std::uint32_t kNeedsChildren = 8;       // reflected or refracted rays
inline constexpr std::uint32_t kNeedsTransmission = 16;  // Fresnel's split
inline constexpr std::uint32_t kNeedsNormals = 32;       // shading normals besides the faces'
inline constexpr std::uint32_t kNeedsTint = 64;          // a texture, or colours of vertices
inline constexpr std::uint32_t kNeedsAll = 127;
// Shading terms that vary from point to point: SurfaceFields has them. Not among all, because it is
// the material's textures that make them.
inline constexpr std::uint32_t kNeedsTerms = 128;
// The width of a ray's cone where it meets the surface, and how much of the surface coordinates
// that covers: src/scalar/footprint.h. Not among all either: textures and checkers make them.
inline constexpr std::uint32_t kNeedsWidth = 256;
inline constexpr std::uint32_t kNeedsFootprint = 512;  // comes with the width
// Random numbers for its rays, which a frame asks for that has something to draw from.
inline constexpr std::uint32_t kNeedsSeed = 1024;
// Normals drawn for rough mirrors and interfaces: src/scalar/microfacet.h.
inline constexpr std::uint32_t kNeedsGloss = 2048;
// One of its rays alone: src/scalar/choose_lobe.h.
inline constexpr std::uint32_t kNeedsChoice = 4096;
// The alpha of vertices. Comes with the terms; meshes make it.
inline constexpr std::uint32_t kNeedsVertexAlpha = 8192;
inline constexpr std::uint32_t kNeedsSecondSet = 16384;  // of coordinates; textures make it

// A table of gloss has kGlossEntries numbers for rays that arrive from outside, for square roots of
// cosines from 0 to 1 in kGlossSteps steps, then as many for rays from inside. Where slopes vary in
// width kGlossRows of these follow one another, for square roots of widths from 0 to 1.
inline constexpr int kGlossSteps = 64;
inline constexpr int kGlossEntries = kGlossSteps + 2;  // the last twice, to be read beside 1
inline constexpr int kGlossRowSteps = 32;
inline constexpr int kGlossRows = kGlossRowSteps + 2;  // likewise

inline constexpr std::uint32_t kNoTexture = ~std::uint32_t{0};
enum class AlphaUse : std::uint32_t { kOpaque, kMask, kBlend };

// What textures say of a material point by point, besides its base colour: src/scalar/finish.h.
template <typename Real>
struct FinishData {
  // Indices into the frame's textures.
  std::uint32_t emission = kNoTexture, metallic_roughness = kNoTexture, occlusion = kNoTexture,
                transmission = kNoTexture, normals = kNoTexture;
  // Whether metal and roughness make the terms, with or without a texture, and whether their
  // mirrors have facets that are drawn, whose slopes vary in width.
  bool is_glossy = false, has_facets = false;
  Real metallic = 0, roughness = 0, specular = 1;
  Real occlusion_strength = 0, transmission_share = 0, normal_scale = 0;
  AlphaUse alpha = AlphaUse::kOpaque;
  Real alpha_factor = 1, alpha_cutoff = 0;
};

// Whether lights ask about the surface that smooth normals stand for.
constexpr bool NeedsCurves(std::uint32_t needs) {
  return (needs & kNeedsNormals) != 0 && (needs & kNeedsLights) != 0;
}

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
  Real passes[3];  // of a light behind: `transmit`, or 0 where shadows are opaque
  Real ior;
  // Of microfacets: the width of their slopes, 0 for a smooth surface, and what takes the place of
  // light that they send to one another: a table of gloss, of several rows with has_facets.
  Real slope_width = 0;
  const Real* gloss = nullptr;
  // With which its triangles are drawn as a light, by area; 0: they are not.
  Real emitter_density = 0;
  bool attenuates;  // whether light is taken inside
  Real attenuation[3], attenuation_distance;
  FinishData<Real> finish;
};

template <typename Real>
constexpr bool AnyPositive(const Real (&c)[3]) {
  return c[0] > 0 || c[1] > 0 || c[2] > 0;
}

// What the textures besides that of the base colour ask for.
template <typename Real>
constexpr std::uint32_t NeedsOf(const FinishData<Real>& finish) {
  const bool is_glossy = finish.is_glossy;
  const bool has_alpha = finish.alpha != AlphaUse::kOpaque;
  const bool varies = is_glossy || has_alpha || finish.emission != kNoTexture ||
                      finish.occlusion != kNoTexture || finish.transmission != kNoTexture;
  const bool is_bumpy = finish.normals != kNoTexture;
  return (varies ? kNeedsTerms | kNeedsCoordinates : 0) |
         (is_bumpy ? kNeedsNormals | kNeedsCoordinates : 0) |
         (is_glossy ? kNeedsLights | kNeedsHighlight | kNeedsChildren : 0) |
         (finish.has_facets ? kNeedsGloss : 0) |
         (has_alpha ? kNeedsChildren | kNeedsTransmission : 0);
}

// Whether its rays are mirrored and bent at facets that are drawn. They may be smooth at a point.
template <typename Real>
constexpr bool HasFacets(const MaterialData<Real>& material) {
  return material.slope_width > 0 || material.finish.has_facets;
}

template <typename Real>
constexpr std::uint32_t NeedsOf(const MaterialData<Real>& material) {
  const bool transmits = AnyPositive(material.transmit);
  return NeedsOf(material.finish) |
         (material.kind != BaseColour::kConstant ? kNeedsCoordinates : 0) |
         (material.kd > 0 || material.ks > 0 ? kNeedsLights : 0) |
         (material.ks > 0 ? kNeedsHighlight : 0) |
         (material.kind == BaseColour::kTexture ? kNeedsTint : 0) |
         (material.kind == BaseColour::kFilteredChecker ? kNeedsFootprint | kNeedsWidth : 0) |
         (transmits || AnyPositive(material.reflect) ? kNeedsChildren : 0) |
         (HasFacets(material) ? kNeedsGloss : 0) | (transmits ? kNeedsTransmission : 0);
}

// Whether some of a light goes on behind the surface.
template <typename Real>
constexpr bool LetsLightPass(const MaterialData<Real>& material) {
  return material.finish.alpha != AlphaUse::kOpaque || AnyPositive(material.passes);
}

// How a texture goes on beyond the unit interval of a surface coordinate.
enum class TextureWrap : std::uint32_t { kRepeat, kMirror, kClamp };
enum class TextureFilter : std::uint32_t { kNearest, kLinear };

inline constexpr int kMaxTextureLevels = 15;

// Where a level's texels begin among those of the levels after the first, and its sides.
struct TextureLevels {
  std::int32_t first[kMaxTextureLevels] = {};
  std::int32_t width[kMaxTextureLevels] = {}, height[kMaxTextureLevels] = {};
};

// Rows from the top, where v is 0; a texel's channels are the bytes of its number from the lowest:
// r, g, b, a.
template <typename Real>
struct TextureData {
  const std::uint32_t* texels;
  int width, height;   // in [1, kMaxTextureSide]
  const Real* decode;  // linear light by byte, 256 of them
  TextureWrap wrap_u, wrap_v;
  TextureFilter filter;
  std::uint32_t set = 0;  // of the surface's coordinates; 1 only where triangles have `uv2`
  // Where the surface's (u, v) lies on the image: rows of a, b, c with a u + b v + c.
  bool is_moved = false;
  Real to_u[3] = {}, to_v[3] = {};
  // Level 0 is the image; each further one is half as large, down to a texel. A texture that is not
  // filtered has one level.
  int level_count = 1;
  Real coarsest = 1;                      // 2 to the power of the last level
  const std::uint32_t* coarse = nullptr;  // texels of the levels after the first
  TextureLevels levels = {};
};

// How wide a ray's cone is at the eye, and how much wider it is a unit of length on.
template <typename Real>
struct PixelCone {
  Real width = 0, spread = 0;
};

enum class LightKind : std::uint32_t {
  kPointFromLight,    // shadow rays run from the light, so that a batch shares its origin
  kPointFromSurface,  // a light with a size, or so far away that rounding would reach the surface
  kDirectional,
};

// What is seen of a light. All but a point are drawn from: src/scalar/incidence.h.
enum class LightShape : std::uint32_t { kPoint, kRectangle, kDisk, kSphere, kSun, kEmitters };

// The triangles that shine, by number: src/scalar/emitters.h.
template <typename Real>
struct EmitterView {
  std::uint32_t count;
  const Real *corner[3], *edge1[3], *edge2[3];
  const Real* normal[3];  // unit
  const Real* offset;     // along the normal; takes the end of a shadow ray off the triangle
  const Real* density;    // with which a point is drawn, by area
  const Real* rgb[3];     // what it gives when it is drawn, by the cosines and the square distance
  // Each is drawn in the lower part of its cell, below the threshold, and its alias in the rest.
  const Real *threshold, *alias;
};

template <typename Real>
struct LightData {
  LightKind kind;
  Real vector[3];   // position, or the unit vector toward a directional light
  Real rgb[3];      // colour * intensity * exposure, where lengths are placed ones
  Real falloff[3];  // kc, kl, kq; 1, 0, 0 for directional lights
  std::uint32_t casts_shadows;
  // A spot light's cone: light is scaled by the square of cone_scale * cos + cone_offset, clamped
  // to [0, 1], with cos of the angle between `axis`, the unit vector it shines along, and the ray
  // to the surface.
  std::uint32_t is_spot = 0;
  Real axis[3] = {};
  Real cone_scale = 0, cone_offset = 0;
  // A light with a size. Then `axis` is the way a rectangle or disk shines, and `rgb` is divided by
  // `samples`.
  LightShape shape = LightShape::kPoint;
  std::uint32_t samples = 1;  // drawn a surface and sample of a pixel
  // A rectangle's edges, a disk's half axes, or unit vectors across a sun's direction.
  Real across_u[3] = {}, across_v[3] = {};
  Real extent = 0;  // a ball's radius; 1 - cos of the half angle of a sun
  const EmitterView<Real>* emitters = nullptr;  // of kEmitters, whose own colour is 1
};

enum class CameraModel : std::uint32_t { kPerspective, kOrthographic, kEquirectangular, kFisheye };
inline constexpr CameraModel kLastCameraModel = CameraModel::kFisheye;

enum class LensUse : std::uint32_t { kNone, kThin };

// Pixel (x, y) sampled at (sx, sy) in [0, 1)^2 lies at a = (x + sx) - half_width steps to the right
// and b = half_height - (y + sy) steps up.
template <typename Real>
struct CameraData {
  CameraModel model;
  Real eye[3], forward[3];  // forward is a unit vector
  // A pixel's step on the plane one unit ahead, or in scene units; unit vectors where pixels are
  // steps of angles.
  Real right[3], up[3];
  Real turns_x, turns_y;         // such a step to the right and up, in quarter turns
  Real half_width, half_height;  // pixels
  // A thin lens, of cameras with a plane: across it to the right and up, its radius long; how far
  // ahead what is sharp lies; the polygon of its blades, 0 for a disk, and how far that is turned.
  LensUse lens = LensUse::kNone;
  Real lens_right[3] = {}, lens_up[3] = {};
  Real focus = 0, blades = 0, blade_turn = 0;  // the turn in quarter turns
};

// Of a surface's rays, in the order in which they are worked on.
enum class ChildKind : std::uint32_t { kReflected, kRefracted, kDiffuse };
inline constexpr std::size_t kChildKinds = 3;
// Paths of this depth and deeper ones may end by chance.
inline constexpr int kRouletteDepth = 3;

// Whether dim paths may end, and how likely they go on at least.
enum class Roulette : std::uint32_t { kOff, kOn };
template <typename Real>
inline constexpr Real kLeastSurvival = Real(0.05);

// How many children surfaces have.
struct SpawnCounts {
  std::uint32_t reflected, refracted;
};

}  // namespace sheaf

#endif  // SHEAF_SIMD_SHADING_H_
