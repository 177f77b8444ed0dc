// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "arrays.h"

namespace limitsurf::python {

/// A (4, 4) array; ValueError for another shape. None, where that is allowed, is the identity.
Eigen::Matrix4d matrixOf(const py::object& object, const char* name);
Eigen::Matrix4d matrixOrNone(const py::object& object, const char* name);

}  // namespace limitsurf::python
