// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Arrays of numpy into points, poses and boxes, and back.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>
#include <string>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/vec3.h"

namespace vicinity::python {

/// An array of float64 that lies in memory as C has it: one that does so already is taken where it
/// is, and anything else is converted into a copy.
using Numbers = pybind11::array_t<double, pybind11::array::c_style | pybind11::array::forcecast |
                                              pybind11::detail::npy_api::NPY_ARRAY_ALIGNED_>;

/// "(5, 2)"
inline std::string shape_of(const pybind11::array& array) {
  return pybind11::str(array.attr("shape"));
}

/// The points of an array of shape (N, 3), where they lie.
/// Errors: throws Error, naming `where`, for another shape.
inline std::span<const Vec3> points_of(const Numbers& array, const char* where) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && alignof(Vec3) == alignof(double));
  if (array.ndim() != 2 || array.shape(1) != 3) {
    throw Error({.where = where,
                 .what = "is no list of points",
                 .found = "shape " + shape_of(array),
                 .expected = "shape (N, 3)"});
  }
  return {reinterpret_cast<const Vec3*>(array.data()), static_cast<std::size_t>(array.shape(0))};
}

/// Numbers that belong to `owner`, as a read-only array that keeps it alive.
template <class Number>
pybind11::array_t<Number> view(std::vector<pybind11::ssize_t> shape, const Number* numbers,
                               pybind11::handle owner) {
  pybind11::array_t<Number> array(std::move(shape), numbers, owner);
  pybind11::detail::array_proxy(array.ptr())->flags &=
      ~pybind11::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

}  // namespace vicinity::python

namespace pybind11::detail {

/// A pose is a homogeneous matrix, shape (4, 4).
template <>
struct type_caster<vicinity::Pose> {
  PYBIND11_TYPE_CASTER(vicinity::Pose, const_name("numpy.ndarray[numpy.float64[4, 4]]"));

  bool load(handle source, bool) {
    const auto array = vicinity::python::Numbers::ensure(source);
    if (!array) return false;
    if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) return false;
    const Eigen::Matrix4d matrix =
        Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data());
    const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
    // NaN and infinity are refused where the pose is used, each in its own way.
    constexpr double slack = 1e-6;
    const bool turns_nothing_else =
        (R * R.transpose() - Eigen::Matrix3d::Identity()).norm() > slack;
    if (matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1) || turns_nothing_else ||
        R.determinant() < 0) {
      throw vicinity::Error({.where = "pose",
                             .what = "is not rigid",
                             .found = pybind11::repr(array),
                             .expected = "a rotation, a position and the row 0, 0, 0, 1",
                             .hint = "pose_from_rpy()"});
    }
    value.matrix() = matrix;
    return true;
  }
  static handle cast(const vicinity::Pose& pose, return_value_policy, handle) {
    return pybind11::cast(Eigen::Matrix4d(pose.matrix())).release();
  }
};

/// A box is its lower and its upper corner, shape (2, 3).
template <>
struct type_caster<vicinity::Box> {
  PYBIND11_TYPE_CASTER(vicinity::Box, const_name("numpy.ndarray[numpy.float64[2, 3]]"));

  bool load(handle source, bool) {
    const auto array = vicinity::python::Numbers::ensure(source);
    if (!array) return false;
    if (array.ndim() != 2 || array.shape(0) != 2 || array.shape(1) != 3) return false;
    const auto corners = vicinity::python::points_of(array, "box");
    value = vicinity::Box(corners[0], corners[1]);
    return true;
  }
  static handle cast(const vicinity::Box& box, return_value_policy, handle) {
    Eigen::Matrix<double, 2, 3> corners;
    corners << box.min().transpose(), box.max().transpose();
    return pybind11::cast(corners).release();
  }
};

}  // namespace pybind11::detail
