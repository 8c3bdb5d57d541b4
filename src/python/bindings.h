// The parts of the extension module sheaf._sheaf. The package's Python files stand above it: they
// check and convert what a user gives; here arrays have the right type and shape, or a plain error
// is raised.
#ifndef SHEAF_PYTHON_BINDINGS_H_
#define SHEAF_PYTHON_BINDINGS_H_

#include <pybind11/pybind11.h>

namespace sheaf::python {

void AddGeometry(pybind11::module_& module);   // geometries of floats and of doubles
void AddInstances(pybind11::module_& module);  // the same in many places
void AddScenes(pybind11::module_& module);     // scenes, frames and pictures

}  // namespace sheaf::python

#endif  // SHEAF_PYTHON_BINDINGS_H_
