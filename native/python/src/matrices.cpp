// SPDX-License-Identifier: Apache-2.0
#include "matrices.h"

#include <stdexcept>

namespace limitsurf::python {

Eigen::Matrix4d matrixOf(const py::object& object, const char* name) {
  const Doubles array = doubles(object, name);
  if (array.ndim() != 2 || array.shape(0) != 4 || array.shape(1) != 4) {
    throw std::invalid_argument(std::string(name) + " has shape " + shapeText(array) +
                                "; expected (4, 4)");
  }
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.data());
}

Eigen::Matrix4d matrixOrNone(const py::object& object, const char* name) {
  return object.is_none() ? Eigen::Matrix4d::Identity() : matrixOf(object, name);
}

Eigen::Map<const Rotations> rotationRows(Doubles& array, const char* name) {
  shapeEmpty(array, {0, 3, 3});
  if (array.ndim() != 3 || array.shape(1) != 3 || array.shape(2) != 3) {
    throw py::value_error(std::string(name) + " has shape " + shapeText(array) +
                          "; expected (n, 3, 3)");
  }
  return {array.data(), array.shape(0), 9};
}

}  // namespace limitsurf::python
