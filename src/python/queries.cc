// Queries on the arrays of NumPy.
#include "sheaf/queries.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <exception>
#include <optional>
#include <vector>

#include "src/python/arrays.h"
#include "src/python/errors.h"

namespace sheaf::python {
namespace {

// Masks and exclusions as the Python side gives them: (object_mask, ray_mask, all_ray_mask,
// excluded), None for what is not there.
struct Rules {
  using Array = std::optional<py::array_t<std::uint32_t, py::array::c_style>>;
  Array object_mask, ray_mask, excluded;
  HitRules rules;

  Rules(const py::tuple& given, std::size_t rays, std::size_t objects)
      : object_mask(given[0].cast<Array>()),
        ray_mask(given[1].cast<Array>()),
        excluded(given[3].cast<Array>()) {
    rules.all_ray_mask = given[2].cast<std::uint32_t>();
    if (object_mask) rules.object_mask = Checked(*object_mask, objects);
    if (ray_mask) rules.ray_mask = Checked(*ray_mask, rays);
    if (!excluded) return;
    if (excluded->ndim() != 2) throw py::value_error("excluded: an array of another shape");
    const auto per_ray = static_cast<std::size_t>(excluded->shape(1));
    rules.excluded = Checked(*excluded, rays * per_ray);
    rules.excluded_per_ray = static_cast<std::uint32_t>(per_ray);
  }

 private:
  static const std::uint32_t* Checked(const py::array_t<std::uint32_t>& array, std::size_t size) {
    if (static_cast<std::size_t>(array.size()) != size) {
      throw py::value_error("rules: an array of another length");
    }
    return array.data();
  }
};

template <typename Real>
RuledTraceOptionsOf<Real> RuledOptions(const Options<Real>& options, const Rules& rules) {
  return {
      .interval = options.options.interval, .rules = rules.rules, .target = options.options.target};
}

template <typename T>
py::array_t<T> ArrayOf(const std::vector<T>& from) {
  return py::array_t<T>(static_cast<py::ssize_t>(from.size()), from.data());
}

// A Python function as a filter. It takes (ray, t, u, v, primitive, object) and returns a bool for
// each. What it raises ends the call.
template <typename Real>
HitFilterOf<Real> FilterOf(const py::object& function) {
  if (function.is_none()) return {};
  return [&function](const CandidateHitsOf<Real>& hits, std::uint8_t* accepted) {
    const py::gil_scoped_acquire acquire;
    const auto n = static_cast<py::ssize_t>(hits.count);
    const py::array_t<std::size_t> ray(n, hits.ray);
    const py::array_t<Real> t(n, hits.t), u(n, hits.u), v(n, hits.v);
    const Ids primitive(n, hits.primitive), object(n, hits.object);
    const auto answer = function(ray, t, u, v, primitive, object)
                            .template cast<py::array_t<bool, py::array::c_style>>();
    if (answer.size() != n) throw py::value_error("filter: an answer of another length");
    std::copy_n(answer.data(), n, accepted);
  };
}

template <typename Real>
py::tuple RuledClosest(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
                       const Options<Real>& options, const py::tuple& given,
                       const py::object& filter) {
  options.CheckFits(rays);
  const Rules rules(given, rays.count, geometry.object_count());
  Hits<Real> hits(rays.count);
  const HitArraysOf<Real> arrays = hits.arrays();
  const HitFilterOf<Real> accepts = FilterOf<Real>(filter);
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceRuledClosest(geometry, rays.arrays, rays.count, arrays,
                             RuledOptions(options, rules), accepts);
  }();
  Check(traced);
  return py::make_tuple(hits.t, hits.primitive, hits.object, hits.u, hits.v);
}

template <typename Real>
Ids RuledOccluded(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
                  const Options<Real>& options, const py::tuple& given, const py::object& filter) {
  options.CheckFits(rays);
  const Rules rules(given, rays.count, geometry.object_count());
  Ids occluded(static_cast<py::ssize_t>(rays.count));
  std::uint32_t* const into = occluded.mutable_data();
  const HitFilterOf<Real> accepts = FilterOf<Real>(filter);
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceRuledOccluded(geometry, rays.arrays, rays.count, into, RuledOptions(options, rules),
                              accepts);
  }();
  Check(traced);
  return occluded;
}

template <typename Real>
Ids CountHits(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
              const Options<Real>& options, const py::tuple& given) {
  options.CheckFits(rays);
  const Rules rules(given, rays.count, geometry.object_count());
  Ids total(static_cast<py::ssize_t>(rays.count));
  std::uint32_t* const into = total.mutable_data();
  const Status traced = [&] {
    const py::gil_scoped_release release;
    return TraceAll(geometry, rays.arrays, rays.count, {.total = into},
                    RuledOptions(options, rules));
  }();
  Check(traced);
  return total;
}

// The first hit of each ray and the number of all, then the hits: `most` of each ray, or all.
template <typename Real>
py::tuple All(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
              const Options<Real>& options, const py::tuple& given, std::uint32_t most) {
  options.CheckFits(rays);
  const Rules rules(given, rays.count, geometry.object_count());
  const Result<HitRunsOf<Real>> listed = [&] {
    const py::gil_scoped_release release;
    return ListAllHits(geometry, rays.arrays, rays.count, RuledOptions(options, rules), most);
  }();
  if (!listed) Check(listed.error());
  const HitRunsOf<Real>& runs = listed.value();
  return py::make_tuple(ArrayOf(runs.first), ArrayOf(runs.t), ArrayOf(runs.primitive),
                        ArrayOf(runs.object), ArrayOf(runs.u), ArrayOf(runs.v));
}

template <typename Real>
Ids Crossings(const GeometryOf<Real>& geometry, const Rays<Real>& rays,
              const Options<Real>& options, const py::tuple& given) {
  options.CheckFits(rays);
  const Rules rules(given, rays.count, geometry.object_count());
  Ids crossings(static_cast<py::ssize_t>(rays.count));
  std::uint32_t* const into = crossings.mutable_data();
  const Status counted = [&] {
    const py::gil_scoped_release release;
    return CountCrossings(geometry, rays.arrays, rays.count, into, RuledOptions(options, rules));
  }();
  Check(counted);
  return crossings;
}

// Points in an array of shape (N, 3) without gaps.
template <typename Real>
using Table = py::array_t<Real, py::array::c_style>;

template <typename Real>
PointArraysOf<Real> PointsOf(const Table<Real>& table) {
  if (table.ndim() != 2 || table.shape(1) != 3) {
    throw py::value_error("points: an array of another shape");
  }
  const Real* const first = table.data();
  return {first, first + 1, first + 2, 3 * sizeof(Real)};
}

template <typename Real>
Ids Inside(const GeometryOf<Real>& geometry, const Table<Real>& table, const py::tuple& given) {
  const PointArraysOf<Real> points = PointsOf(table);
  const auto count = static_cast<std::size_t>(table.shape(0));
  const Rules rules(given, count, geometry.object_count());
  Ids inside(table.shape(0));
  std::uint32_t* const into = inside.mutable_data();
  const Status found = [&] {
    const py::gil_scoped_release release;
    return FindInside(geometry, points, count, into, rules.rules);
  }();
  Check(found);
  return inside;
}

// distance, primitive, object and position.
template <typename Real>
py::tuple NearestTo(const GeometryOf<Real>& geometry, const Table<Real>& table,
                    const Values<Real>& max_distance, bool is_signed, const py::tuple& given) {
  const PointArraysOf<Real> points = PointsOf(table);
  const auto count = static_cast<std::size_t>(table.shape(0));
  const Rules rules(given, count, geometry.object_count());
  NearestOptionsOf<Real> options = {.rules = rules.rules};
  if (is_signed) options.sign = DistanceSign::kInside;
  if (max_distance && max_distance->ndim() == 0) options.all_max_distance = *max_distance->data();
  if (max_distance && max_distance->ndim() > 0) {
    if (static_cast<std::size_t>(max_distance->size()) != count) {
      throw py::value_error("max_distance: an array of another length");
    }
    options.max_distance = max_distance->data();
  }
  py::array_t<Real> distance(table.shape(0));
  Ids primitive(table.shape(0)), object(table.shape(0));
  NearestArraysOf<Real> nearest = {
      distance.mutable_data(), primitive.mutable_data(), object.mutable_data(), {}};
  const py::array_t<Real> position = Columns(count, &nearest.position);
  const Status found = [&] {
    const py::gil_scoped_release release;
    return FindNearest(geometry, points, count, nearest, options);
  }();
  Check(found);
  return py::make_tuple(distance, primitive, object, position);
}

// Where the primitives of each region begin, and the primitives, region by region. find(lists) asks
// the library.
template <typename Find>
py::tuple ListOverlaps(std::size_t count, const Find& find) {
  std::vector<std::uint32_t> total(count), listed(count), primitive, run;
  std::vector<std::size_t> first = {0};
  const Status found = [&]() -> Status {
    const py::gil_scoped_release release;
    // A first call counts, so that the second has room.
    if (Status counted = find(0, count, OverlapLists{.total = total.data()}); !counted) {
      return counted;
    }
    for (std::size_t i = 0; i < count; ++i) {
      run.resize(total[i]);
      const OverlapLists lists = {total[i], run.data(), listed.data(), nullptr};
      if (total[i] > 0) {
        if (Status listing = find(i, 1, lists); !listing) return listing;
      }
      primitive.insert(primitive.end(), run.begin(), run.end());
      first.push_back(primitive.size());
    }
    return Done{};
  }();
  Check(found);
  return py::make_tuple(ArrayOf(first), ArrayOf(primitive));
}

template <typename Real>
py::tuple InBoxes(const GeometryOf<Real>& geometry, const Table<Real>& lower,
                  const Table<Real>& upper) {
  if (lower.shape(0) != upper.shape(0)) throw py::value_error("boxes: arrays of another length");
  const PointArraysOf<Real> from = PointsOf(lower), to = PointsOf(upper);
  return ListOverlaps(static_cast<std::size_t>(lower.shape(0)), [&](std::size_t i, std::size_t n,
                                                                    const OverlapLists& lists) {
    const BoxArraysOf<Real> boxes = {{from.x + 3 * i, from.y + 3 * i, from.z + 3 * i},
                                     {to.x + 3 * i, to.y + 3 * i, to.z + 3 * i},
                                     from.stride};
    return FindInBoxes(geometry, boxes, n, lists);
  });
}

// `balls`: center and radius of each, (N, 4).
template <typename Real>
py::tuple InBalls(const GeometryOf<Real>& geometry, const Table<Real>& balls) {
  if (balls.ndim() != 2 || balls.shape(1) != 4) {
    throw py::value_error("balls: an array of another shape");
  }
  return ListOverlaps(static_cast<std::size_t>(balls.shape(0)), [&](std::size_t i, std::size_t n,
                                                                    const OverlapLists& lists) {
    const Real* const ball = balls.data() + 4 * i;
    const PointArraysOf<Real> points = {ball, ball + 1, ball + 2, 4 * sizeof(Real)};
    return FindInBalls(geometry, points, ball + 3, n, lists);
  });
}

}  // namespace

template <typename Real>
void AddQueries(py::class_<GeometryOf<Real>>& geometry) {
  geometry.def("ruled_closest", &RuledClosest<Real>)
      .def("ruled_occluded", &RuledOccluded<Real>)
      .def("count", &CountHits<Real>)
      .def("all", &All<Real>)
      .def("crossings", &Crossings<Real>)
      .def("inside", &Inside<Real>)
      .def("nearest", &NearestTo<Real>)
      .def("in_boxes", &InBoxes<Real>)
      .def("in_balls", &InBalls<Real>);
}
template void AddQueries(py::class_<GeometryOf<float>>&);
template void AddQueries(py::class_<GeometryOf<double>>&);

}  // namespace sheaf::python
