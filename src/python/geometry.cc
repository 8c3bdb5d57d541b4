// Geometries, rays and hits, on the arrays of NumPy as they lie in memory.
#include "sheaf/geometry.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sheaf/target.h"
#include "src/python/arrays.h"
#include "src/python/bindings.h"
#include "src/python/errors.h"

namespace sheaf::python {
namespace {

namespace py = pybind11;

// An object as the Python side gives it: its kind and its arrays without gaps.
template <typename Real>
void AddObject(const py::tuple& object, GeometryInput* input, std::vector<py::array>* kept) {
  const auto numbers = [&](std::size_t i) {
    const auto array = object[i].cast<py::array_t<Real, py::array::c_style>>();
    kept->push_back(array);
    return std::span<const Real>(array.data(), static_cast<std::size_t>(array.size()));
  };
  const auto kind = object[0].cast<std::string>();
  if (kind == "spheres") {
    input->AddSpheres(numbers(1));
  } else if (kind == "disks") {
    input->AddDisks(numbers(1));
  } else {
    const auto ids = object[2].cast<py::array_t<std::uint32_t, py::array::c_style>>();
    kept->push_back(ids);
    const std::span<const std::uint32_t> indices(ids.data(), static_cast<std::size_t>(ids.size()));
    const auto vertices = numbers(1);
    if (object[3].is_none()) {
      input->AddTriangles(vertices, indices);
    } else {
      input->AddTriangles(vertices, indices, numbers(3));
    }
  }
}

NotFinite NotFiniteOf(const std::string& name) {
  return name == "skip" ? NotFinite::kSkipped : NotFinite::kRefused;
}

// Calls call(input) without the interpreter's lock.
template <typename Real, typename Call>
auto WithInput(const py::list& objects, const Call& call) {
  GeometryInput input;
  std::vector<py::array> kept;
  for (const py::handle object : objects) {
    AddObject<Real>(object.cast<py::tuple>(), &input, &kept);
  }
  auto made = [&] {
    const py::gil_scoped_release release;
    return call(input);
  }();
  if (!made) Check(made.error());
  return std::move(made).value();
}

template <typename Real>
GeometryOf<Real> Build(const py::list& objects, int threads, const std::string& not_finite) {
  return WithInput<Real>(objects, [&](const GeometryInput& input) {
    return GeometryOf<Real>::Build(input,
                                   {.threads = threads, .not_finite = NotFiniteOf(not_finite)});
  });
}

// Whether the tree was built anew.
template <typename Real>
bool Update(GeometryOf<Real>& geometry, const py::list& objects, int threads,
            const std::string& not_finite, double rebuild_ratio) {
  const Updated updated = WithInput<Real>(objects, [&](const GeometryInput& input) {
    return geometry.Update(input, {.threads = threads,
                                   .not_finite = NotFiniteOf(not_finite),
                                   .rebuild_ratio = rebuild_ratio});
  });
  return updated == Updated::kRebuilt;
}

template <typename Real>
py::dict StatisticsOf(const GeometryOf<Real>& geometry) {
  const GeometryStatistics from = geometry.statistics();
  py::dict to;
  to["objects"] = geometry.object_count();
  to["primitives"] = from.primitives;
  to["triangles"] = from.triangles;
  to["spheres"] = from.spheres;
  to["disks"] = from.disks;
  to["never_hit"] = from.never_hit;
  to["skipped"] = from.skipped;
  to["nodes"] = from.nodes;
  to["leaves"] = from.leaves;
  to["depth"] = from.depth;
  to["bytes"] = from.bytes;
  return to;
}

template <typename Real>
py::tuple Closest(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
                  const Options<Real>& options) {
  options.CheckFits(rays);
  Hits<Real> hits(rays.count);
  const HitArraysOf<Real> arrays = hits.arrays();
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceClosest(geometry, rays.arrays, rays.count, arrays, options.options);
  }();
  Check(traced);
  return py::make_tuple(hits.t, hits.primitive, hits.object, hits.u, hits.v);
}

template <typename Real>
Ids Occluded(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
             const Options<Real>& options) {
  options.CheckFits(rays);
  Ids occluded(static_cast<py::ssize_t>(rays.count));
  std::uint32_t* const into = occluded.mutable_data();
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceOccluded(geometry, rays.arrays, rays.count, into, options.options);
  }();
  Check(traced);
  return occluded;
}

template <typename Real>
py::dict Points(const GeometryOf<Real>& geometry, const Rays<Real>& rays, const py::tuple& found,
                const std::string& target) {
  const auto t = found[0].cast<py::array_t<Real, py::array::c_style>>();
  const auto primitive = found[1].cast<py::array_t<std::uint32_t, py::array::c_style>>();
  const auto u = found[2].cast<py::array_t<Real, py::array::c_style>>();
  const auto v = found[3].cast<py::array_t<Real, py::array::c_style>>();
  for (const py::array& array : {py::array(t), py::array(primitive), py::array(u), py::array(v)}) {
    if (static_cast<std::size_t>(array.size()) != rays.count) {
      throw py::value_error("hits: arrays of another length");
    }
  }
  HitArraysOf<Real> hits;  // read alone
  hits.t = const_cast<Real*>(t.data());
  hits.primitive = const_cast<std::uint32_t*>(primitive.data());
  hits.u = const_cast<Real*>(u.data());
  hits.v = const_cast<Real*>(v.data());
  HitPointArraysOf<Real> points;
  py::dict made;
  made["point"] = Columns(rays.count, &points.position);
  made["face_normal"] = Columns(rays.count, &points.face);
  made["normal"] = Columns(rays.count, &points.normal);
  made["front"] = Columns(rays.count, &points.front);
  made["back"] = Columns(rays.count, &points.back);
  const auto ids = [&](const char* name) {
    Ids array(static_cast<py::ssize_t>(rays.count));
    made[name] = array;
    return array.mutable_data();
  };
  points.front_source = ids("front_source");
  points.back_source = ids("back_source");
  points.side = ids("side");
  const Options<Real> options({}, {}, 0, target);
  const Status status = [&] {
    const py::gil_scoped_release release;
    return FindHitPoints(geometry, rays.arrays, hits, rays.count, points, options.options.target);
  }();
  Check(status);
  return made;
}

template <typename Real>
GeometryOf<Real> Map(const std::string& path, const std::string& check) {
  Result<GeometryOf<Real>> mapped = [&] {
    const py::gil_scoped_release release;
    return GeometryOf<Real>::Map(path, check == "header" ? MapCheck::kHeader : MapCheck::kAll);
  }();
  if (!mapped) Check(mapped.error());
  return std::move(mapped).value();
}

template <typename Real>
void AddGeometryOf(py::module_& module, const std::string& number) {
  using Geometry = GeometryOf<Real>;
  py::class_<Rays<Real>>(module, ("Rays" + number).c_str())
      .def(py::init<py::array_t<Real>, py::array_t<Real>, std::optional<Ids>>());
  py::class_<Options<Real>>(module, ("Options" + number).c_str())
      .def(py::init<Values<Real>, Values<Real>, int, const std::string&>());
  py::class_<Geometry> type(module, ("Geometry" + number).c_str());
  type.def(py::init(&Build<Real>))
      .def("update", &Update<Real>)
      .def("save",
           [](const Geometry& geometry, const std::string& path) {
             const Status saved = [&] {
               const py::gil_scoped_release release;
               return geometry.Save(path);
             }();
             Check(saved);
           })
      .def_static("map", &Map<Real>)
      .def("statistics", &StatisticsOf<Real>)
      .def("bounds", [](const Geometry& g) { return py::make_tuple(g.lower(), g.upper()); })
      .def("first_primitives",
           [](const Geometry& geometry) {
             std::vector<std::uint32_t> first;
             for (std::uint32_t i = 0; i <= geometry.object_count(); ++i) {
               first.push_back(geometry.first_primitive(i));
             }
             return py::array_t<std::uint32_t>(static_cast<py::ssize_t>(first.size()),
                                               first.data());
           })
      .def("closest", &Closest<Real>)
      .def("occluded", &Occluded<Real>)
      .def("points", &Points<Real>);
  AddQueries<Real>(type);
}

}  // namespace

void AddGeometry(py::module_& module) {
  AddGeometryOf<float>(module, "Float");
  AddGeometryOf<double>(module, "Double");
}

}  // namespace sheaf::python
