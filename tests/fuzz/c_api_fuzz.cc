// The C API's calls for rays: objects, strides, ids and numbers that are anything.
#include <cstdint>
#include <deque>
#include <vector>

#include "sheaf/capi.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

using sheaf::fuzz::Input;

std::vector<float> TakeFloats(Input& input, std::size_t count) {
  std::vector<float> numbers(count);
  for (float& number : numbers) {
    // Mostly of moderate size; sometimes any bits.
    number = input.Take<std::uint8_t>() < 240 ? static_cast<float>(input.Take<std::int8_t>()) / 16
                                              : input.Take<float>();
  }
  return numbers;
}

void Trace(Input& input, const sheaf_geometry* geometry) {
  const std::size_t count = input.Take<std::uint8_t>() % 80;
  const std::vector<float> numbers = TakeFloats(input, 8 * count);
  std::vector<std::uint32_t> source(count);
  for (std::uint32_t& id : source) {
    id = input.Take<std::uint8_t>() < 128 ? SHEAF_NO_PRIMITIVE : input.Take<std::uint32_t>();
  }
  const auto column = [&](std::size_t i) { return numbers.data() + i * count; };
  sheaf_rays rays = SHEAF_RAYS_INIT;
  rays.count = count;
  rays.origin_x = column(0), rays.origin_y = column(1), rays.origin_z = column(2);
  rays.direction_x = column(3), rays.direction_y = column(4), rays.direction_z = column(5);
  if (input.Take<std::uint8_t>() % 2) rays.source = source.data();
  sheaf_trace_options options = SHEAF_TRACE_OPTIONS_INIT;
  options.coherence = static_cast<sheaf_coherence>(input.Take<std::uint8_t>() % 5);
  if (input.Take<std::uint8_t>() % 2) options.t_min = column(6), options.t_max = column(7);
  const std::uint8_t choice = input.Take<std::uint8_t>();
  options.target = choice % 3 == 0   ? nullptr
                   : choice % 3 == 1 ? "scalar"
                                     : sheaf_target_name(choice % sheaf_target_count());
  std::vector<float> t(count), u(count), v(count);
  std::vector<std::uint32_t> primitive(count), object(count), occluded(count);
  sheaf_hits hits = SHEAF_HITS_INIT;
  hits.t = t.data(), hits.u = u.data(), hits.v = v.data();
  hits.primitive = primitive.data(), hits.object = object.data();
  if (sheaf_trace_closest(geometry, &rays, &hits, &options) != SHEAF_OK) return;
  if (sheaf_trace_occluded(geometry, &rays, occluded.data(), &options) != SHEAF_OK) {
    sheaf::fuzz::Fail("occlusion fails where the nearest hit does not");
  }
  for (std::size_t i = 0; i < count; ++i) {
    if ((occluded[i] != 0) != (primitive[i] != SHEAF_NO_PRIMITIVE)) {
      sheaf::fuzz::Fail("a hit without occlusion, or the reverse");
    }
  }
  std::vector<float> points(15 * count);
  std::vector<std::uint32_t> ids(3 * count);
  sheaf_hit_points found = SHEAF_HIT_POINTS_INIT;
  for (std::size_t k = 0; k < 3; ++k) {
    found.position[k] = points.data() + k * count;
    found.face[k] = points.data() + (3 + k) * count;
    found.normal[k] = points.data() + (6 + k) * count;
    found.front[k] = points.data() + (9 + k) * count;
    found.back[k] = points.data() + (12 + k) * count;
  }
  found.front_source = ids.data(), found.back_source = ids.data() + count;
  found.side = ids.data() + 2 * count;
  sheaf_find_hit_points(geometry, &rays, &hits, &found, options.target);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  sheaf_geometry_input* objects = nullptr;
  if (sheaf_geometry_input_create(&objects) != SHEAF_OK) return 0;
  // The arrays live until the geometry is built, as the header asks.
  std::deque<std::vector<float>> floats;
  std::deque<std::vector<std::uint32_t>> lists;
  for (int left = input.Take<std::uint8_t>() % 4; left > 0; --left) {
    const int kind = input.Take<std::uint8_t>() % 3;
    const std::size_t count = input.Take<std::uint8_t>() % 32;
    if (kind == 0) {
      const auto& vertices = floats.emplace_back(TakeFloats(input, 3 * count));
      const auto& normals =
          floats.emplace_back(TakeFloats(input, input.Take<std::uint8_t>() % 2 ? 3 * count : 0));
      auto& indices = lists.emplace_back(3 * (input.Take<std::uint8_t>() % 64));
      for (std::uint32_t& index : indices) {
        index = static_cast<std::uint32_t>(input.Take<std::uint8_t>() % (count + count / 16 + 1));
      }
      sheaf_triangles triangles = SHEAF_TRIANGLES_INIT;
      triangles.vertices = vertices.data(), triangles.vertex_count = count;
      triangles.indices = indices.data(), triangles.triangle_count = indices.size() / 3;
      if (!normals.empty()) triangles.normals = normals.data();
      sheaf_add_triangles(objects, &triangles, nullptr);
    } else {
      const auto& numbers = floats.emplace_back(TakeFloats(input, (kind == 1 ? 4 : 7) * count));
      (kind == 1 ? sheaf_add_spheres : sheaf_add_disks)(objects, numbers.data(), count, 0, nullptr);
    }
  }
  sheaf_build_options options = SHEAF_BUILD_OPTIONS_INIT;
  options.threads = 1;
  options.skip_not_finite = input.Take<std::uint8_t>() % 2;
  sheaf_geometry* geometry = nullptr;
  if (sheaf_geometry_build(objects, &options, &geometry) == SHEAF_OK) {
    while (!input.is_empty()) Trace(input, geometry);
    sheaf_geometry_destroy(geometry);
  }
  sheaf_geometry_input_destroy(objects);
  return 0;
}
