// Geometries of <sheaf/capi.h> and <sheaf/capi_double.h>: their objects, and what is built of them.
#include <deque>
#include <span>
#include <vector>

#include "sheaf/capi.h"
#include "src/capi/handles.h"

namespace sheaf::capi {
namespace {

// `count` elements of `width` numbers each: what the caller has, or a copy without gaps.
template <typename T>
Result<std::span<const T>> Gather(const char* name, const T* from, std::size_t count,
                                  std::size_t width, std::size_t stride,
                                  std::deque<std::vector<T>>* copies) {
  if (count == 0) return std::span<const T>();
  if (from == nullptr) return UsageError(std::string(name) + " is NULL");
  if (count > SIZE_MAX / (width * sizeof(T))) return UsageError(std::string(name) + ": too many");
  if (stride == 0 || stride == width * sizeof(T)) return std::span<const T>(from, width * count);
  if (stride % sizeof(T) != 0) {
    return UsageError(std::string(name) + ": a stride of " + std::to_string(stride) +
                      " bytes, which " + std::to_string(sizeof(T)) + " does not divide");
  }
  std::vector<T>& copy = copies->emplace_back(width * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::copy_n(from + i * (stride / sizeof(T)), width, copy.data() + width * i);
  }
  return std::span<const T>(copy);
}

std::deque<std::vector<float>>& CopiesOf(sheaf_geometry_input& input, const float*) {
  return input.floats;
}
std::deque<std::vector<double>>& CopiesOf(sheaf_geometry_input& input, const double*) {
  return input.doubles;
}

// `mesh`: the defaults.
template <typename Triangles>
Status AddTriangles(sheaf_geometry_input* input, const Triangles* given, Triangles mesh,
                    std::uint32_t* object) {
  if (const Status there = NotNull(input, "input"); !there) return there.error();
  if (const Status taken = Take(given, "triangles", &mesh); !taken) return taken.error();
  auto& numbers = CopiesOf(*input, mesh.vertices);
  const auto vertices =
      Gather("vertices", mesh.vertices, mesh.vertex_count, 3, mesh.vertex_stride, &numbers);
  if (!vertices) return vertices.error();
  const auto indices =
      Gather("indices", mesh.indices, mesh.triangle_count, 3, mesh.index_stride, &input->indices);
  if (!indices) return indices.error();
  const std::size_t normal_count = mesh.normals == nullptr ? 0 : mesh.vertex_count;
  const auto normals =
      Gather("normals", mesh.normals, normal_count, 3, mesh.normal_stride, &numbers);
  if (!normals) return normals.error();
  const std::uint32_t id =
      input->input.AddTriangles(vertices.value(), indices.value(), normals.value());
  if (object != nullptr) *object = id;
  return Done{};
}

// Spheres or disks of `width` numbers each.
template <typename Real, typename Add>
Status AddNumbers(sheaf_geometry_input* input, const char* name, const Real* from,
                  std::size_t count, std::size_t width, std::size_t stride, std::uint32_t* object,
                  Add add) {
  if (const Status there = NotNull(input, "input"); !there) return there.error();
  const auto numbers = Gather(name, from, count, width, stride, &CopiesOf(*input, from));
  if (!numbers) return numbers.error();
  const std::uint32_t id = add(input->input, numbers.value());
  if (object != nullptr) *object = id;
  return Done{};
}

const auto kAddSpheres = [](auto& to, auto numbers) { return to.AddSpheres(numbers); };
const auto kAddDisks = [](auto& to, auto numbers) { return to.AddDisks(numbers); };

NotFinite NotFiniteOf(std::int32_t skip) {
  return skip != 0 ? NotFinite::kSkipped : NotFinite::kRefused;
}

template <typename Real>
Result<GeometryOf<Real>> Build(const sheaf_geometry_input* input,
                               const sheaf_build_options* given) {
  if (const Status there = NotNull(input, "input"); !there) return there.error();
  sheaf_build_options options = SHEAF_BUILD_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  if (options.threads < 0) return UsageError("options: threads is below 0");
  return GeometryOf<Real>::Build(
      input->input,
      {.threads = options.threads, .not_finite = NotFiniteOf(options.skip_not_finite)});
}

template <typename Handle>
Status Update(Handle* geometry, const sheaf_geometry_input* input,
              const sheaf_update_options* given, std::int32_t* rebuilt) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  if (const Status there = NotNull(input, "input"); !there) return there.error();
  sheaf_update_options options = SHEAF_UPDATE_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  if (options.threads < 0) return UsageError("options: threads is below 0");
  // The tree over instances has boxes of what it was when they were built.
  if (geometry->shared.use_count() > 1) return UsageError("the geometry stands in instances");
  const Result<Updated> updated =
      geometry->geometry.Update(input->input, {.threads = options.threads,
                                               .not_finite = NotFiniteOf(options.skip_not_finite),
                                               .rebuild_ratio = options.rebuild_ratio});
  if (!updated) return updated.error();
  if (rebuilt != nullptr) *rebuilt = updated.value() == Updated::kRebuilt;
  return Done{};
}

template <typename Handle>
Status Save(const Handle* geometry, const char* path) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  if (const Status there = NotNull(path, "path"); !there) return there.error();
  return geometry->geometry.Save(path);
}

template <typename Real>
Result<GeometryOf<Real>> Map(const char* path, const sheaf_map_check& check) {
  if (const Status there = NotNull(path, "path"); !there) return there.error();
  const std::size_t number = NumberIn(check);
  if (number > SHEAF_MAP_CHECK_HEADER) return UsageError("check is none of sheaf_map_check");
  return GeometryOf<Real>::Map(
      path, number == SHEAF_MAP_CHECK_HEADER ? MapCheck::kHeader : MapCheck::kAll);
}

template <typename Handle>
Status GetStatistics(const Handle* geometry, sheaf_geometry_statistics* statistics) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  const GeometryStatistics from = geometry->geometry.statistics();
  sheaf_geometry_statistics own = SHEAF_GEOMETRY_STATISTICS_INIT;
  own.objects = geometry->geometry.object_count();
  own.primitives = from.primitives;
  own.triangles = from.triangles;
  own.spheres = from.spheres;
  own.disks = from.disks;
  own.never_hit = from.never_hit;
  own.skipped = from.skipped;
  own.nodes = from.nodes;
  own.leaves = from.leaves;
  own.depth = from.depth;
  own.bytes = from.bytes;
  StoreBox(geometry->geometry, &own);
  return Put(own, "statistics", statistics);
}

template <typename Handle>
Status FirstPrimitive(const Handle* geometry, std::uint32_t object, std::uint32_t* primitive) {
  if (const Status there = NotNull(geometry, "geometry"); !there) return there.error();
  if (const Status there = NotNull(primitive, "primitive"); !there) return there.error();
  const std::uint32_t count = geometry->geometry.object_count();
  if (object > count) {
    return UsageError("object " + std::to_string(object) + " of " + std::to_string(count));
  }
  *primitive = geometry->geometry.first_primitive(object);
  return Done{};
}

}  // namespace
}  // namespace sheaf::capi

using namespace sheaf::capi;  // NOLINT: the C functions below stand outside of it
using sheaf::Result;

sheaf_status sheaf_geometry_input_create(sheaf_geometry_input** input) {
  return Make(input, "input is NULL", [] { return Result(sheaf::GeometryInput()); });
}

void sheaf_geometry_input_destroy(sheaf_geometry_input* input) { delete input; }

sheaf_status sheaf_add_triangles(sheaf_geometry_input* input, const sheaf_triangles* triangles,
                                 uint32_t* object) {
  return Guarded([&] { return AddTriangles(input, triangles, SHEAF_TRIANGLES_INIT, object); });
}
sheaf_status sheaf_add_triangles_d(sheaf_geometry_input* input, const sheaf_triangles_d* triangles,
                                   uint32_t* object) {
  return Guarded([&] { return AddTriangles(input, triangles, SHEAF_TRIANGLES_D_INIT, object); });
}

sheaf_status sheaf_add_spheres(sheaf_geometry_input* input, const float* spheres, size_t count,
                               size_t stride, uint32_t* object) {
  return Guarded(
      [&] { return AddNumbers(input, "spheres", spheres, count, 4, stride, object, kAddSpheres); });
}
sheaf_status sheaf_add_spheres_d(sheaf_geometry_input* input, const double* spheres, size_t count,
                                 size_t stride, uint32_t* object) {
  return Guarded(
      [&] { return AddNumbers(input, "spheres", spheres, count, 4, stride, object, kAddSpheres); });
}

sheaf_status sheaf_add_disks(sheaf_geometry_input* input, const float* disks, size_t count,
                             size_t stride, uint32_t* object) {
  return Guarded(
      [&] { return AddNumbers(input, "disks", disks, count, 7, stride, object, kAddDisks); });
}
sheaf_status sheaf_add_disks_d(sheaf_geometry_input* input, const double* disks, size_t count,
                               size_t stride, uint32_t* object) {
  return Guarded(
      [&] { return AddNumbers(input, "disks", disks, count, 7, stride, object, kAddDisks); });
}

sheaf_status sheaf_geometry_build(const sheaf_geometry_input* input,
                                  const sheaf_build_options* options, sheaf_geometry** geometry) {
  return Make(geometry, "geometry is NULL", [&] { return Build<float>(input, options); });
}
sheaf_status sheaf_geometry_build_d(const sheaf_geometry_input* input,
                                    const sheaf_build_options* options,
                                    sheaf_geometry_d** geometry) {
  return Make(geometry, "geometry is NULL", [&] { return Build<double>(input, options); });
}

sheaf_status sheaf_geometry_update(sheaf_geometry* geometry, const sheaf_geometry_input* input,
                                   const sheaf_update_options* options, int32_t* rebuilt) {
  return Guarded([&] { return Update(geometry, input, options, rebuilt); });
}
sheaf_status sheaf_geometry_update_d(sheaf_geometry_d* geometry, const sheaf_geometry_input* input,
                                     const sheaf_update_options* options, int32_t* rebuilt) {
  return Guarded([&] { return Update(geometry, input, options, rebuilt); });
}

void sheaf_geometry_destroy(sheaf_geometry* geometry) { delete geometry; }
void sheaf_geometry_destroy_d(sheaf_geometry_d* geometry) { delete geometry; }

sheaf_status sheaf_geometry_save(const sheaf_geometry* geometry, const char* path) {
  return Guarded([&] { return Save(geometry, path); });
}
sheaf_status sheaf_geometry_save_d(const sheaf_geometry_d* geometry, const char* path) {
  return Guarded([&] { return Save(geometry, path); });
}

sheaf_status sheaf_geometry_map(const char* path, sheaf_map_check check,
                                sheaf_geometry** geometry) {
  return Make(geometry, "geometry is NULL", [&] { return Map<float>(path, check); });
}
sheaf_status sheaf_geometry_map_d(const char* path, sheaf_map_check check,
                                  sheaf_geometry_d** geometry) {
  return Make(geometry, "geometry is NULL", [&] { return Map<double>(path, check); });
}

sheaf_status sheaf_geometry_get_statistics(const sheaf_geometry* geometry,
                                           sheaf_geometry_statistics* statistics) {
  return Guarded([&] { return GetStatistics(geometry, statistics); });
}
sheaf_status sheaf_geometry_get_statistics_d(const sheaf_geometry_d* geometry,
                                             sheaf_geometry_statistics* statistics) {
  return Guarded([&] { return GetStatistics(geometry, statistics); });
}

sheaf_status sheaf_geometry_first_primitive(const sheaf_geometry* geometry, uint32_t object,
                                            uint32_t* primitive) {
  return Guarded([&] { return FirstPrimitive(geometry, object, primitive); });
}
sheaf_status sheaf_geometry_first_primitive_d(const sheaf_geometry_d* geometry, uint32_t object,
                                              uint32_t* primitive) {
  return Guarded([&] { return FirstPrimitive(geometry, object, primitive); });
}
