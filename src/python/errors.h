// Sheaf's errors as Python's exceptions.
#ifndef SHEAF_PYTHON_ERRORS_H_
#define SHEAF_PYTHON_ERRORS_H_

#include <pybind11/pybind11.h>

#include <string>

#include "sheaf/capi.h"
#include "sheaf/error.h"

namespace sheaf::python {

// Adds the classes Error, UsageError, SceneError, FileError and InterruptedError to the module.
void AddErrors(pybind11::module_& module);

// Raises the class that stands for the status. Needs the interpreter's lock.
[[noreturn]] void Raise(sheaf_status status, const std::string& message);

inline void Check(sheaf_status status) {
  if (status != SHEAF_OK) Raise(status, sheaf_error_message());
}

void Check(const Status& status);

}  // namespace sheaf::python

#endif  // SHEAF_PYTHON_ERRORS_H_
