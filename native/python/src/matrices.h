// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "arrays.h"
#include "limitsurf/surface/strands/strand_turns.h"

namespace limitsurf::python {

/// The matrix of a (4, 4) array; matrixOrNone() returns the identity for None. Throw ValueError for
/// an array of another shape.
Eigen::Matrix4d matrixOf(const py::object& object, const char* name);
Eigen::Matrix4d matrixOrNone(const py::object& object, const char* name);

/// The rows of an (n, 3, 3) array, which must live on; [] has none. Throws ValueError for an array
/// of another shape.
Eigen::Map<const Rotations> rotationRows(Doubles& array, const char* name);

}  // namespace limitsurf::python
