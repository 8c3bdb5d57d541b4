// A scene as a person describes it: names, double precision, no layout for speed.
//
// Lengths are in one unit of the user's choice, angles in degrees, colours linear RGB. The renderer
// compiles a Scene into flat arrays (render/compile_scene.h); nothing here is read per ray. A
// finite number is one that stays finite as a float.
#ifndef SHEAF_SHEAF_SCENE_H_
#define SHEAF_SHEAF_SCENE_H_

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/version.h"

namespace sheaf {

using Vec3d = glm::dvec3;
using Colour = glm::dvec3;  // linear RGB, each component >= 0 and finite

// Cells of the surface coordinates (u, v): with a = floor(u * cells.x) and b = floor(v * cells.y),
// `even` shows where a + b is even, `odd` elsewhere.
struct Checker {
  Colour even{1.0};
  Colour odd{0.0};
  glm::dvec2 cells{1.0};  // cells across the unit interval of u and of v, > 0
  // Whether a ray sees the mean of the cells that its pixel covers. Otherwise it sees the one that
  // it meets, and cells smaller than a pixel are noise.
  bool is_filtered = false;
};

enum class Transfer { kLinear, kSrgb };

// How a texture goes on beyond the unit interval of a surface coordinate.
enum class Wrap { kRepeat, kMirror, kClamp };

// What a texture shows between the middles of its texels. kNearest: the nearest texel. kLinear: the
// four around, mixed. kMip: the same, and where a pixel covers more than a texel, from copies of
// the image of half the size, a quarter, and so on, so that what is far away is its mean and no
// noise.
enum class Filter { kNearest, kLinear, kMip };
inline constexpr int kMaxTextureSide = 16384;

// A picture to take colours from. Rows from the top; a texel's lowest byte is red, then green and
// blue; the highest is alpha, which counts where a material's `alpha` asks for it.
struct Image {
  std::string name;                   // for messages and for files made of it; may be empty
  int width = 0, height = 0;          // [1, kMaxTextureSide]
  std::vector<std::uint32_t> texels;  // width * height
};

// Where on an image a surface coordinate lies: (u, v) times `scale`, turned by `rotation`, plus
// `offset` (KHR_texture_transform).
struct TextureTransform {
  glm::dvec2 offset{0.0}, scale{1.0};  // finite
  double rotation =
      0.0;  // degrees in [-1e6, 1e6]; (1, 0) turns to (cos, -sin), which is up on the image

  bool operator==(const TextureTransform&) const = default;
};

// An image on a surface, u to the right and v down, once across the unit interval of each. Its
// colours are multiplied by `factor`.
struct Texture {
  std::shared_ptr<const Image> image;   // not null
  Transfer transfer = Transfer::kSrgb;  // of the image
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  Filter filter = Filter::kMip;
  Colour factor{1.0};
  TextureTransform transform = {};
  int set = 0;  // of coordinates: 0, or 1 for a mesh's `uv2`
};

// How metallic and how rough a surface is, point by point: the texture's blue times `metallic` and
// its green times `roughness` (glTF 2.0, 3.9.2); without an image these alone. Turned into the
// other terms at each point, as docs/formats.md has it for each integrator; the material's `kd` and
// `transmit` are then those of what is no metal, and its `ks`, `shininess`, `reflect` and
// `roughness` count for nothing.
struct MetallicRoughness {
  Texture texture = {};                    // its factor counts for nothing; image may be null
  double metallic = 1.0, roughness = 1.0;  // [0, 1]
  double specular = 1.0;  // >= 0: the highlight of what is no metal, over that of an index of 1.5
};

// How much light goes through, point by point: `transmit` is multiplied by the texture's red, and
// red times `share` is taken off `kd` and `ambient`.
struct Transmission {
  Texture texture;     // its factor counts for nothing
  double share = 1.0;  // [0, 1]
};

// The share of the ambient light that reaches a point: 1 + strength * (the texture's red - 1).
struct Occlusion {
  Texture texture;        // its factor counts for nothing
  double strength = 1.0;  // [0, 1]
};

// Shading normals in tangent space, 2 * texel - 1, of which x and y are multiplied by `scale`: x
// along the surface's u, y against its v. For triangles with surface coordinates; elsewhere it
// counts for nothing.
struct NormalMap {
  Texture texture;     // its factor counts for nothing
  double scale = 1.0;  // finite
};

// How much of a surface is there. kMask: all of it where alpha is at least `cutoff`, nothing
// elsewhere. kBlend: a share of alpha; the rest of a ray goes straight on, as a ray one deeper.
// Shadows follow.
enum class AlphaMode { kOpaque, kMask, kBlend };

struct Alpha {
  AlphaMode mode = AlphaMode::kOpaque;
  // [0, 1]: alpha, times that of the texture of the base colour and that of a mesh's vertices.
  double factor = 1.0;
  double cutoff = 0.5;  // [0, 1]
};

// Whitted's material: what the surface itself sends to the eye, and what it passes on.
struct Material {
  std::string name;
  std::variant<Colour, Checker, Texture> base_colour = Colour(1.0);
  Colour emission{0.0};    // seen as it is, whatever lights there are
  double ambient = 0.0;    // ka, >= 0: ka * base * the scene's ambient light
  double kd = 0.0;         // diffuse, >= 0
  double ks = 0.0;         // half-vector highlight, >= 0; has the light's colour
  double shininess = 1.0;  // highlight exponent, >= 0
  Colour reflect{0.0};     // mirror reflectance, [0, 1]
  Colour transmit{0.0};  // [0, 1]: share that meets a dielectric interface and is split by Fresnel
  double ior = 1.0;      // index of refraction inside over outside, > 0
  // Of what reflects and transmits, [0, 1]: 0 is smooth. Facets have slopes after GGX, with the
  // square of it for alpha (docs/numerics.md).
  double roughness = 0.0;
  // What is left of light after `attenuation_distance` > 0 inside, [0, 1] by colour: Beer's law.
  Colour attenuation{1.0};
  double attenuation_distance = 1.0;
  // What varies from point to point besides the base colour.
  std::optional<Texture> emission_texture = std::nullopt;  // times `emission`
  std::optional<MetallicRoughness> metallic_roughness = std::nullopt;
  std::optional<Occlusion> occlusion = std::nullopt;
  std::optional<Transmission> transmission = std::nullopt;
  std::optional<NormalMap> normal_map = std::nullopt;
  Alpha alpha = {};
};

struct Sphere {
  Vec3d center{0.0};
  double radius = 1.0;  // >= 0; a sphere of radius 0 is never hit
};

// A flat circle, seen from both sides. Surface coordinates: (0.5, 0.5) in the middle, 0 and 1 where
// the square around it begins and ends. u runs along x, v against y for a normal along z; for
// others along the axes of Duff et al. 2017, docs/scene-format.md.
struct Disk {
  Vec3d center{0.0};
  double radius = 1.0;          // >= 0; a disk of radius 0 is never hit
  Vec3d normal{0.0, 0.0, 1.0};  // of the front, any length; a disk whose normal is 0 is never hit
};

// Front side: counter-clockwise. Surface coordinates: (0,0), (1,0), (0,1) unless `uv` says
// otherwise.
struct Triangle {
  std::array<Vec3d, 3> vertices;
  std::array<glm::dvec2, 3> uv{glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0, 1)};
};

// Four coplanar corners in order; u runs from the first to the second, v from the first to the
// fourth. It is traced as the triangles (0, 1, 2) and (0, 2, 3).
struct Quad {
  std::array<Vec3d, 4> corners;
};

// Triangles that share vertices, in the floats of model files. Front side: counter-clockwise.
struct Mesh {
  std::vector<glm::vec3> positions;
  // Each empty, or one a vertex.
  std::vector<glm::vec3> normals;  // for shading, of any length; 0: the face's own
  std::vector<glm::vec2> uv;
  std::vector<glm::vec2> uv2;  // for textures of set 1; empty: they lie by `uv`, as on other shapes
  std::vector<glm::vec3> colours;                       // linear, times the base colour
  std::vector<float> alphas;                            // [0, 1], where the material has an alpha
  std::vector<std::array<std::uint32_t, 3>> triangles;  // vertices, below positions.size()
};

struct Object {
  std::string name;  // may be empty
  std::variant<Sphere, Quad, Triangle, Mesh, Disk> shape;
  std::uint32_t material = 0;  // index into Scene::materials
};

// A place where a group stands: points p of it go to linear * p + translation. Spheres may become
// ellipsoids, and a map may mirror; a front stays a front.
struct Instance {
  std::string name;         // may be empty
  std::uint32_t group = 0;  // index into Scene::groups
  // Columns: where the axes go. Finite, and it must not flatten: |M| |M^-1| has no row whose sum is
  // above a million.
  glm::dmat3 linear{1.0};
  Vec3d translation{0.0};  // finite
};

// Objects, and instances of groups before this one, that stand wherever an instance says, and
// nowhere else. They are there once, however many instances there are.
struct Group {
  std::string name;  // may be empty
  std::vector<Object> objects;
  std::vector<Instance> instances;
};

// Instances of a scene, counted through all levels.
inline constexpr std::uint32_t kMaxInstances = 1u << 26;

// How the illuminance of a point light falls with the distance r: one over kc + kl r + kq r^2.
struct Falloff {
  double constant = 0.0, linear = 0.0, quadratic = 1.0;  // >= 0, not all 0
};

// Light in a cone alone: all of it within `inner` of the axis, none beyond `outer`, smooth between
// (KHR_lights_punctual).
struct Cone {
  Vec3d direction{0.0, -1.0, 0.0};   // the way the light travels; any length but 0
  double inner = 0.0, outer = 45.0;  // degrees from the axis, 0 <= inner < outer <= 90
};

struct PointLight {
  Vec3d position{0.0};
  Falloff falloff;
  std::optional<Cone> cone = std::nullopt;
};

struct DirectionalLight {
  Vec3d direction{0.0, -1.0, 0.0};  // the way the light travels; any length but 0
  // Under which its disk is seen, full, in degrees in [0, 180]: the sun's is 0.53. Shadows are soft
  // where it is above 0.
  double angle = 0.0;
};

// Lights that have a size, and so soft shadows. They are not seen themselves.

// The rectangle center + (a - 1/2) u + (b - 1/2) v with a and b in [0, 1]; it shines from the side
// that u x v points to.
struct RectangleLight {
  Vec3d center{0.0};
  Vec3d u{1.0, 0.0, 0.0}, v{0.0, 0.0, 1.0};  // its edges; any but parallel
};

struct DiskLight {
  Vec3d center{0.0};
  double radius = 0.5;              // > 0
  Vec3d direction{0.0, -1.0, 0.0};  // that it shines in; any length but 0
};

// It gives nothing inside.
struct SphereLight {
  Vec3d center{0.0};
  double radius = 0.5;  // > 0
};

inline constexpr int kMaxLightSamples = 1024;

// At distance r a point light gives intensity * colour * exposure / (kc + kl r + kq r^2), a
// directional light intensity * colour * exposure. A light with a size gives from afar what a point
// light of its intensity does, a rectangle or disk times the cosine of the angle to the way it
// shines.
struct Light {
  std::string name;
  std::variant<PointLight, DirectionalLight, RectangleLight, DiskLight, SphereLight> source;
  Colour colour{1.0};
  double intensity = 1.0;  // >= 0
  bool casts_shadows = true;
  // Of a light with a size: the points of it that a surface asks about for each of a pixel's
  // samples, in [1, kMaxLightSamples].
  int samples = 1;
};

struct Perspective {
  double fov_y = 60.0;  // full vertical angle in degrees, in (0, 180)
};

struct Orthographic {
  double height = 2.0;  // of the picture in scene units, > 0
};

// All directions: 360 degrees across the picture's width, 180 down its height. The middle looks at
// look_at.
struct Equirectangular {};

// Equidistant: the angle from the view direction grows with the distance from the picture's middle.
// Pixels further out than the picture's height go on in the same way.
struct Fisheye {
  double fov = 180.0;  // full angle across the picture's height in degrees, in (0, 360]
};

using Projection = std::variant<Perspective, Orthographic, Equirectangular, Fisheye>;

// What the number of a projection is, where it has one.
enum class ProjectionUnit { kNone, kDegrees, kLength };

// Where a projection's pixels lie even: on a plane ahead of the eye, or in angles around it.
enum class ProjectionSurface { kPlane, kSphere };

// A kind of projection as scene files, the command and bindings name it.
struct ProjectionKind {
  const char* name;
  const char* parameter;  // what its number is called; empty: it has none
  ProjectionUnit unit;
  ProjectionSurface surface;
  double usual, largest;  // the number, which is above 0
  const char* range;      // what a message says that it has to be
};

// By the index of the alternative of Projection.
inline constexpr ProjectionKind kProjectionKinds[] = {
    {"perspective", "fov_y", ProjectionUnit::kDegrees, ProjectionSurface::kPlane, 60,
     0x1.67fffffffffffp7, "a number in (0, 180)"},
    {"orthographic", "height", ProjectionUnit::kLength, ProjectionSurface::kPlane, 2, 1e30,
     "a number in (0, 1e30]"},
    {"equirectangular", "", ProjectionUnit::kNone, ProjectionSurface::kSphere, 0, 0, ""},
    {"fisheye", "fov", ProjectionUnit::kDegrees, ProjectionSurface::kSphere, 180, 360,
     "a number in (0, 360]"},
};
static_assert(std::size(kProjectionKinds) == std::variant_size_v<Projection>);

// No frame of an animation is further from frame 0.
inline constexpr double kMaxFrame = 1e6;

// Where a camera is at a frame of an animation.
struct CameraKey {
  double frame = 0.0;  // in [-kMaxFrame, kMaxFrame]
  Vec3d eye{0.0};
  Vec3d look_at{0.0, 0.0, -1.0};
  double lens = 60.0;  // the number of the camera's projection, where it has one
};

// A thin lens: what lies on the plane of focus is sharp.
struct Lens {
  double aperture = 0.1;                       // diameter, > 0
  std::optional<double> focus = std::nullopt;  // how far ahead that plane lies, > 0; look_at's
  int blades = 0;         // corners of the aperture, in [3, 64], the first to the right; 0: round
  double rotation = 0.0;  // of the blades, degrees in [-1e6, 1e6], counter-clockwise
};

struct Camera {
  std::string name;
  Vec3d eye{0.0};
  Vec3d look_at{0.0, 0.0, -1.0};
  Vec3d up{0.0, 1.0, 0.0};
  Projection projection;
  // Depth of field, of perspective and orthographic cameras.
  std::optional<Lens> lens = std::nullopt;
  // By ascending frame, no frame twice; empty: the camera stands still. Rendering takes no notice:
  // it sees what the members above say.
  std::vector<CameraKey> path = {};
};

// The camera at a frame of its path, which may lie between two keys, and without a path. `eye` and
// `look_at` move on Catmull-Rom splines through the keys, the lens linearly; before the first key
// and after the last the camera stands still. Where two keys in turn have the same place it stays
// there. `path` keeps the rules above.
SHEAF_API Camera CameraAt(const Camera& camera, double frame);

// A named list of cameras, rendered together.
struct View {
  std::string name;
  std::vector<std::uint32_t> cameras;  // indices into Scene::cameras
};

// No number for a place or a length is larger: sums of a few are finite as floats.
inline constexpr double kMaxCoordinate = 1e30;

inline constexpr int kMaxImageSide = 65536;
inline constexpr int kMaxSamples = 65536;
inline constexpr int kMaxDepth = 1000000;

// The colour of a ray that leaves the scene, by y of its unit direction: from the horizon's at 0
// linearly to the zenith's at 1 and the nadir's at -1.
struct Gradient {
  Colour zenith{1.0}, horizon{1.0}, nadir{1.0};
};

// A picture of light. Rows from the top, red, green and blue of each pixel.
struct FloatImage {
  std::string name;           // for messages and for files made of it; may be empty
  int width = 0, height = 0;  // [1, kMaxTextureSide]
  std::vector<float> rgb;     // 3 * width * height, each >= 0 and finite
};

// All directions on a picture: longitude from left to right, -z in the middle and +x to the right
// of it, latitude from +y at the top to -y.
struct EnvironmentMap {
  std::shared_ptr<const FloatImage> image;  // not null
  double strength = 1.0;                    // >= 0: what its light is multiplied with
  double rotation = 0.0;  // degrees in [-1e6, 1e6], counter-clockwise seen from +y
};

using Environment = std::variant<Gradient, EnvironmentMap>;

// What the light of a shadow ray does where it meets a surface that transmits: it goes straight on,
// times `transmit` at each such surface, or it ends there.
enum class Shadows { kThrough, kOpaque };

// How light becomes what a display shows, before the transfer. kFilmic rolls off highlights
// (Narkowicz 2015, "ACES Filmic Tone Mapping Curve").
enum class Tone { kLinear, kFilmic };
inline constexpr double kMaxEv = 64;

// How light is followed. kWhitted: lights with a size are seen as their middle, mirrors and glass
// are smooth and lenses are pinholes. kDistributed: all of them are sampled (Cook, Porter,
// Carpenter, "Distributed Ray Tracing", SIGGRAPH 1984). The same bits where a scene has none.
// kPath: light that diffuse surfaces send to one another is followed too, one ray of each surface
// (Kajiya, "The Rendering Equation", SIGGRAPH 1986); there is no ambient light.
enum class Integrator { kWhitted, kDistributed, kPath };

// Every integrator, in the order of the enumeration.
inline constexpr Integrator kIntegrators[] = {Integrator::kWhitted, Integrator::kDistributed,
                                              Integrator::kPath};

// "whitted", "distributed" or "path".
SHEAF_API const char* IntegratorName(Integrator integrator);

// How a pixel's samples weigh what is around it. kBox: its own square. The others are drawn from,
// so that samples count alike: a Gaussian of a standard deviation of half a pixel, cut off at 1.5,
// and Blackman-Harris' window, 1.5 pixels to each side.
enum class PixelFilter { kBox, kGaussian, kBlackmanHarris };

struct Settings {
  int width = 640, height = 480;  // pixels, each in [1, kMaxImageSide]
  int samples = 1;                // a pixel, [1, kMaxSamples]
  // Where given: more than a pixel's first sample only at edges, see RenderOptions::contrast.
  std::optional<double> contrast = std::nullopt;
  // Where given: samples until a pixel's error is small, see RenderOptions::error. Not both.
  std::optional<double> error = std::nullopt;
  int max_depth = 5;  // a ray deeper than this is black; primary rays have depth 0
  Colour background{0.0};
  std::optional<Environment> environment = std::nullopt;  // instead of the background
  // Ambient light; where absent the background, or the mean over all directions of the environment.
  std::optional<Colour> ambient;
  double exposure = 1.0;  // scales every light but the ambient one, > 0
  Shadows shadows = Shadows::kThrough;
  Integrator integrator = Integrator::kDistributed;
  PixelFilter filter = PixelFilter::kBox;
  // Of pictures of bytes: light times 2^ev, ev in [-kMaxEv, kMaxEv], then the tone, then the
  // transfer; without an ev the one that MeterExposure finds. Colours here are linear.
  std::optional<double> ev = 0.0;
  Tone tone = Tone::kLinear;
  Transfer transfer = Transfer::kSrgb;
};

struct Scene {
  Settings settings;
  std::vector<Material> materials;
  std::vector<Object> objects;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::vector<View> views;
  std::vector<Group> groups;
  std::vector<Instance> instances;
};

// Whether a scene, or a camera alone, keeps the rules of this header: every index in range, every
// number finite and in its range, every array as long as it has to be. kScene otherwise, with one
// line that names what is wrong first, like `object 2 "wall": material 7 of 3`. Render asks this of
// what it is given; readers give nothing that fails it. Any number of threads may ask.
SHEAF_API Status Validate(const Scene& scene);
SHEAF_API Status Validate(const Camera& camera);

}  // namespace sheaf

#endif  // SHEAF_SHEAF_SCENE_H_
