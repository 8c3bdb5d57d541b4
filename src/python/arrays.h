// What the bindings of geometries share: rays, options and hits on the arrays of NumPy.
#ifndef SHEAF_PYTHON_ARRAYS_H_
#define SHEAF_PYTHON_ARRAYS_H_

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sheaf/geometry.h"
#include "sheaf/target.h"
#include "src/python/errors.h"

namespace sheaf::python {

namespace py = pybind11;
using Ids = py::array_t<std::uint32_t>;

// Rays in arrays of shape (N, 3), which are kept alive.
template <typename Real>
struct Rays {
  py::array_t<Real> origins, directions;
  std::optional<Ids> source;  // as far apart as the rays
  RayArraysOf<Real> arrays;
  std::size_t count = 0;

  Rays(py::array_t<Real> from, py::array_t<Real> towards, std::optional<Ids> started)
      : origins(std::move(from)), directions(std::move(towards)), source(std::move(started)) {
    const auto is_table = [](const py::array& array) {
      return array.ndim() == 2 && array.shape(1) == 3;
    };
    if (!is_table(origins) || !is_table(directions) || origins.shape(0) != directions.shape(0) ||
        (source && source->size() != origins.shape(0))) {
      throw py::value_error("rays: arrays of another shape");
    }
    count = static_cast<std::size_t>(origins.shape(0));
    // NumPy gives arrays without elements any strides.
    const py::ssize_t row = count == 0 ? py::ssize_t{sizeof(Real)} : origins.strides(0);
    if (count > 0 &&
        (row <= 0 || directions.strides(0) != row || (source && source->strides(0) != row))) {
      throw py::value_error("rays: rows of another distance");
    }
    const auto column = [](const py::array_t<Real>& of, py::ssize_t i) {
      return reinterpret_cast<const Real*>(reinterpret_cast<const char*>(of.data()) +
                                           i * of.strides(1));
    };
    arrays = {column(origins, 0),    column(origins, 1),    column(origins, 2),
              column(directions, 0), column(directions, 1), column(directions, 2)};
    if (source) arrays.source = source->data();
    arrays.stride = row == sizeof(Real) ? 0 : static_cast<std::size_t>(row);
  }
};

// Without gaps, one a ray.
template <typename Real>
using Values = std::optional<py::array_t<Real, py::array::c_style>>;

template <typename Real>
struct Options {
  TraceOptionsOf<Real> options;
  Values<Real> t_min, t_max;

  // Of t_min and t_max, arrays or one number for all; none: every hit in front.
  Options(Values<Real> min, Values<Real> max, int coherence, const std::string& target)
      : t_min(std::move(min)), t_max(std::move(max)) {
    TraceIntervalOf<Real>& interval = options.interval;
    if (t_min && t_min->ndim() == 0) interval.all_t_min = *t_min->data();
    if (t_min && t_min->ndim() == 1) interval.t_min = t_min->data();
    if (t_max && t_max->ndim() == 0) interval.all_t_max = *t_max->data();
    if (t_max && t_max->ndim() == 1) interval.t_max = t_max->data();
    options.coherence = static_cast<RayCoherence>(coherence);
    const std::optional<Target> named = Target::Named(target);
    if (!named) Raise(SHEAF_USAGE, "target: this processor has no \"" + target + "\"");
    options.target = *named;
  }

  void CheckFits(const Rays<Real>& rays) const {
    for (const Values<Real>* values : {&t_min, &t_max}) {
      if (*values && (*values)->ndim() == 1 &&
          static_cast<std::size_t>((*values)->size()) != rays.count) {
        throw py::value_error("t_min, t_max: arrays of another length");
      }
    }
  }
};

template <typename Real>
struct Hits {
  py::array_t<Real> t, u, v;
  Ids primitive, object;

  explicit Hits(std::size_t count)
      : t(count), u(count), v(count), primitive(count), object(count) {}
  HitArraysOf<Real> arrays() {
    return {t.mutable_data(), primitive.mutable_data(), object.mutable_data(), u.mutable_data(),
            v.mutable_data()};
  }
};

// x, y and z apart in memory, as the library writes them; of shape (N, 3) to Python.
template <typename Real>
py::array_t<Real> Columns(std::size_t count, std::array<Real*, 3>* into) {
  const auto rows = static_cast<py::ssize_t>(count);
  const py::ssize_t size = sizeof(Real);
  py::array_t<Real> array(std::vector<py::ssize_t>{rows, 3},
                          std::vector<py::ssize_t>{size, size * rows});
  for (std::size_t k = 0; k < 3; ++k) (*into)[k] = array.mutable_data() + k * count;
  return array;
}

// The calls of <sheaf/queries.h>.
template <typename Real>
void AddQueries(py::class_<GeometryOf<Real>>& geometry);

}  // namespace sheaf::python

#endif  // SHEAF_PYTHON_ARRAYS_H_
