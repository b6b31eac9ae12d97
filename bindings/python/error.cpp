// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// vicinity::Error as a Python exception: the same sentence, and its parts as attributes.

#include "vicinity/geometry/error.h"

#include <exception>

#include "docstrings.h"
#include "parts.h"

namespace py = pybind11;

namespace vicinity::python {
namespace {

PyObject* error_class = nullptr;  // as long as the interpreter

void set_error(const Error& error) {
  const py::object exception = py::handle(error_class)(error.what());
  const ErrorParts& parts = error.parts();
  exception.attr("where") = parts.where;
  exception.attr("what") = parts.what;
  exception.attr("found") = parts.found;
  exception.attr("expected") = parts.expected;
  exception.attr("hint") = parts.hint;
  PyErr_SetObject(error_class, exception.ptr());
}

}  // namespace

void add_error(py::module_& module) {
  error_class = PyErr_NewExceptionWithDoc("vicinity.Error", doc::Error, PyExc_ValueError, nullptr);
  if (error_class == nullptr) throw py::error_already_set();
  // So that they are there also where Python itself raises one.
  for (const char* part : {"where", "what", "found", "expected", "hint"}) {
    py::setattr(error_class, part, py::str());
  }
  module.add_object("Error", error_class);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const Error& error) {
      set_error(error);
    }
  });
}

}  // namespace vicinity::python
