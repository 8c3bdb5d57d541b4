#include "src/lab/kernel_cases.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "simd/query.h"
#include "src/render/compile_scene.h"
#include "src/scalar/camera_ray.h"
#include "src/scalar/shadow_ray.h"
#include "src/scalar/spawn.h"
#include "src/scalar/trace_tree.h"
#include "src/stream/stream.h"

namespace sheaf {
namespace {

using Real = float;
using Indices = AlignedArray<std::uint32_t>;

// A tile of a frame; its streams stay in the first two caches.
constexpr int kSide = 32;
constexpr std::uint32_t kCount = kSide * kSide;
constexpr int kLayers = 4;  // primitives behind each other, all in one leaf

// Takes the place of a result that nobody reads, so that no work is left out.
volatile Real kept;

Camera Eye() {
  Camera camera;
  camera.eye = {0.1, 0.2, 5};
  camera.look_at = {0, 0, 0};
  camera.projection = Perspective{20};
  return camera;
}

// A light to the side: half of a ball faces it.
Light Lamp() {
  Light light;
  light.source = PointLight{{9, 2, 1}, {}};
  light.intensity = 50;
  return light;
}

Material Glossy() {
  Material material;
  material.kd = 0.6;
  material.ks = 0.4;
  material.shininess = 37;
  material.ambient = 0.2;
  material.reflect = Colour(0.3);
  return material;
}

Scene SceneOf(const std::vector<std::variant<Sphere, Quad, Triangle, Mesh, Disk>>& shapes) {
  Scene scene;
  scene.materials = {Glossy()};
  scene.lights = {Lamp()};
  for (const auto& shape : shapes) scene.objects.push_back({"", shape, 0});
  return scene;
}

Scene Spheres() {
  std::vector<std::variant<Sphere, Quad, Triangle, Mesh, Disk>> shapes;
  for (int i = 0; i < kLayers; ++i) shapes.push_back(Sphere{{0, 0, -0.05 * i}, 1.4});
  return SceneOf(shapes);
}

Scene Disks() {
  std::vector<std::variant<Sphere, Quad, Triangle, Mesh, Disk>> shapes;
  for (int i = 0; i < kLayers; ++i) shapes.push_back(Disk{{0, 0, -0.1 * i}, 3, {0.1, 0.2, 1}});
  return SceneOf(shapes);
}

// As a mesh, whose vertices have normals and colours.
Scene Triangles() {
  Mesh mesh;
  for (int i = 0; i < kLayers; ++i) {
    const float z = -0.1f * static_cast<float>(i);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::vec3& corner : {glm::vec3(-9, -5, z), {9, -5, z}, {0, 12, z}}) {
      mesh.positions.push_back(corner);
      mesh.normals.push_back(glm::vec3(0.02f * corner.x, 0.02f * corner.y, 1));
      mesh.colours.push_back(glm::vec3(0.5f, 0.7f, 0.9f));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return SceneOf({mesh});
}

// Specks that rays seldom hit: what counts is the boxes around them.
Scene Specks() {
  constexpr int kAcross = 48;
  Mesh mesh;
  for (int y = 0; y < kAcross; ++y) {
    for (int x = 0; x < kAcross; ++x) {
      const glm::vec3 at(2.0f * static_cast<float>(x) / kAcross - 1,
                         2.0f * static_cast<float>(y) / kAcross - 1,
                         0.5f * static_cast<float>((x * 7 + y * 13) % 11) / 11);
      const auto first = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::vec3& aside : {glm::vec3(0, 0, 0), {0.002f, 0, 0}, {0, 0.002f, 0}}) {
        mesh.positions.push_back(at + aside);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return SceneOf({mesh});
}

// A tile's way through the kernels over one scene: each has what the one before it wrote, and the
// baseline the same as its own structs.
struct Tile {
  explicit Tile(const Scene& described);

  CompiledScene<Real> scene;
  CameraData<Real> camera;
  MaterialData<Real> material;  // of the scene
  GeometryView<Real> geometry;
  TreeView<Real> tree;
  AlignedArray<Real> x, y;
  RayStream<Real> rays, other_rays, more_rays;
  PathStream<Real> parents, paths, more_paths;
  HitStream<Real> hits;
  SurfaceStream<Real> surfaces, shaded_surfaces;
  IncidenceStream<Real> incidence;
  ColourStream<Real> colours;
  Indices faces, list, index, primitive, occluded;
  HitBatch batch{};
  std::uint32_t hit_count = 0, facing = 0;
  std::vector<scalar::Ray<Real>> scalar_rays;
  std::vector<scalar::Hit<Real>> scalar_hits;  // of the batch
  std::vector<std::uint32_t> places;           // likewise
  std::vector<scalar::Ray<Real>> hit_rays;     // likewise
  std::vector<scalar::Surface<Real>> scalar_surfaces;

  const LightData<Real>& light() const { return scene.lights.front(); }
  // Where no normal but the face's is used.
  SurfaceView<Real> flat_surfaces() const { return WithoutFaces(shaded_surfaces.view()); }

 private:
  void Allocate();
  void Trace(const Kernels<Real>& kernels);
};

void Tile::Allocate() {
  for (auto* list_of_rays : {&rays, &other_rays, &more_rays}) list_of_rays->Allocate(kCount);
  for (auto* list_of_paths : {&parents, &paths, &more_paths}) list_of_paths->Allocate(kCount);
  hits.Allocate(kCount), surfaces.Allocate(kCount), shaded_surfaces.Allocate(kCount);
  incidence.Allocate(kCount), colours.Allocate(kCount);
  for (Indices* indices : {&faces, &list, &index, &primitive, &occluded}) {
    indices->Allocate(StreamCapacity(kCount));
  }
  x.Allocate(StreamCapacity(kCount)), y.Allocate(StreamCapacity(kCount));
}

Tile::Tile(const Scene& described)
    : scene(CompileScene<Real>(described)),
      camera(CompileCamera<Real>(Eye(), kSide, kSide)),
      material(scene.materials.front()) {
  const Status built = scene.objects.data.BuildTree(1);
  assert(built.ok());
  static_cast<void>(built);
  geometry = scene.geometry();
  tree = scene.objects.data.tree.view();
  Allocate();
  for (std::uint32_t i = 0; i < kCount; ++i) {
    x[i] = static_cast<Real>(i % kSide);
    y[i] = static_cast<Real>(i / kSide);
    scalar_rays.push_back(scalar::CameraRay(camera, x[i], y[i], 0.5f, 0.5f));
  }
  const Kernels<Real> kernels = StrictKernels<Real>(0);
  kernels.generate_primary(camera, x.data(), y.data(), 0.5f, 0.5f, {}, kCount, rays.output());
  const auto sources = rays.output();
  for (std::uint32_t i = 0; i < kCount; ++i) sources.source[i] = kNoPrimitive;
  Trace(kernels);
}

void Tile::Trace(const Kernels<Real>& kernels) {
  kernels.trace_closest(tree, rays.view(), {}, kCount, Coherence::kUnknown, hits.output());
  for (std::uint32_t i = 0; i < kCount; ++i) {
    const scalar::Hit<Real> hit = scalar::TraceClosest(tree, scalar_rays[i]);
    if (hit.primitive == kNoPrimitive) continue;
    const PrimitiveInfo& info = scene.objects.primitives[hit.primitive];
    list[hit_count] = i;
    index[hit_count] = info.index();
    primitive[hit_count] = hit.primitive;
    ++hit_count;
    scalar_hits.push_back(hit);
    places.push_back(info.place);
    hit_rays.push_back(scalar_rays[i]);
    scalar_surfaces.push_back(scalar::SurfaceAt(scalar_rays[i], hit, geometry, info.place));
  }
  batch = {list.data(), index.data(), primitive.data(), hit_count};
  if (hit_count == 0) return;
  const PrimitiveKind kind = scene.objects.primitives[scalar_hits.front().primitive].kind();
  kernels.surfaces_of(kind)(geometry, rays.view(), hits.view(), batch, material.needs,
                            shaded_surfaces.output());
  facing = kernels.face_light(light(), material, flat_surfaces(), {}, hit_count, faces.data(),
                              incidence.output());
  const auto throughputs = parents.output();
  for (std::uint32_t i = 0; i < kCount; ++i) {
    throughputs.throughput_r[i] = throughputs.throughput_g[i] = throughputs.throughput_b[i] = 0.5f;
  }
}

using SharedTile = std::shared_ptr<Tile>;

double Share(std::uint32_t part, std::uint32_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max(whole, 1u));
}

KernelCase GenerateCase(const SharedTile& tile) {
  return {"generate",
          "primary ray",
          kCount,
          1,
          [tile] {
            for (std::uint32_t i = 0; i < kCount; ++i) {
              kept =
                  scalar::CameraRay(tile->camera, tile->x[i], tile->y[i], 0.5f, 0.5f).direction.x;
            }
          },
          [tile](const Kernels<Real>& kernels) {
            kernels.generate_primary(tile->camera, tile->x.data(), tile->y.data(), 0.5f, 0.5f, {},
                                     kCount, tile->other_rays.output());
          }};
}

KernelCase ClosestCase(const std::string& name, const std::string& element,
                       const SharedTile& tile) {
  return {name,
          element,
          kCount,
          1,
          [tile] {
            for (const auto& ray : tile->scalar_rays) {
              kept = scalar::TraceClosest(tile->tree, ray).t;
            }
          },
          [tile](const Kernels<Real>& kernels) {
            kernels.trace_closest(tile->tree, tile->rays.view(), {}, kCount, Coherence::kUnknown,
                                  tile->hits.output());
          }};
}

KernelCase OccludedCase(const SharedTile& tile) {
  return {"occluded",
          "ray and a leaf of 4 triangles",
          kCount,
          1,
          [tile] {
            for (const auto& ray : tile->scalar_rays) {
              kept = scalar::TraceOccluded(tile->tree, ray) ? 1.0f : 0.0f;
            }
          },
          [tile](const Kernels<Real>& kernels) {
            kernels.trace_occluded(tile->tree, tile->rays.view(), {}, kCount, Coherence::kUnknown,
                                   tile->occluded.data());
          }};
}

KernelCase SurfacesCase(const std::string& name, PrimitiveKind kind, const SharedTile& tile) {
  return {name,
          "hit",
          tile->hit_count,
          1,
          [tile] {
            for (std::size_t i = 0; i < tile->scalar_hits.size(); ++i) {
              kept = scalar::SurfaceAt(tile->hit_rays[i], tile->scalar_hits[i], tile->geometry,
                                       tile->places[i])
                         .position.x;
            }
          },
          [tile, kind](const Kernels<Real>& kernels) {
            const std::uint32_t needs = tile->material.needs;
            kernels.surfaces_of(kind)(tile->geometry, tile->rays.view(), tile->hits.view(),
                                      tile->batch, needs, tile->surfaces.output());
            // The baseline blends the normals and colours of vertices in the same step.
            if (kind == PrimitiveKind::kTriangle) {
              kernels.blend_vertices(tile->geometry.triangles, tile->hits.view(), tile->batch,
                                     needs, tile->surfaces.output());
            }
          }};
}

KernelCase AmbientCase(const SharedTile& tile) {
  return {"ambient",
          "surface",
          tile->hit_count,
          1,
          [tile] {
            for (const auto& surface : tile->scalar_surfaces) {
              const auto base = scalar::BaseColourAt<Real>(tile->material, {}, surface);
              kept = scalar::AmbientLight(tile->material, base).x;
            }
          },
          [tile](const Kernels<Real>& kernels) {
            kernels.shade_ambient(tile->material, tile->flat_surfaces(), tile->hit_count,
                                  tile->colours.output());
          }};
}

KernelCase FaceCase(const SharedTile& tile) {
  return {"face",
          "surface and light",
          tile->hit_count,
          Share(tile->facing, tile->hit_count),
          [tile] {
            for (const auto& surface : tile->scalar_surfaces) {
              kept = scalar::IncidenceOf(tile->light(), surface).n_dot_l;
            }
          },
          [tile](const Kernels<Real>& kernels) {
            kernels.face_light(tile->light(), tile->material, tile->flat_surfaces(), {},
                               tile->hit_count, tile->faces.data(), tile->incidence.output());
          }};
}

// Shadow rays of those surfaces alone that face the light, without gaps.
KernelCase CompactCase(const SharedTile& tile) {
  return {"compact",
          "surface, to shadow rays",
          tile->hit_count,
          Share(tile->facing, tile->hit_count),
          [tile] {
            for (std::size_t i = 0; i < tile->scalar_surfaces.size(); ++i) {
              if (!tile->faces[i]) continue;
              const auto& surface = tile->scalar_surfaces[i];
              scalar::Incidence<Real> incidence{};
              kept = scalar::ShadowRay(tile->light(), surface, incidence).direction.x;
            }
          },
          [tile](const Kernels<Real>& kernels) {
            kernels.generate_shadow(tile->light(), tile->flat_surfaces(), {}, tile->faces.data(),
                                    tile->hit_count, tile->other_rays.output(),
                                    tile->occluded.data());
          }};
}

// Diffuse light alone, or with the highlight's power.
KernelCase ShadeCase(const std::string& name, Real ks, const SharedTile& tile) {
  MaterialData<Real> material = tile->material;
  material.ks = ks;
  material.needs = NeedsOf(material);
  std::vector<scalar::Incidence<Real>> incidences;
  for (const auto& surface : tile->scalar_surfaces) {
    incidences.push_back(scalar::IncidenceOf(tile->light(), surface));
  }
  return {name,
          "surface and light",
          tile->hit_count,
          Share(tile->facing, tile->hit_count),
          [tile, material, incidences] {
            for (std::size_t i = 0; i < incidences.size(); ++i) {
              if (!tile->faces[i]) continue;
              const auto& surface = tile->scalar_surfaces[i];
              const auto base = scalar::BaseColourAt<Real>(material, {}, surface);
              kept = scalar::LitBy(tile->light(), material, surface, base, incidences[i]).x;
            }
          },
          [tile, material](const Kernels<Real>& kernels) {
            kernels.shade_light(tile->light(), material, tile->flat_surfaces(),
                                tile->incidence.view(), tile->faces.data(), {}, tile->hit_count,
                                tile->colours.output());
          }};
}

// A mirror, or glass, whose every surface sends on one ray or two.
KernelCase SpawnCase(const std::string& name, Real transmit, const SharedTile& tile) {
  MaterialData<Real> material = tile->material;
  for (Real& channel : material.transmit) channel = transmit;
  material.ior = 1.5f;
  material.needs = NeedsOf(material);
  return {name,
          "surface",
          tile->hit_count,
          1,
          [tile, material] {
            const Real throughput[3] = {0.5f, 0.5f, 0.5f};
            for (const auto& surface : tile->scalar_surfaces) {
              const auto spawned = scalar::Spawn(material, surface, throughput);
              kept = spawned.reflected.throughput[0] + spawned.refracted.throughput[0];
            }
          },
          [tile, material](const Kernels<Real>& kernels) {
            kernels.spawn_rays(material, tile->flat_surfaces(), tile->hit_count,
                               tile->parents.view(), 0, tile->other_rays.output(),
                               tile->paths.output(), tile->more_rays.output(),
                               tile->more_paths.output());
          }};
}

}  // namespace

std::vector<KernelCase> MakeKernelCases() {
  const auto make = [](const Scene& scene) { return std::make_shared<Tile>(scene); };
  const SharedTile spheres = make(Spheres()), triangles = make(Triangles()), disks = make(Disks()),
                   specks = make(Specks());
  return {GenerateCase(spheres),
          ClosestCase("boxes", "ray through 2,304 specks", specks),
          ClosestCase("triangle", "ray and a leaf of 4 triangles", triangles),
          ClosestCase("sphere", "ray and a leaf of 4 spheres", spheres),
          ClosestCase("disk", "ray and a leaf of 4 disks", disks),
          OccludedCase(triangles),
          SurfacesCase("surfaces, triangle", PrimitiveKind::kTriangle, triangles),
          SurfacesCase("surfaces, sphere", PrimitiveKind::kSphere, spheres),
          SurfacesCase("surfaces, disk", PrimitiveKind::kDisk, disks),
          AmbientCase(spheres),
          FaceCase(spheres),
          CompactCase(spheres),
          ShadeCase("shade", 0, spheres),
          ShadeCase("shade and power", 0.4f, spheres),
          SpawnCase("spawn, mirror", 0, spheres),
          SpawnCase("spawn, glass", 0.6f, spheres)};
}

}  // namespace sheaf
