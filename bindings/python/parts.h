// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The parts that the module is put together from, in the order a triangle travels.
#pragma once

#include <pybind11/pybind11.h>

#include <optional>

#include "vicinity/viscosity/scene.h"

namespace vicinity::python {

void add_error(pybind11::module_& module);
void add_mesh(pybind11::module_& module);
void add_field(pybind11::module_& module);
void add_scene(pybind11::module_& module);
void add_arm(pybind11::module_& module);
void add_study(pybind11::module_& module);

/// A copy of Python's Scene; nothing where it is none.
std::optional<Scene> scene_from(pybind11::handle scene);

}  // namespace vicinity::python

// Name, member and docstring of a member that Python sees as it is.
#define VICINITY_MEMBER(Class, member) \
#member, &vicinity::Class::member, vicinity::python::doc::Class##_##member
// The same where the header says nothing but the name.
#define VICINITY_PLAIN_MEMBER(Class, member) #member, &vicinity::Class::member
// Name, value and docstring of an enumerator.
#define VICINITY_VALUE(Enumeration, value) \
#value, vicinity::Enumeration::value, vicinity::python::doc::Enumeration##_##value
#define VICINITY_PLAIN_VALUE(Enumeration, value) #value, vicinity::Enumeration::value
