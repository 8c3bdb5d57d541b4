#include "src/scene/shapes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <utility>

#include "src/core/match.h"

namespace sheaf {
namespace {

ShapePrimitive TrianglePrimitive(const Triangle& triangle) {
  ShapePrimitive primitive{PrimitiveKind::kTriangle, {}, triangle.uv};
  for (std::size_t k = 0; k < 9; ++k) {
    primitive.fields[k] = triangle.vertices[k / 3][static_cast<int>(k % 3)];
  }
  return primitive;
}

// How far a disk reaches from its center along each axis.
Vec3d ReachOf(const Disk& disk) {
  const Vec3d square = disk.normal * disk.normal;
  const double sum = square.x + square.y + square.z;
  const auto along = [&](double a, double b) {
    return sum > 0 ? disk.radius * std::sqrt((a + b) / sum) : 0.0;
  };
  return {along(square.y, square.z), along(square.z, square.x), along(square.x, square.y)};
}

// The vector scaled by a power of two, which rounds nothing, so that its largest component is in
// [1, 2): no square of it leaves the range of float.
Vec3d WithUnitExponent(const Vec3d& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0)) return v;
  const int down = -std::ilogb(largest);
  return {std::scalbn(v.x, down), std::scalbn(v.y, down), std::scalbn(v.z, down)};
}

const char* MoveMesh(const Transform& transform, Mesh& mesh) {
  const glm::dmat3& linear = transform.linear;
  // Normals go with the cofactors: the inverse transposed, without its scale.
  const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                             glm::cross(linear[0], linear[1]));
  const bool mirrors = glm::determinant(linear) < 0;
  const double side = mirrors ? -1 : 1;
  for (glm::vec3& p : mesh.positions) p = glm::vec3(transform.Point(Vec3d(p)));
  for (glm::vec3& n : mesh.normals) {
    const Vec3d normal = cofactors * Vec3d(n) * side;
    const double length = glm::length(normal);
    n = length > 0 ? glm::vec3(normal / length) : glm::vec3(0);
  }
  // A mirror turns the order of corners round, and with it the front.
  if (mirrors) {
    for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
  }
  const bool is_finite =
      std::all_of(mesh.positions.begin(), mesh.positions.end(), [](const glm::vec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
      });
  return is_finite ? "" : "a vertex is not finite after the transform";
}

}  // namespace

void ForEachExtreme(const Shape& shape, const std::function<void(const Vec3d&)>& include) {
  Match(
      shape,
      [&](const Sphere& sphere) {
        include(sphere.center - sphere.radius);
        include(sphere.center + sphere.radius);
      },
      [&](const Disk& disk) {
        const Vec3d reach = ReachOf(disk);
        include(disk.center - reach);
        include(disk.center + reach);
      },
      [&](const Quad& quad) {
        for (const Vec3d& corner : quad.corners) include(corner);
      },
      [&](const Triangle& triangle) {
        for (const Vec3d& vertex : triangle.vertices) include(vertex);
      },
      [&](const Mesh& mesh) {
        // What no triangle uses is not there: scans have such vertices, far away.
        if (mesh.triangles.empty()) return;
        glm::vec3 low = mesh.positions[mesh.triangles[0][0]], high = low;
        for (const auto& triangle : mesh.triangles) {
          for (const std::uint32_t vertex : triangle) {
            low = glm::min(low, mesh.positions[vertex]);
            high = glm::max(high, mesh.positions[vertex]);
          }
        }
        include(Vec3d(low));
        include(Vec3d(high));
      });
}

std::string TransformShape(const Transform& transform, Shape* shape) {
  return Match(
      *shape,
      [&](Sphere& sphere) {
        if (!transform.KeepsSpheres()) {
          return "a sphere can be turned, moved and scaled alike along all axes only";
        }
        sphere.center = transform.Point(sphere.center);
        sphere.radius *= transform.Scale();
        return "";
      },
      [&](Disk& disk) {
        if (!transform.KeepsSpheres()) {
          return "a disk can be turned, moved and scaled alike along all axes only";
        }
        disk.center = transform.Point(disk.center);
        disk.radius *= transform.Scale();
        disk.normal = transform.Vector(disk.normal);
        return "";
      },
      [&](Quad& quad) {
        for (Vec3d& corner : quad.corners) corner = transform.Point(corner);
        return "";
      },
      [&](Triangle& triangle) {
        for (Vec3d& vertex : triangle.vertices) vertex = transform.Point(vertex);
        return "";
      },
      [&](Mesh& mesh) { return MoveMesh(transform, mesh); });
}

void ForEachPrimitive(const Shape& shape, const std::function<void(const ShapePrimitive&)>& add) {
  Match(
      shape,
      [&](const Sphere& sphere) {
        const Vec3d& c = sphere.center;
        add({PrimitiveKind::kSphere, {c.x, c.y, c.z, sphere.radius}, {}});
      },
      [&](const Disk& disk) {
        const Vec3d& c = disk.center;
        const Vec3d n = WithUnitExponent(disk.normal);
        add({PrimitiveKind::kDisk, {c.x, c.y, c.z, disk.radius, n.x, n.y, n.z}, {}});
      },
      [&](const Quad& quad) {
        const auto& c = quad.corners;
        const glm::dvec2 uv[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        add(TrianglePrimitive({{c[0], c[1], c[2]}, {uv[0], uv[1], uv[2]}}));
        add(TrianglePrimitive({{c[0], c[2], c[3]}, {uv[0], uv[2], uv[3]}}));
      },
      [&](const Triangle& triangle) { add(TrianglePrimitive(triangle)); }, [](const Mesh&) {});
}

CountsByKind<std::uint64_t> CountPrimitives(const Scene& scene) {
  CountsByKind<std::uint64_t> counts;
  ForEachObject(scene, [&](const Object& object) {
    ForEachPrimitive(object.shape,
                     [&](const ShapePrimitive& primitive) { ++counts[primitive.kind]; });
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
      counts[PrimitiveKind::kTriangle] += mesh->triangles.size();
    }
  });
  return counts;
}

const Object& ObjectAt(const Scene& scene, std::size_t number) {
  if (number < scene.objects.size()) return scene.objects[number];
  number -= scene.objects.size();
  auto group = scene.groups.begin();
  for (; number >= group->objects.size(); ++group) number -= group->objects.size();
  return group->objects[number];
}

}  // namespace sheaf
