#include "src/python/errors.h"

#include <new>

namespace sheaf::python {
namespace {

namespace py = pybind11;

// By sheaf_status; each is also what Python's own libraries raise in such a case.
struct ErrorClass {
  const char* name;
  PyObject** also;  // null: Exception alone
  const char* text;
  PyObject* made;
};

ErrorClass classes[] = {
    {"Error", nullptr, "What Sheaf raises; its message is one line that names the place.", nullptr},
    {"UsageError", &PyExc_ValueError, "An argument does not exist or does not fit.", nullptr},
    {"SceneError", &PyExc_ValueError, "A scene is malformed or cannot be rendered.", nullptr},
    {"FileError", &PyExc_OSError, "A file cannot be read or written.", nullptr},
    {"StoppedError", &PyExc_RuntimeError, "A frame was asked to stop.", nullptr},
};

}  // namespace

void AddErrors(py::module_& module) {
  for (ErrorClass& made : classes) {
    py::object bases = py::reinterpret_borrow<py::object>(PyExc_Exception);
    if (made.also != nullptr) {
      bases = py::make_tuple(py::handle(classes[0].made), py::handle(*made.also));
    }
    const std::string name = std::string("sheaf.") + made.name;
    made.made = PyErr_NewExceptionWithDoc(name.c_str(), made.text, bases.ptr(), nullptr);
    if (made.made == nullptr) throw py::error_already_set();
    module.attr(made.name) = py::handle(made.made);
  }
}

void Raise(sheaf_status status, const std::string& message) {
  if (status == SHEAF_OUT_OF_MEMORY) throw std::bad_alloc();
  const auto index = static_cast<std::size_t>(status);
  const ErrorClass& raised = index < std::size(classes) ? classes[index] : classes[0];
  PyErr_SetString(raised.made, message.c_str());
  throw py::error_already_set();
}

void Check(const Status& status) {
  if (status) return;
  switch (status.error().kind) {
    case ErrorKind::kUsage:
      Raise(SHEAF_USAGE, status.error().message);
    case ErrorKind::kScene:
      Raise(SHEAF_BAD_SCENE, status.error().message);
    case ErrorKind::kInputOutput:
      Raise(SHEAF_INPUT_OUTPUT, status.error().message);
    case ErrorKind::kInterrupted:
      Raise(SHEAF_INTERRUPTED, status.error().message);
  }
  Raise(SHEAF_INTERNAL, status.error().message);
}

}  // namespace sheaf::python
