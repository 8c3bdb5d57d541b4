// Geometries of <sheaf/capi.h>: building them and tracing rays.
#include <span>

#include "src/capi/batch.h"
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

Status AddTriangles(sheaf_geometry_input* input, const sheaf_triangles* given,
                    std::uint32_t* object) {
  if (input == nullptr) return UsageError("input is NULL");
  sheaf_triangles mesh = SHEAF_TRIANGLES_INIT;
  if (const Status taken = Take(given, "triangles", &mesh); !taken) return taken.error();
  const auto vertices =
      Gather("vertices", mesh.vertices, mesh.vertex_count, 3, mesh.vertex_stride, &input->numbers);
  if (!vertices) return vertices.error();
  const auto indices =
      Gather("indices", mesh.indices, mesh.triangle_count, 3, mesh.index_stride, &input->indices);
  if (!indices) return indices.error();
  const std::size_t normal_count = mesh.normals == nullptr ? 0 : mesh.vertex_count;
  const auto normals =
      Gather("normals", mesh.normals, normal_count, 3, mesh.normal_stride, &input->numbers);
  if (!normals) return normals.error();
  const std::uint32_t id =
      input->input.AddTriangles(vertices.value(), indices.value(), normals.value());
  if (object != nullptr) *object = id;
  return Done{};
}

// Spheres or disks.
template <typename Add>
Status AddNumbers(sheaf_geometry_input* input, const Result<std::span<const float>>& numbers,
                  std::uint32_t* object, Add add) {
  if (!numbers) return numbers.error();
  const std::uint32_t id = add(input->input, numbers.value());
  if (object != nullptr) *object = id;
  return Done{};
}

Result<Geometry> Build(const sheaf_geometry_input* input, const sheaf_build_options* given) {
  if (input == nullptr) return UsageError("input is NULL");
  sheaf_build_options options = SHEAF_BUILD_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  if (options.threads < 0) return UsageError("options: threads is below 0");
  return Geometry::Build(
      input->input,
      {.threads = options.threads,
       .not_finite = options.skip_not_finite != 0 ? NotFinite::kSkipped : NotFinite::kRefused});
}

Status Update(sheaf_geometry* geometry, const sheaf_geometry_input* input,
              const sheaf_update_options* given, std::int32_t* rebuilt) {
  if (geometry == nullptr) return UsageError("geometry is NULL");
  if (input == nullptr) return UsageError("input is NULL");
  sheaf_update_options options = SHEAF_UPDATE_OPTIONS_INIT;
  if (const Status taken = TakeIfGiven(given, "options", &options); !taken) return taken.error();
  if (options.threads < 0) return UsageError("options: threads is below 0");
  const Result<Updated> updated = geometry->geometry.Update(
      input->input,
      {.threads = options.threads,
       .not_finite = options.skip_not_finite != 0 ? NotFinite::kSkipped : NotFinite::kRefused,
       .rebuild_ratio = options.rebuild_ratio});
  if (!updated) return updated.error();
  if (rebuilt != nullptr) *rebuilt = updated.value() == Updated::kRebuilt;
  return Done{};
}

Status GetStatistics(const sheaf_geometry* geometry, sheaf_geometry_statistics* statistics) {
  if (geometry == nullptr) return UsageError("geometry is NULL");
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
  const auto lower = geometry->geometry.lower(), upper = geometry->geometry.upper();
  std::copy(lower.begin(), lower.end(), own.lower);
  std::copy(upper.begin(), upper.end(), own.upper);
  return Put(own, "statistics", statistics);
}

std::array<float*, 3> Arrays(float* const (&from)[3]) { return {from[0], from[1], from[2]}; }

Status FindPoints(const Batch& batch, const sheaf_geometry& geometry, const HitArrays& hits,
                  const sheaf_hit_points* given, const char* target_name) {
  sheaf_hit_points points = SHEAF_HIT_POINTS_INIT;
  if (const Status taken = Take(given, "points", &points); !taken) return taken.error();
  const Result<Target> target = TargetOf(target_name);
  if (!target) return target.error();
  return FindHitPoints(geometry.geometry, batch.rays, hits, batch.count,
                       {.position = Arrays(points.position),
                        .face = Arrays(points.face),
                        .normal = Arrays(points.normal),
                        .front = Arrays(points.front),
                        .back = Arrays(points.back),
                        .front_source = points.front_source,
                        .back_source = points.back_source,
                        .side = points.side},
                       target.value());
}

static_assert(SHEAF_NO_PRIMITIVE == Geometry::kNoPrimitive);
static_assert(SHEAF_INSIDE_BIT == Geometry::kInsideBit);

}  // namespace
}  // namespace sheaf::capi

using namespace sheaf::capi;  // NOLINT: the C functions below stand outside of it
using sheaf::Done;
using sheaf::Result;
using sheaf::Status;

sheaf_status sheaf_geometry_input_create(sheaf_geometry_input** input) {
  return Make(input, "input is NULL", [] { return Result(sheaf::GeometryInput()); });
}

void sheaf_geometry_input_destroy(sheaf_geometry_input* input) { delete input; }

sheaf_status sheaf_add_triangles(sheaf_geometry_input* input, const sheaf_triangles* triangles,
                                 uint32_t* object) {
  return Guarded([&] { return AddTriangles(input, triangles, object); });
}

sheaf_status sheaf_add_spheres(sheaf_geometry_input* input, const float* spheres, size_t count,
                               size_t stride, uint32_t* object) {
  return Guarded([&] {
    if (input == nullptr) return Status(UsageError("input is NULL"));
    return AddNumbers(input, Gather("spheres", spheres, count, 4, stride, &input->numbers), object,
                      [](auto& to, auto numbers) { return to.AddSpheres(numbers); });
  });
}

sheaf_status sheaf_add_disks(sheaf_geometry_input* input, const float* disks, size_t count,
                             size_t stride, uint32_t* object) {
  return Guarded([&] {
    if (input == nullptr) return Status(UsageError("input is NULL"));
    return AddNumbers(input, Gather("disks", disks, count, 7, stride, &input->numbers), object,
                      [](auto& to, auto numbers) { return to.AddDisks(numbers); });
  });
}

sheaf_status sheaf_geometry_build(const sheaf_geometry_input* input,
                                  const sheaf_build_options* options, sheaf_geometry** geometry) {
  return Make(geometry, "geometry is NULL", [&] { return Build(input, options); });
}

sheaf_status sheaf_geometry_update(sheaf_geometry* geometry, const sheaf_geometry_input* input,
                                   const sheaf_update_options* options, std::int32_t* rebuilt) {
  return Guarded([&] { return Update(geometry, input, options, rebuilt); });
}

void sheaf_geometry_destroy(sheaf_geometry* geometry) { delete geometry; }

sheaf_status sheaf_geometry_get_statistics(const sheaf_geometry* geometry,
                                           sheaf_geometry_statistics* statistics) {
  return Guarded([&] { return GetStatistics(geometry, statistics); });
}

sheaf_status sheaf_geometry_first_primitive(const sheaf_geometry* geometry, uint32_t object,
                                            uint32_t* primitive) {
  return Guarded([&]() -> Status {
    if (geometry == nullptr) return UsageError("geometry is NULL");
    if (primitive == nullptr) return UsageError("primitive is NULL");
    const std::uint32_t count = geometry->geometry.object_count();
    if (object > count) {
      return UsageError("object " + std::to_string(object) + " of " + std::to_string(count));
    }
    *primitive = geometry->geometry.first_primitive(object);
    return Done{};
  });
}

sheaf_status sheaf_trace_closest(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                 const sheaf_hits* hits, const sheaf_trace_options* options) {
  return Guarded([&]() -> Status {
    const auto batch = TakeBatch(geometry, rays, options);
    if (!batch) return batch.error();
    const auto into = TakeHits(hits);
    if (!into) return into.error();
    return sheaf::TraceClosest(geometry->geometry, batch.value().rays, batch.value().count,
                               into.value(), batch.value().options);
  });
}

sheaf_status sheaf_trace_occluded(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                  uint32_t* occluded, const sheaf_trace_options* options) {
  return Guarded([&]() -> Status {
    const auto batch = TakeBatch(geometry, rays, options);
    if (!batch) return batch.error();
    return sheaf::TraceOccluded(geometry->geometry, batch.value().rays, batch.value().count,
                                occluded, batch.value().options);
  });
}

sheaf_status sheaf_find_hit_points(const sheaf_geometry* geometry, const sheaf_rays* rays,
                                   const sheaf_hits* hits, const sheaf_hit_points* points,
                                   const char* target) {
  return Guarded([&]() -> Status {
    const auto batch = TakeRays(geometry, rays);
    if (!batch) return batch.error();
    const auto from = TakeHits(hits);
    if (!from) return from.error();
    return FindPoints(batch.value(), *geometry, from.value(), points, target);
  });
}
