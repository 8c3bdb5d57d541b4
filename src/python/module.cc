#include <pybind11/pybind11.h>

#include "sheaf/capi.h"
#include "sheaf/geometry.h"
#include "src/python/bindings.h"
#include "src/python/errors.h"

PYBIND11_MODULE(_sheaf, module) {
  module.attr("__version__") = sheaf_version();
  module.attr("NO_PRIMITIVE") = sheaf::Geometry::kNoPrimitive;
  module.attr("INSIDE_BIT") = sheaf::Geometry::kInsideBit;
  module.def("build_info", &sheaf_build_info);
  module.def("targets", [] {
    pybind11::list names;
    for (std::size_t i = 0; i < sheaf_target_count(); ++i) names.append(sheaf_target_name(i));
    names.append("scalar");
    return names;
  });
  sheaf::python::AddErrors(module);
  sheaf::python::AddGeometry(module);
  sheaf::python::AddInstances(module);
  sheaf::python::AddScenes(module);
}
