#include "src/render/round_corners.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

#include "src/scene/direction.h"

namespace sheaf {
namespace {

// A plane may move by this much of the distance that the eye sees from.
constexpr double kPlaneSlack = 0x1p-16;
constexpr double kFloatRoundoff = 0x1p-24;
// So many floats are tried for a corner.
constexpr int kMostTried = 1 << 13;
// Corners as near as this, relative to where they lie, are one.
constexpr double kSamePlace = 0x1p-20;

template <typename S>
auto CornersOf(S& shape) {
  using Point = std::conditional_t<std::is_const_v<S>, const Vec3d, Vec3d>;
  if (auto* quad = std::get_if<Quad>(&shape)) return std::span<Point>(quad->corners);
  if (auto* triangle = std::get_if<Triangle>(&shape)) return std::span<Point>(triangle->vertices);
  return std::span<Point>();
}

// Unit; NaN where the corners lie in a line.
Vec3d NormalOf(std::span<const Vec3d> corners) {
  return glm::normalize(glm::cross(corners[2] - corners[0], corners.back() - corners[1]));
}

// g++ 12 takes the conversion to float and back for none where it still has the double; through
// memory it cannot.
Vec3d NearestFloats(const Vec3d& p) {
  volatile float numbers[3];
  for (int i = 0; i < 3; ++i) numbers[i] = static_cast<float>(p[i]);
  return {numbers[0], numbers[1], numbers[2]};
}

// The floats around a point of a plane. Steps go along the two axes that the plane is least steep
// to; along the third, the normal's largest, a float follows the plane.
class FloatsNear {
 public:
  FloatsNear(const Vec3d& point, const Vec3d& normal)
      : point_(point), normal_(normal), nearest_(NearestFloats(point)) {
    for (int i = 1; i < 3; ++i) {
      if (std::abs(normal[i]) > std::abs(normal[along_])) along_ = i;
    }
    // Where a coordinate is near 0, floats lie closer than the outline has to keep.
    const double least = Spacing(LargestComponent(point)) * 0x1p-10;
    for (int i = 0; i < 3; ++i) {
      // A step in the plane changes nothing.
      step_[i] = normal[i] == 0 ? 0 : std::max(Spacing(point[i]), least);
    }
  }

  // How far it lies from the plane.
  double Distance(const Vec3d& p) const { return std::abs(glm::dot(normal_, p - point_)); }

  // The nearest to the point of those within `slack` of the plane, or the best of those tried.
  Vec3d Choose(double slack) const {
    Vec3d best = nearest_;
    int a = (along_ + 1) % 3, b = (along_ + 2) % 3;
    if (step_[b] == 0) std::swap(a, b);
    if (step_[b] == 0) return best;
    int tried = 0;
    const auto attempt = [&](int i, int j) {
      const Vec3d p = StepTo(a, i, b, j);
      // The outline does not give way for less.
      if (Distance(p) <= std::max(slack, Distance(best) / 2)) best = p;
      ++tried;
    };
    for (int ring = 0; tried < kMostTried && Distance(best) > slack; ++ring) {
      const int across = step_[a] == 0 ? 0 : ring;
      for (int i = -across; i <= across; ++i) {
        attempt(i, -ring);
        attempt(i, ring);
      }
      for (int j = 1 - ring; j < ring && across > 0; ++j) {
        attempt(-ring, j);
        attempt(ring, j);
      }
    }
    return best;
  }

 private:
  static double Spacing(double x) {
    const auto f = static_cast<float>(std::abs(x));
    return static_cast<double>(std::nextafter(f, std::numeric_limits<float>::infinity()) - f);
  }

  Vec3d StepTo(int a, int i, int b, int j) const {
    Vec3d p = nearest_;
    p[a] += i * step_[a];
    p[b] += j * step_[b];
    const double off = normal_[a] * (p[a] - point_[a]) + normal_[b] * (p[b] - point_[b]);
    p[along_] = point_[along_] - off / normal_[along_];
    return NearestFloats(p);
  }

  Vec3d point_, normal_, nearest_, step_;
  int along_ = 0;
};

// Whether a shape other than `self` has a corner in this place.
bool IsShared(const Scene& scene, const Object& self, const Vec3d& corner) {
  const double slack = kSamePlace * LargestComponent(corner);
  const auto is_there = [&](const Vec3d& p) { return LargestComponent(p - corner) <= slack; };
  return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
    if (&object == &self) return false;
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
      return std::any_of(mesh->positions.begin(), mesh->positions.end(),
                         [&](const glm::vec3& p) { return is_there(Vec3d(p)); });
    }
    const std::span<const Vec3d> corners = CornersOf(object.shape);
    return std::any_of(corners.begin(), corners.end(), is_there);
  });
}

std::vector<ShapePrimitive> PrimitivesOf(const Shape& shape) {
  std::vector<ShapePrimitive> primitives;
  ForEachPrimitive(shape, [&](const ShapePrimitive& p) { primitives.push_back(p); });
  return primitives;
}

Vec3d Corner(const ShapePrimitive& triangle, std::size_t k) {
  return {triangle.fields[3 * k], triangle.fields[3 * k + 1], triangle.fields[3 * k + 2]};
}

// A texture stays where it was: the coordinates that a triangle has at a point of its plane.
glm::dvec2 CoordinatesAt(const ShapePrimitive& triangle, const Vec3d& p) {
  const Vec3d e = Corner(triangle, 1) - Corner(triangle, 0);
  const Vec3d f = Corner(triangle, 2) - Corner(triangle, 0), d = p - Corner(triangle, 0);
  const double ee = glm::dot(e, e), ff = glm::dot(f, f), ef = glm::dot(e, f);
  const double de = glm::dot(d, e), df = glm::dot(d, f), det = ee * ff - ef * ef;
  const auto& uv = triangle.uv;
  return uv[0] + (uv[1] - uv[0]) * ((de * ff - df * ef) / det) +
         (uv[2] - uv[0]) * ((df * ee - de * ef) / det);
}

// Rounds the corners of a shape that is placed; `scene` has it, as `self`, where it was. Returns
// whether any of them is not the nearest float.
bool RoundShape(const Scene& scene, const Object& self, double slack, Shape& placed) {
  const std::span<Vec3d> corners = CornersOf(placed);
  const Vec3d normal = NormalOf(corners);
  const std::span<const Vec3d> given = CornersOf(self.shape);
  bool is_other = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const FloatsNear floats(corners[i], normal);
    const Vec3d nearest = NearestFloats(corners[i]);
    // False for NaN: a shape without a plane stays.
    const bool is_off = floats.Distance(nearest) > slack;
    corners[i] = is_off && !IsShared(scene, self, given[i]) ? floats.Choose(slack) : nearest;
    is_other |= corners[i] != nearest;
  }
  return is_other;
}

double SlackOf(const ScenePlacement& placement) {
  return placement.Length(placement.nearest) * kPlaneSlack;
}

// Whether rounding can carry no corner so far.
bool IsSmall(const Shape& shape, const ScenePlacement& placement, double slack) {
  const std::span<const Vec3d> corners = CornersOf(shape);
  return std::all_of(corners.begin(), corners.end(), [&](const Vec3d& corner) {
    return LargestComponent(placement.Point(corner)) * 2 * kFloatRoundoff <= slack;
  });
}

Shape Placed(Shape shape, const ScenePlacement& placement) {
  for (Vec3d& corner : CornersOf(shape)) corner = placement.Point(corner);
  return shape;
}

}  // namespace

void FitCorner(const Scene& scene, ScenePlacement& placement) {
  double largest = 0;
  Vec3d shift(0.0);
  const double slack = SlackOf(placement);
  for (const Object& object : scene.objects) {
    if (IsSmall(object.shape, placement, slack)) continue;
    const Shape placed = Placed(object.shape, placement);
    const std::span<const Vec3d> corners = CornersOf(placed);
    const Vec3d off = corners[0] - NearestFloats(corners[0]);
    // False for NaN: a shape without a plane.
    const bool is_off = std::abs(glm::dot(off, NormalOf(corners))) > slack;
    if (!is_off || LargestComponent(corners[0]) <= largest) continue;
    largest = LargestComponent(corners[0]);
    shift = off / placement.scale;
  }
  placement.origin += shift;
}

std::map<std::uint32_t, std::vector<ShapePrimitive>> RoundCorners(const Scene& scene,
                                                                  const ScenePlacement& placement) {
  std::map<std::uint32_t, std::vector<ShapePrimitive>> rounded;
  const double slack = SlackOf(placement);
  for (std::uint32_t object = 0; object < scene.objects.size(); ++object) {
    // What has no corners, a mesh too, is not copied.
    if (IsSmall(scene.objects[object].shape, placement, slack)) continue;
    Shape placed = Placed(scene.objects[object].shape, placement);
    const std::vector<ShapePrimitive> exact = PrimitivesOf(placed);
    if (!RoundShape(scene, scene.objects[object], slack, placed)) continue;
    std::vector<ShapePrimitive> primitives = PrimitivesOf(placed);
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        primitives[i].uv[k] = CoordinatesAt(exact[i], Corner(primitives[i], k));
      }
    }
    rounded.emplace(object, std::move(primitives));
  }
  return rounded;
}

}  // namespace sheaf
