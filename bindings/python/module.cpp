// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The Python module: convert, call, convert. What it computes lives in the library, and so do its
// defaults and its docstrings.

#include "parts.h"

PYBIND11_MODULE(_vicinity, module) {
  // Where people meet it: in the names of its classes and in its errors.
  module.attr("__name__") = "vicinity";
  module.doc() =
      "Feel how close a remote arm is to things before it touches them.\n\n"
      "SI units: m, s, N, rad. Points are rows of float64 arrays, shape (N, 3); poses are\n"
      "homogeneous matrices, shape (4, 4); W is the workspace, and p_WR is point R seen from it.\n"
      "What cannot be used raises Error, a ValueError that says where, what, found, expected and\n"
      "what to try. Docstrings are those of the C++ headers.";
  module.attr("__version__") = VICINITY_VERSION;
  vicinity::python::add_error(module);
  vicinity::python::add_mesh(module);
  vicinity::python::add_field(module);
  vicinity::python::add_scene(module);
  vicinity::python::add_arm(module);
  vicinity::python::add_study(module);
  module.attr("__name__") = "vicinity._vicinity";
}
