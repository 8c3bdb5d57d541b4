// Geometries in many places, on the arrays of NumPy as they lie in memory.
#include "sheaf/instances.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/python/arrays.h"
#include "src/python/bindings.h"
#include "src/python/errors.h"

namespace sheaf::python {
namespace {

namespace py = pybind11;

// The instances, and what keeps their geometries alive.
template <typename Real>
struct KeptInstances {
  InstancesOf<Real> instances;
  py::list geometries;
};

using Maps = py::array_t<double, py::array::c_style>;

// `maps`: 12 numbers a place; `which`: a geometry's position for each.
template <typename Real>
KeptInstances<Real> Build(const py::list& geometries, const Maps& maps, const Ids& which,
                          int threads) {
  std::vector<std::shared_ptr<const GeometryOf<Real>>> shared;
  for (const py::handle geometry : geometries) {
    // Python owns it: see KeptInstances.
    shared.emplace_back(std::shared_ptr<void>(), geometry.cast<const GeometryOf<Real>*>());
  }
  std::vector<Place> places(static_cast<std::size_t>(which.size()));
  if (maps.size() != 12 * which.size()) throw py::value_error("transforms: arrays of another size");
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].geometry = which.at(static_cast<py::ssize_t>(i));
    std::copy_n(maps.data() + 12 * i, 12, places[i].to_world.begin());
  }
  Result<InstancesOf<Real>> built = [&] {
    const py::gil_scoped_release release;
    return InstancesOf<Real>::Build(shared, places, threads);
  }();
  if (!built) Check(built.error());
  return {std::move(built).value(), geometries};
}

template <typename Real>
py::dict StatisticsOf(const KeptInstances<Real>& kept) {
  const InstanceStatistics from = kept.instances.statistics();
  py::dict to;
  to["instances"] = from.instances;
  to["geometries"] = from.geometries;
  to["nodes"] = from.nodes;
  to["depth"] = from.depth;
  to["bytes"] = from.bytes;
  return to;
}

// With the stride of the rays.
template <typename Real>
InstanceRayArrays SourcesOf(const Rays<Real>& rays, const std::optional<Ids>& sources) {
  if (!sources) return {};
  const bool fits = static_cast<std::size_t>(sources->size()) == rays.count &&
                    (rays.count == 0 || rays.arrays.stride == 0 ||
                     sources->strides(0) == static_cast<py::ssize_t>(rays.arrays.stride));
  if (!fits) throw py::value_error("source_instance: an array of another shape");
  return {sources->data()};
}

template <typename Real>
py::tuple Closest(const KeptInstances<Real>& kept, const Rays<Real>& rays,
                  const std::optional<Ids>& source_instance, const Options<Real>& options) {
  options.CheckFits(rays);
  Hits<Real> hits(rays.count);
  Ids instance(static_cast<py::ssize_t>(rays.count));
  const HitArraysOf<Real> arrays = hits.arrays();
  std::uint32_t* const into = instance.mutable_data();
  const InstanceRayArrays sources = SourcesOf(rays, source_instance);
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceClosest(kept.instances, rays.arrays, rays.count, arrays, into, options.options,
                        sources);
  }();
  Check(traced);
  return py::make_tuple(hits.t, instance, hits.primitive, hits.object, hits.u, hits.v);
}

template <typename Real>
Ids Occluded(const KeptInstances<Real>& kept, const Rays<Real>& rays,
             const std::optional<Ids>& source_instance, const Options<Real>& options) {
  options.CheckFits(rays);
  Ids occluded(static_cast<py::ssize_t>(rays.count));
  std::uint32_t* const into = occluded.mutable_data();
  const InstanceRayArrays sources = SourcesOf(rays, source_instance);
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceOccluded(kept.instances, rays.arrays, rays.count, into, options.options, sources);
  }();
  Check(traced);
  return occluded;
}

template <typename Real>
void AddInstancesOf(py::module_& module, const std::string& number) {
  using Kept = KeptInstances<Real>;
  py::class_<Kept>(module, ("Instances" + number).c_str())
      .def(py::init(&Build<Real>))
      .def("statistics", &StatisticsOf<Real>)
      .def("bounds",
           [](const Kept& kept) {
             return py::make_tuple(kept.instances.lower(), kept.instances.upper());
           })
      .def("closest", &Closest<Real>)
      .def("occluded", &Occluded<Real>);
}

}  // namespace

void AddInstances(py::module_& module) {
  module.attr("NO_INSTANCE") = Instances::kNoInstance;
  AddInstancesOf<float>(module, "Float");
  AddInstancesOf<double>(module, "Double");
}

}  // namespace sheaf::python
