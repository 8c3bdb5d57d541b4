#include "src/render/compile_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

#include "simd/roundoffs.h"
#include "simd/shading.h"
#include "simd/streams.h"
#include "simd/tree.h"
#include "src/core/has_area.h"
#include "src/core/match.h"
#include "src/core/strict_tan.h"
#include "src/core/vec3.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

template <typename Real>
void Store(const glm::dvec3& from, Real (&to)[3]) {
  // Adding 0 turns -0 into 0, so that no sum of colours depends on where it starts.
  for (int i = 0; i < 3; ++i) to[i] = static_cast<Real>(from[i]) + Real(0);
}

Vec3<double> ToVec3(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
glm::dvec3 ToGlm(const Vec3<double>& v) { return {v.x, v.y, v.z}; }

// GLM's own normalize multiplies by an inverse square root, whose bits are its business.
glm::dvec3 Unit(const glm::dvec3& v) { return ToGlm(Normalize(ToVec3(v))); }
glm::dvec3 CrossOf(const glm::dvec3& a, const glm::dvec3& b) {
  return ToGlm(Cross(ToVec3(a), ToVec3(b)));
}
double LengthOf(const glm::dvec3& v) { return std::sqrt(Dot(ToVec3(v), ToVec3(v))); }

struct Bounds {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  void Include(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

// How many primitives there are, and what of them some material or mesh asks for.
struct Inventory {
  std::uint32_t spheres = 0, triangles = 0;
  bool has_coordinates = false, has_normals = false, has_colours = false;
};

Inventory TakeInventory(const Scene& scene) {
  Inventory inventory;
  for (const Material& material : scene.materials) {
    inventory.has_coordinates |= !std::holds_alternative<Colour>(material.base_colour);
  }
  for (const Object& object : scene.objects) {
    if (std::holds_alternative<Sphere>(object.shape)) ++inventory.spheres;
    if (std::holds_alternative<Quad>(object.shape)) inventory.triangles += 2;
    if (std::holds_alternative<Triangle>(object.shape)) ++inventory.triangles;
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
      inventory.triangles += static_cast<std::uint32_t>(mesh->triangles.size());
      inventory.has_normals |= !mesh->normals.empty();
      inventory.has_colours |= !mesh->colours.empty();
    }
  }
  return inventory;
}

template <typename Real, std::size_t N>
void AllocateVertices(AlignedArray<Real> (&values)[3][N], std::uint32_t count) {
  for (auto& vertex : values) {
    for (auto& axis : vertex) axis.Allocate(StreamCapacity(count));
  }
}

// Fills the arrays of one CompiledScene in the order of the objects.
template <typename Real>
class GeometryWriter {
 public:
  explicit GeometryWriter(CompiledScene<Real>& compiled) : compiled_(compiled) {}

  void Allocate(const Inventory& inventory) {
    inventory_ = inventory;
    const std::uint32_t spheres = inventory.spheres, triangles = inventory.triangles;
    for (auto& axis : compiled_.sphere_center) axis.Allocate(StreamCapacity(spheres));
    compiled_.sphere_radius.Allocate(StreamCapacity(spheres));
    compiled_.sphere_id.Allocate(StreamCapacity(spheres));
    AllocateVertices(compiled_.triangle_vertex, triangles);
    if (inventory.has_coordinates) AllocateVertices(compiled_.triangle_uv, triangles);
    if (inventory.has_normals) AllocateVertices(compiled_.triangle_normal, triangles);
    if (inventory.has_colours) AllocateVertices(compiled_.triangle_colour, triangles);
    compiled_.triangle_id.Allocate(StreamCapacity(triangles));
    compiled_.primitives.reserve(std::size_t{spheres} + triangles);
    compiled_.object_of_primitive.reserve(std::size_t{spheres} + triangles);
  }

  void StartObject(std::uint32_t object, std::uint32_t material) {
    object_ = object;
    material_ = material;
  }

  void Add(const Sphere& sphere) {
    const std::uint32_t i = compiled_.sphere_count++;
    for (int axis = 0; axis < 3; ++axis) {
      compiled_.sphere_center[axis][i] = static_cast<Real>(sphere.center[axis]);
    }
    const Real radius = static_cast<Real>(sphere.radius);
    compiled_.sphere_radius[i] = radius > 0 ? radius : kNever;
    compiled_.sphere_id[i] = NewId(i);
    bounds_.Include(sphere.center - sphere.radius);
    bounds_.Include(sphere.center + sphere.radius);
  }

  void Add(const Triangle& triangle) {
    const std::uint32_t i = AddVertices(triangle.vertices);
    for (int vertex = 0; vertex < 3; ++vertex) {
      if (inventory_.has_coordinates) Put(compiled_.triangle_uv, vertex, i, triangle.uv[vertex]);
      if (inventory_.has_normals) Put(compiled_.triangle_normal, vertex, i, glm::vec3(0));
      if (inventory_.has_colours) Put(compiled_.triangle_colour, vertex, i, glm::vec3(1));
    }
  }

  void Add(const Mesh& mesh) {
    for (const auto& corners : mesh.triangles) {
      const std::uint32_t i =
          AddVertices({Vec3d(mesh.positions[corners[0]]), Vec3d(mesh.positions[corners[1]]),
                       Vec3d(mesh.positions[corners[2]])});
      for (int vertex = 0; vertex < 3; ++vertex) {
        const std::uint32_t from = corners[static_cast<std::size_t>(vertex)];
        if (inventory_.has_coordinates) {
          Put(compiled_.triangle_uv, vertex, i,
              mesh.uv.empty() ? glm::dvec2(Triangle{}.uv[static_cast<std::size_t>(vertex)])
                              : glm::dvec2(mesh.uv[from]));
        }
        if (inventory_.has_normals) {
          Put(compiled_.triangle_normal, vertex, i,
              mesh.normals.empty() ? glm::vec3(0) : mesh.normals[from]);
        }
        if (inventory_.has_colours) {
          Put(compiled_.triangle_colour, vertex, i,
              mesh.colours.empty() ? glm::vec3(1) : mesh.colours[from]);
        }
      }
    }
  }

  void Add(const Quad& quad) {
    const auto& c = quad.corners;
    Add(Triangle{{c[0], c[1], c[2]}, {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(1, 1)}});
    Add(Triangle{{c[0], c[2], c[3]}, {glm::dvec2(0, 0), glm::dvec2(1, 1), glm::dvec2(0, 1)}});
  }

  const Bounds& bounds() const { return bounds_; }

 private:
  static constexpr Real kNever = std::numeric_limits<Real>::quiet_NaN();

  // A triangle with nothing but its vertices; returns its place.
  std::uint32_t AddVertices(const std::array<Vec3d, 3>& vertices) {
    const std::uint32_t i = compiled_.triangle_count++;
    double rounded[3][3];
    for (int vertex = 0; vertex < 3; ++vertex) {
      const auto& v = vertices[static_cast<std::size_t>(vertex)];
      for (int axis = 0; axis < 3; ++axis) rounded[vertex][axis] = static_cast<Real>(v[axis]);
      bounds_.Include(v);
      Put(compiled_.triangle_vertex, vertex, i, v);
    }
    if (!HasArea(rounded)) compiled_.triangle_vertex[0][0][i] = kNever;
    compiled_.triangle_id[i] = NewId(i | kTriangleBit);
    return i;
  }

  template <std::size_t N, typename Value>
  static void Put(AlignedArray<Real> (&values)[3][N], int vertex, std::uint32_t i,
                  const Value& value) {
    for (int axis = 0; axis < static_cast<int>(N); ++axis) {
      values[vertex][axis][i] = static_cast<Real>(value[axis]);
    }
  }

  std::uint32_t NewId(std::uint32_t local) {
    compiled_.primitives.push_back({local, material_});
    compiled_.object_of_primitive.push_back(object_);
    return static_cast<std::uint32_t>(compiled_.primitives.size() - 1);
  }

  CompiledScene<Real>& compiled_;
  Inventory inventory_;
  Bounds bounds_;
  std::uint32_t object_ = 0, material_ = 0;
};

template <typename Real>
void StoreBaseColour(BaseColour kind, const Checker& checker, MaterialData<Real>& data) {
  data.kind = kind;
  Store(checker.even, data.even);
  Store(checker.odd, data.odd);
  for (int i = 0; i < 2; ++i) data.cells[i] = static_cast<Real>(checker.cells[i]);
}

template <typename Real>
MaterialData<Real> CompileMaterial(const Material& material, const Settings& settings) {
  MaterialData<Real> data{};
  Match(
      material.base_colour,
      [&](const Colour& colour) {
        StoreBaseColour(BaseColour::kConstant, {colour, colour}, data);
      },
      [&](const Checker& checker) { StoreBaseColour(BaseColour::kChecker, checker, data); },
      [&](const Texture& texture) {
        StoreBaseColour(BaseColour::kTexture, {texture.factor, texture.factor}, data);
      });
  Store(material.ambient * settings.ambient.value_or(settings.background), data.ambient);
  Store(material.emission, data.emission);
  data.kd = static_cast<Real>(material.kd);
  data.ks = static_cast<Real>(material.ks);
  data.shininess = static_cast<Real>(material.shininess);
  Store(material.reflect, data.reflect);
  Store(material.transmit, data.transmit);
  data.ior = static_cast<Real>(material.ior);
  data.needs = NeedsOf(data);
  return data;
}

// Linear light by byte.
template <typename Real>
std::vector<Real> DecodeTable(Transfer transfer) {
  std::vector<Real> table;
  for (int byte = 0; byte < 256; ++byte) {
    const double share = byte / 255.0;
    table.push_back(static_cast<Real>(transfer == Transfer::kSrgb ? SrgbDecode(share) : share));
  }
  return table;
}

TextureWrap WrapOf(Wrap wrap) {
  switch (wrap) {
    case Wrap::kRepeat:
      return TextureWrap::kRepeat;
    case Wrap::kMirror:
      return TextureWrap::kMirror;
    case Wrap::kClamp:
      break;
  }
  return TextureWrap::kClamp;
}

template <typename Real>
void CompileTexture(const Texture& texture, CompiledScene<Real>& compiled) {
  std::vector<Real>& decode = compiled.decode[static_cast<int>(texture.transfer)];
  if (decode.empty()) decode = DecodeTable<Real>(texture.transfer);
  const Image& image = *texture.image;
  compiled.images.push_back(texture.image);
  compiled.textures.push_back(
      {image.texels.data(), image.width, image.height, decode.data(), WrapOf(texture.wrap_u),
       WrapOf(texture.wrap_v),
       texture.filter == Filter::kNearest ? TextureFilter::kNearest : TextureFilter::kLinear});
}

// The cosines of a spot light's two angles differ by at least this, as in KHR_lights_punctual.
constexpr double kLeastConeRim = 0.001;

// The largest distance from `p` to a point of the box.
double Reach(const Bounds& bounds, const glm::dvec3& p) {
  return LengthOf(glm::max(glm::abs(bounds.low - p), glm::abs(bounds.high - p)));
}

template <typename Real>
void StoreSource(const DirectionalLight& sun, const Bounds& /*bounds*/, LightData<Real>& data) {
  data.kind = LightKind::kDirectional;
  Store(-Unit(sun.direction), data.vector);
  data.falloff[0] = 1;
}

template <typename Real>
void StoreSource(const PointLight& point, const Bounds& bounds, LightData<Real>& data) {
  const double diameter = LengthOf(bounds.high - bounds.low);
  const bool is_near =
      Reach(bounds, point.position) <= kMaxLightDiameters * diameter;  // false without objects
  data.kind = is_near ? LightKind::kPointFromLight : LightKind::kPointFromSurface;
  Store(point.position, data.vector);
  data.falloff[0] = static_cast<Real>(point.falloff.constant);
  data.falloff[1] = static_cast<Real>(point.falloff.linear);
  data.falloff[2] = static_cast<Real>(point.falloff.quadratic);
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

template <typename Real>
LightData<Real> CompileLight(const Light& light, const Settings& settings, const Bounds& bounds) {
  LightData<Real> data{};
  data.casts_shadows = light.casts_shadows;
  Store(light.colour * (light.intensity * settings.exposure), data.rgb);
  Match(
      light.source, [&](const PointLight& point) { StoreSource(point, bounds, data); },
      [&](const DirectionalLight& sun) { StoreSource(sun, bounds, data); });
  return data;
}

}  // namespace

template <typename Real, std::size_t N>
void ShowVertices(const AlignedArray<Real> (&values)[3][N], const Real* (&view)[3][N]) {
  for (int vertex = 0; vertex < 3; ++vertex) {
    for (std::size_t axis = 0; axis < N; ++axis) view[vertex][axis] = values[vertex][axis].data();
  }
}

template <typename Real>
GeometryView<Real> CompiledScene<Real>::geometry() const {
  GeometryView<Real> view{};
  view.spheres = {sphere_count,
                  sphere_center[0].data(),
                  sphere_center[1].data(),
                  sphere_center[2].data(),
                  sphere_radius.data(),
                  sphere_id.data()};
  view.triangles.count = triangle_count;
  ShowVertices(triangle_vertex, view.triangles.vertex);
  ShowVertices(triangle_uv, view.triangles.uv);
  ShowVertices(triangle_normal, view.triangles.normal);
  ShowVertices(triangle_colour, view.triangles.colour);
  view.triangles.id = triangle_id.data();
  return view;
}

template <typename Real>
CompiledScene<Real> CompileScene(const Scene& scene) {
  CompiledScene<Real> compiled;
  GeometryWriter<Real> writer(compiled);
  writer.Allocate(TakeInventory(scene));
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    writer.StartObject(i, scene.objects[i].material);
    std::visit([&](const auto& shape) { writer.Add(shape); }, scene.objects[i].shape);
  }
  for (const Material& material : scene.materials) {
    MaterialData<Real> data = CompileMaterial<Real>(material, scene.settings);
    if (const auto* texture = std::get_if<Texture>(&material.base_colour)) {
      data.texture = static_cast<std::uint32_t>(compiled.textures.size());
      CompileTexture(*texture, compiled);
    }
    compiled.materials.push_back(data);
  }
  for (const Object& object : scene.objects) {
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    std::uint32_t& needs = compiled.materials[object.material].needs;
    if (!mesh->normals.empty()) needs |= kNeedsNormals;
    if (!mesh->colours.empty()) needs |= kNeedsTint;
  }
  for (const Light& light : scene.lights) {
    compiled.lights.push_back(CompileLight<Real>(light, scene.settings, writer.bounds()));
  }
  Store(scene.settings.background, compiled.background);
  return compiled;
}

template <typename Real>
CameraData<Real> CompileCamera(const Camera& camera, int width, int height) {
  CameraData<Real> data{};
  const glm::dvec3 forward = Unit(camera.look_at - camera.eye);
  const glm::dvec3 right = Unit(CrossOf(forward, camera.up));
  const glm::dvec3 up = CrossOf(right, forward);
  double step = 0;
  Match(
      camera.projection,
      [&](const Perspective& lens) { step = 2 * StrictTanDegrees(lens.fov_y / 2) / height; },
      [&](const Orthographic& lens) {
        data.orthographic = 1;
        step = lens.height / height;
      });
  Store(camera.eye, data.eye);
  Store(forward, data.forward);
  Store(right * step, data.right);
  Store(up * step, data.up);
  data.half_width = static_cast<Real>(width) / 2;
  data.half_height = static_cast<Real>(height) / 2;
  return data;
}

template struct CompiledScene<float>;
template struct CompiledScene<double>;
template CompiledScene<float> CompileScene(const Scene&);
template CompiledScene<double> CompileScene(const Scene&);
template CameraData<float> CompileCamera(const Camera&, int, int);
template CameraData<double> CompileCamera(const Camera&, int, int);

}  // namespace sheaf
