#include "src/view/pick.h"

#include <fmt/format.h>

#include "src/formats/printable.h"
#include "src/lab/object_at.h"
#include "src/scene/shapes.h"

namespace sheaf {
namespace {

Vec3d ToVec(const float* numbers) {
  return {static_cast<double>(numbers[0]), static_cast<double>(numbers[1]),
          static_cast<double>(numbers[2])};
}

// Adding 0 turns -0 into 0.
std::string VecText(const Vec3d& v) {
  return fmt::format("({:.7g}, {:.7g}, {:.7g})", v.x + 0, v.y + 0, v.z + 0);
}

std::string NameText(const std::string& name) {
  return name.empty() ? "without a name" : fmt::format("\"{}\"", Printable(name));
}

}  // namespace

Result<Pick> PickPixel(const ViewRequest& request, int x, int y) {
  const Scene& scene = *request.scene;
  const FrameGoal& goal = request.goal;
  RenderOptions options = OptionsOf(request, {goal.width, goal.height, 1, false});
  options.contrast.reset();
  options.crop = PixelRect{x, y, x + 1, y + 1};
  for (const Layer layer : {Layer::kDepth, Layer::kNormal, Layer::kAlbedo, Layer::kId}) {
    options.layers.Add(layer);
  }
  RenderStats stats;
  const Result<Film> rendered = Render(scene, request.camera, options, &stats);
  if (!rendered) return rendered.error();
  const Film& film = rendered.value();

  Pick pick;
  pick.x = x;
  pick.y = y;
  pick.rays = stats.rays;
  pick.colour = ToVec(film.pixel(0, 0));
  const PixelRay ray = RayAt(scene, request.camera, goal.width, goal.height, x, y);
  pick.ray = stress::RayText(ray.computed);
  const auto id = static_cast<std::size_t>(*film.at(Layer::kId, 0, 0));
  if (id == 0) return pick;
  pick.object = id - 1;
  const Object& object = ObjectAt(scene, *pick.object);
  pick.object_name = object.name;
  pick.material_name = scene.materials[object.material].name;
  pick.distance = static_cast<double>(*film.at(Layer::kDepth, 0, 0));
  pick.point = ray.origin + ray.direction * pick.distance;
  pick.normal = ToVec(film.at(Layer::kNormal, 0, 0));
  pick.albedo = ToVec(film.at(Layer::kAlbedo, 0, 0));
  return pick;
}

std::vector<std::string> LinesOf(const Pick& pick) {
  std::vector<std::string> lines = {fmt::format("pixel {}, {}", pick.x, pick.y)};
  if (pick.object) {
    lines.push_back(fmt::format("object {} {}, material {}", *pick.object,
                                NameText(pick.object_name), NameText(pick.material_name)));
    lines.push_back(fmt::format("t {:.9g} at {}", pick.distance, VecText(pick.point)));
    lines.push_back("normal " + VecText(pick.normal));
    lines.push_back("albedo " + VecText(pick.albedo));
  } else {
    lines.push_back("no object");
  }
  lines.push_back("colour " + VecText(pick.colour));
  lines.push_back(fmt::format("rays {} primary, {} shadow, {} reflected, {} refracted",
                              pick.rays.primary, pick.rays.shadow, pick.rays.reflected,
                              pick.rays.refracted));
  lines.push_back("ray " + pick.ray);
  return lines;
}

}  // namespace sheaf
