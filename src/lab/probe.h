// A geometry whose hits are found in every way that there is, all of which have to agree.
#ifndef SHEAF_LAB_PROBE_H_
#define SHEAF_LAB_PROBE_H_

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <string>
#include <vector>

#include "sheaf/geometry.h"
#include "sheaf/target.h"
#include "simd/tree.h"
#include "src/bvh/geometry_access.h"
#include "src/lab/stress.h"
#include "src/scalar/trace.h"

namespace sheaf::stress {

using Hit = scalar::Hit<float>;
using Vec = Vec3<float>;

// Triangles first, then spheres, then other kinds: the order of primitive ids.
struct Shapes {
  std::vector<float> vertices;          // x, y, z
  std::vector<std::uint32_t> indices;   // three a triangle
  std::vector<float> spheres;           // center, radius
  std::vector<float> more[kKindCount];  // fields of other kinds, in the order of their arrays

  std::uint32_t AddVertex(Vec position);
  void AddTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
  void AddTriangle(Vec a, Vec b, Vec c);
  void AddQuad(Vec a, Vec b, Vec c, Vec d);  // as two triangles that share vertices
  void AddSphere(Vec center, float radius);
  void AddMore(PrimitiveKind kind, std::initializer_list<float> fields);
  Vec vertex(std::uint32_t i) const;
  std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices.size() / 3); }
  std::uint32_t primitive_count() const;
};

// A closed sphere of triangles, `rings` from pole to pole and twice as many around.
void AddSphereMesh(Shapes& shapes, Vec center, float radius, std::uint32_t rings);

// The shapes as the arrays that src/scalar reads.
class FlatShapes {
 public:
  explicit FlatShapes(const Shapes& shapes);
  GeometryView<float> view() const { return flat_.arrays.view(); }

 private:
  FlatInput flat_;
};

// The shapes must outlive it.
GeometryInput InputOf(const Shapes& shapes);

// The nearest hit of each ray, by src/scalar over every primitive. `report` learns where the
// baseline's tree or a kernel of any target has other bits, nearest hit and occlusion alike.
// kTreeOnly spares the specification over every primitive, for geometries too large for it.
enum class Oracle { kEveryPrimitive, kTreeOnly };
std::vector<Hit> TraceEverywhere(Report& report, const Shapes& shapes, const std::vector<Ray>& rays,
                                 Oracle oracle = Oracle::kEveryPrimitive);

bool IsHit(const Hit& hit);

// Calls body(target) for each usable target; `report` learns where another one runs.
void ForEachTarget(Report& report, const std::function<void(Target target)>& body);

}  // namespace sheaf::stress

#endif  // SHEAF_LAB_PROBE_H_
