// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "limitsurf/mesh/control_mesh.h"
#include "numbers.h"

namespace limitsurf::python {

struct BoundMesh : ControlMesh, std::enable_shared_from_this<BoundMesh> {
  using ControlMesh::ControlMesh;
};

void bindControlMesh(pybind11::module_& module);

}  // namespace limitsurf::python
